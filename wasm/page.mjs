// Builds the page that measures in the browser: the viewer's drawing, the page's own script, and the program inside it.
//
//   node page.mjs FOLDER    FOLDER/gaussmap.js and gaussmap.wasm become FOLDER/gaussmap.html
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { onePage } from "../viewer/build.mjs";

const folder = process.argv[2];
const script = JSON.stringify(await readFile(join(folder, "gaussmap.js"), "utf8")).replaceAll("<", "\\u003c");
const code = gzipSync(await readFile(join(folder, "gaussmap.wasm")), { level: 9 }).toString("base64");
const place = "<!--gaussmap-module-->";
const page = await onePage("compute.html");
if (!page.includes(place)) throw new Error("compute.html: the place for the program is gone");
await writeFile(
  join(folder, "gaussmap.html"),
  page.replace(place, () => `<script type="application/json" id="gaussmap-script">${script}</script>\n    <script type="text/plain" id="gaussmap-code">${code}</script>`),
);
