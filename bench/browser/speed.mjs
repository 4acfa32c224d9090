// The page that measures in the browser against the program on one thread: gaussmap curvature of the same files.
//
//   node bench/browser/speed.mjs [FILE…]    after make wasm; without files, shapes of three sizes
//
// Rounds take turns; the fastest of each counts. The results are compared first, to 1e-12.
import assert from "node:assert/strict";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { close, folder, gaussmap, open, project } from "../../tests/browser/browser.mjs";

const rounds = 7;
const files = process.argv.slice(2).map((file) => resolve(file));
if (files.length === 0)
  for (const subdivisions of ["4", "6", "7"]) {
    gaussmap("shape", "bumpy", "--subdivisions", subdivisions, "--jitter", "0.2", "-o", `bumpy${subdivisions}.ply`, "--quiet");
    files.push(join(folder, `bumpy${subdivisions}.ply`));
  }

const page = await (await open()).newPage();
await page.goto(pathToFileURL(join(project, "build/wasm/gaussmap.html")).href);
async function inBrowser(file) {
  await page.setInputFiles("input[type=file]", file);
  await page.locator("body[data-state=done]").waitFor({ timeout: 300_000 });
  return JSON.parse(await page.locator(".summary").getAttribute("data-report"));
}
const native = (file) => JSON.parse(gaussmap("curvature", file, "--threads", "1", "-o", "native.ply", "--json"));
const measuring = ({ seconds }) => seconds.normals + seconds.neighbors + seconds.curvature;

console.log("| file | vertices | measuring: browser | native, 1 thread | ratio | with reading and writing: browser | native | ratio |");
console.log("|---|---|---|---|---|---|---|---|");
for (const file of files) {
  const least = { browser: [Infinity, Infinity], native: [Infinity, Infinity] };
  let vertices = 0;
  for (let round = 0; round < rounds; ++round) {
    const a = await inBrowser(file), b = native(file);
    vertices = b.vertices;
    for (const key of ["mean", "rms", "min", "max", "p50"])
      assert.ok(Math.abs(a.density[key] - b.density[key]) <= 1e-12 * Math.abs(b.density[key]), `${file}: ${key} differs`);
    for (const [who, report] of [["browser", a], ["native", b]]) {
      least[who][0] = Math.min(least[who][0], measuring(report));
      least[who][1] = Math.min(least[who][1], report.seconds.total);
    }
  }
  const ms = (s) => `${(1000 * s).toPrecision(3)} ms`, { browser, native: own } = least;
  console.log(`| ${basename(file)} | ${vertices} | ${[0, 1].map((i) => `${ms(browser[i])} | ${ms(own[i])} | ${(browser[i] / own[i]).toFixed(2)} ×`).join(" | ")} |`);
}
await close();
