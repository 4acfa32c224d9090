// Builds the viewer: one HTML file with everything in it, and the same as C++ for the library.
//
//   node build.mjs FOLDER    writes FOLDER/viewer.html and FOLDER/viewer_page.cpp
import { mkdir, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "vite";

const root = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(root, "dist");

/** The page `name` of this folder with its scripts and styles inside it. */
export async function onePage(name) {
  const { output } = await build({
    root,
    configFile: false,
    logLevel: "warn",
    build: {
      write: false,
      target: "es2022",
      modulePreload: false,
      cssCodeSplit: false,
      assetsInlineLimit: Number.MAX_SAFE_INTEGER,
      rollupOptions: { input: join(root, name), output: { inlineDynamicImports: true } },
      chunkSizeWarningLimit: 2000,
    },
  });
  const named = (file) => output.find((o) => o.fileName === file.replace(/^\//, ""));
  let page = named(name).source;
  page = page.replace(/<link rel="stylesheet"[^>]* href="([^"]+)">/g, (_, file) => `<style>${named(file).source}</style>`);
  // A module runs when the page is read to its end, wherever it stands.
  return page.replace(/<script type="module"[^>]* src="([^"]+)"><\/script>/g, (_, file) => {
    const code = named(file).code.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
    return `<script type="module">${code}</script>`;
  });
}

/** Text as literals of C++, in lines that compilers take. */
function literals(text) {
  const bytes = Buffer.from(text);
  const lines = [];
  for (let at = 0; at < bytes.length; at += 4096) {
    let line = "";
    for (const b of bytes.subarray(at, at + 4096)) {
      const c = String.fromCharCode(b);
      line += b < 32 || b > 126 || c === '"' || c === "\\" || c === "?" ? "\\" + b.toString(8).padStart(3, "0") : c;
    }
    lines.push(`"${line}"`);
  }
  return { lines: lines.join("\n"), size: bytes.length };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const page = await onePage("viewer.html");
  if (!page.includes("<!--gaussmap-data-->")) throw new Error("viewer.html: the place for the data is gone");
  const { lines, size } = literals(page);
  await mkdir(folder, { recursive: true });
  await writeFile(join(folder, "viewer.html"), page);
  await writeFile(
    join(folder, "viewer_page.cpp"),
    `// Made by viewer/build.mjs.\n#include "viewer_page.h"\n\nnamespace gaussmap {\n\nstd::string_view viewer_page() {\n` +
      `    static constexpr char page[] =\n${lines};\n    return {page, ${size}};\n}\n\n}  // namespace gaussmap\n`,
  );
}
