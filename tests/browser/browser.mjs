// What the browser tests share: pages made by the program, opened in Debian's chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export const project = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const fromViewer = createRequire(join(project, "viewer/package.json"));
const { chromium } = fromViewer("playwright-core");
export const axe = fromViewer.resolve("axe-core/axe.min.js");

export const program = resolve(process.env.GAUSSMAP ?? join(project, "build/release/gaussmap"));
export const shots = join(project, "build/browser");
mkdirSync(shots, { recursive: true });
export const folder = mkdtempSync(join(tmpdir(), "gaussmap-browser-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/** Run the program in the folder of this test run. */
export function gaussmap(...args) {
  assert.ok(existsSync(program), `${program} is not built (set GAUSSMAP to the program)`);
  return execFileSync(program, args, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

const flags = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];

let browser;
export async function open() {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  assert.ok(existsSync(executablePath), `${executablePath} is not there (Debian: chromium; or set CHROMIUM)`);
  browser ??= await chromium.launch({ executablePath, args: flags, headless: true });
  return browser;
}
export async function close() {
  await browser?.close();
}

/** A page of the folder, shown. Complaints of the page and requests other than the file itself are kept. */
export async function show(file, { hash = "", ready = true, ...options } = {}) {
  const context = await (await open()).newContext({ viewport: { width: 1200, height: 760 }, ...options });
  const page = await context.newPage();
  page.complaints = [];
  page.requests = [];
  page.on("console", (m) => ["error", "warning"].includes(m.type()) && !/GPU stall|ReadPixels/.test(m.text()) && page.complaints.push(m.text()));
  page.on("pageerror", (e) => page.complaints.push(String(e)));
  page.on("request", (r) => !/^(blob|data):/.test(r.url()) && page.requests.push(r.url()));
  page.address = pathToFileURL(join(folder, file)).href;
  await page.goto(page.address + hash);
  if (ready) {
    await page.locator("#app[data-ready=true]").waitFor({ timeout: 60_000 });
    await drawn(page);
  }
  return page;
}

/** Two frames later, when what was asked for is on the canvas. */
export const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60)))));

/** The canvas as bytes: { width, height, data } with four a pixel. */
export async function pixels(page) {
  await drawn(page);
  const { width, height, text } = await page.evaluate(() => {
    const from = document.querySelector("canvas.picture"), to = document.createElement("canvas");
    (to.width = from.width), (to.height = from.height);
    const g = to.getContext("2d");
    g.drawImage(from, 0, 0);
    const { data } = g.getImageData(0, 0, to.width, to.height);
    let text = "";
    for (let i = 0; i < data.length; i += 30000) text += String.fromCharCode(...data.subarray(i, i + 30000));
    return { width: to.width, height: to.height, text: btoa(text) };
  });
  return { width, height, data: Buffer.from(text, "base64") };
}

/** How many colours, and what part of the pixels is not that of the corner. */
export function colours({ data }) {
  const seen = new Map(), at = (i) => data.readUInt32LE(i), back = at(0);
  let other = 0;
  for (let i = 0; i < data.length; i += 4) seen.set(at(i), (seen.get(at(i)) ?? 0) + 1), at(i) !== back && ++other;
  return { count: seen.size, drawn: (4 * other) / data.length, seen, back };
}

/** The part of pixels that differ. */
export function difference(a, b) {
  assert.equal(a.data.length, b.data.length);
  let differ = 0;
  for (let i = 0; i < a.data.length; i += 4) if (a.data.readUInt32LE(i) !== b.data.readUInt32LE(i)) ++differ;
  return (4 * differ) / a.data.length;
}
