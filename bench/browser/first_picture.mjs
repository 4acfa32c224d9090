// How large the page of a million triangles is, and how soon it shows the object, in a browser just started.
//
//   node bench/browser/first_picture.mjs [FILE]…    without files, bumpy spheres of 327,680 and 1,310,720 triangles
//
// The size is held against the binary PLY of positions (float32), faces and one scalar (float32). The frames are those that
// the browser's compositor shows: the first that is more than an empty stage, and the last that still changed.
import { statSync, writeFileSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { close, folder, gaussmap, open, shots } from "../../tests/browser/browser.mjs";

const files = process.argv.slice(2).map((file) => resolve(file));
if (files.length === 0)
  for (const subdivisions of ["7", "8"]) {
    gaussmap("shape", "bumpy", "--subdivisions", subdivisions, "--jitter", "0.2", "-o", `bumpy${subdivisions}.ply`, "--quiet");
    files.push(join(folder, `bumpy${subdivisions}.ply`));
  }

/** Seconds from opening the page to each frame shown, with the frame. An empty stage compresses to little. */
async function frames(address) {
  const page = await (await open()).newPage({ viewport: { width: 1200, height: 760 } });
  const session = await page.context().newCDPSession(page);
  const seen = [];
  const start = performance.now();
  session.on("Page.screencastFrame", ({ data, sessionId }) => {
    seen.push([(performance.now() - start) / 1000, Buffer.from(data, "base64")]);
    session.send("Page.screencastFrameAck", { sessionId }).catch(() => {});
  });
  await session.send("Page.startScreencast", { format: "png", everyNthFrame: 1 });
  await page.goto(address);
  await page.locator("#app[data-ready=true]").waitFor({ timeout: 60_000 });
  await page.waitForTimeout(3000);
  await page.close();
  return seen;
}

console.log("| file | triangles | page, MB | of the PLY | first picture, s | whole mesh, s |");
console.log("|---|---|---|---|---|---|");
await open();
for (const file of files) {
  const { vertices, faces } = JSON.parse(gaussmap("info", file, "--json"));
  gaussmap("view", file, "-o", "page.html", "--quiet");
  const size = statSync(join(folder, "page.html")).size;
  const seen = await frames(pathToFileURL(join(folder, "page.html")).href);
  const final = seen.at(-1)[1].length;
  const picture = seen.find(([, png]) => png.length > final / 2);
  const whole = seen.find(([, png]) => png.length === final);
  writeFileSync(join(shots, "first-picture.png"), picture[1]);
  const cells = [basename(file), faces, (size / 1e6).toFixed(1), (size / (16 * vertices + 13 * faces)).toFixed(2)];
  console.log(`| ${[...cells, picture[0].toFixed(2), whole[0].toFixed(2)].join(" | ")} |`);
}
await close();
