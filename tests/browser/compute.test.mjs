// The page that measures in the browser, against the program itself.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { axe, close, colours, folder, gaussmap, open, pixels, program, project, shots } from "./browser.mjs";

const address = pathToFileURL(join(project, "build/wasm/gaussmap.html")).href;
after(close);

async function start() {
  const context = await (await open()).newContext({ viewport: { width: 1200, height: 760 }, acceptDownloads: true });
  const page = await context.newPage();
  page.complaints = [];
  page.requests = [];
  page.on("console", (m) => m.type() === "error" && page.complaints.push(m.text()));
  page.on("pageerror", (e) => page.complaints.push(String(e)));
  page.on("request", (r) => !/^(blob|data):/.test(r.url()) && page.requests.push(r.url()));
  await page.goto(address);
  await page.locator("body[data-state=ready]").waitFor();
  return page;
}

const ended = (page) => page.locator("body[data-state=done], body[data-state=failed]").waitFor({ timeout: 120_000 });

/** Choose a file; its report, or null where it failed. */
async function measured(page, path) {
  await page.setInputFiles("input[type=file]", path);
  await ended(page);
  const failed = (await page.locator("body").getAttribute("data-state")) === "failed";
  return failed ? null : JSON.parse(await page.locator(".summary").getAttribute("data-report"));
}

/** Let go of a file over the page. */
async function dropped(page, name, bytes) {
  await page.evaluate(
    ([name, text]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
      document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
    },
    [name, Buffer.from(bytes).toString("base64")],
  );
  await ended(page);
}

async function saved(page) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(".download")]);
  const path = join(folder, `saved-${download.suggestedFilename()}`);
  await download.saveAs(path);
  return { name: download.suggestedFilename(), bytes: readFileSync(path), path };
}

const native = (...args) => JSON.parse(gaussmap(...args, "--json"));

function near(a, b, tolerance, what) {
  assert.ok(Math.abs(a - b) <= tolerance * Math.abs(b), `${what}: ${a} in the browser, ${b} natively`);
}

/** The report of the page is that of the program: counts equal, numbers to 1e-12; of clouds, whose fits carry rounding on, to 1e-9. */
function same(report, expected) {
  for (const key of ["kind", "vertices", "faces", "normals", "estimator", "undefined", "duplicates", "non_finite"]) assert.deepEqual(report[key], expected[key], key);
  const tolerance = expected.kind === "mesh" ? 1e-12 : 1e-9;
  for (const key of ["min", "mean", "rms", "max", "p02", "p50", "p98"]) near(report.density[key], expected.density[key], tolerance, `density ${key}`);
  if (expected.kappa) near(report.kappa.sum, expected.kappa.sum, tolerance, "kappa");
}

/** Two binary PLY files: one header, and values that differ in the last bit of a float32 at most. */
function sameFile(a, b) {
  const end = "end_header\n", at = b.indexOf(end) + end.length;
  assert.equal(a.subarray(0, at).toString("latin1"), b.subarray(0, at).toString("latin1"));
  assert.equal(a.length, b.length);
}

/** A property of float32 of the vertices, whose other properties are all of four bytes. */
function vertexFloats(bytes, name) {
  const end = "end_header\n", at = bytes.indexOf(end) + end.length, lines = bytes.subarray(0, at).toString("latin1").split("\n");
  const sizes = { double: 8, float: 4, int: 4, uint: 4, short: 2, ushort: 2, char: 1, uchar: 1 };
  const first = lines.findIndex((l) => l.startsWith("element vertex")), count = Number(lines[first].split(" ")[2]);
  let stride = 0, offset = -1;
  for (const line of lines.slice(first + 1)) {
    const [word, type, property] = line.split(" ");
    if (word !== "property") break;
    if (property === name) offset = stride;
    stride += sizes[type];
  }
  assert.ok(offset >= 0, `no ${name}`);
  return Float32Array.from({ length: count }, (_, v) => bytes.readFloatLE(at + v * stride + offset));
}

test("a dropped mesh has the numbers of the program, and is saved as the program writes it", async () => {
  gaussmap("shape", "bumpy", "--subdivisions", "4", "--jitter", "0.2", "-o", "bumpy.ply", "--quiet");
  const page = await start(), bytes = readFileSync(join(folder, "bumpy.ply"));
  await dropped(page, "bumpy.ply", bytes);
  assert.equal(await page.locator(".failure").isVisible(), false, await page.locator(".failure").textContent());
  same(JSON.parse(await page.locator(".summary").getAttribute("data-report")), native("curvature", "bumpy.ply", "-o", "expected.ply"));
  assert.match(await page.locator(".summary").textContent(), /bumpy\.ply: 2,562 vertices and 5,120 faces\. Total curvature: mean [\d.]+, rms [\d.]+ 1\/unit²; 0 undefined/);

  const file = await saved(page), expected = readFileSync(join(folder, "expected.ply"));
  assert.equal(file.name, "bumpy-curvature.ply");
  sameFile(file.bytes, expected);
  const [a, b] = [file.bytes, expected].map((f) => vertexFloats(f, "scalar_total_curvature"));
  a.forEach((value, v) => assert.ok(Math.abs(value - b[v]) <= 1.2e-7 * b[v], `vertex ${v}: ${value}, ${b[v]} natively`));

  const { count, drawn } = colours(await pixels(page));
  assert.ok(count > 500 && drawn > 0.1, `${count} colours on ${drawn} of the picture`);
  await page.screenshot({ path: join(shots, "compute-mesh.png") });
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("decimated as the program does, side by side, and saved", async () => {
  gaussmap("shape", "torus", "--grid", "60x30", "-o", "torus.ply", "--quiet");
  const page = await start();
  await measured(page, join(folder, "torus.ply"));
  await page.locator("input[name=ratio]").fill("25");
  assert.equal(await page.locator(".decimate output").textContent(), "25 %: 900 faces");
  await page.click(".decimate button");
  await page.waitForFunction(() => JSON.parse(document.querySelector(".summary").dataset.report ?? "{}").faces_out);
  await ended(page);
  const report = JSON.parse(await page.locator(".summary").getAttribute("data-report"));
  const expected = native("decimate", "torus.ply", "--ratio", "0.25", "-o", "small.ply");
  assert.equal(report.faces_in, 3600);
  assert.equal(report.faces_out, expected.faces_out);
  assert.ok(report.error.rms < 1.05 * expected.error.rms, `rms ${report.error.rms}, ${expected.error.rms} natively`);

  const file = await saved(page);
  assert.equal(file.name, "torus-decimated.ply");
  const info = native("info", file.path), wanted = native("info", "small.ply");
  for (const key of ["vertices", "faces"]) assert.deepEqual(info[key], wanted[key], key);
  const header = (bytes) => bytes.subarray(0, bytes.indexOf("end_header")).toString("latin1");
  assert.equal(header(file.bytes), header(readFileSync(join(folder, "small.ply"))));
  assert.equal(await page.locator(".names span").count(), 2);
  await page.screenshot({ path: join(shots, "compute-decimated.png") });
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("text formats, STL and clouds", async () => {
  gaussmap("shape", "ellipsoid", "--subdivisions", "3", "-o", "egg.obj", "-o", "egg.stl", "-o", "egg.off", "-o", "egg.xyz", "-o", "egg.pcd", "--quiet");
  const page = await start();
  for (const name of ["egg.obj", "egg.stl", "egg.off", "egg.xyz", "egg.pcd"]) {
    const report = await measured(page, join(folder, name));
    assert.ok(report, `${name}: ${await page.locator(".failure").textContent()}`);
    same(report, native("curvature", name));
    assert.equal(await page.locator(".decimate").isVisible(), report.kind === "mesh", name);
  }
  await page.screenshot({ path: join(shots, "compute-cloud.png") });
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a broken file has the complaint of the program, and the page goes on", async () => {
  gaussmap("shape", "sphere", "--subdivisions", "2", "-o", "ball.ply", "--quiet");
  const whole = readFileSync(join(folder, "ball.ply"));
  writeFileSync(join(folder, "cut.ply"), whole.subarray(0, whole.length - 100));
  writeFileSync(join(folder, "odd.obj"), "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
  writeFileSync(join(folder, "empty.ply"), "");
  writeFileSync(join(folder, "number.xyz"), "1 2 3\n4 five 6\n");
  const page = await start();
  for (const name of ["cut.ply", "odd.obj", "empty.ply", "number.xyz"]) {
    const { status, stderr } = spawnSync(program, ["curvature", name], { cwd: folder, encoding: "utf8" });
    assert.equal(status, 3, stderr);
    assert.equal(await measured(page, join(folder, name)), null, name);
    assert.equal(`gaussmap: ${await page.locator(".failure").textContent()}\n`, stderr);
    assert.equal(await page.locator(".download").isVisible(), false);
  }
  await page.screenshot({ path: join(shots, "compute-broken.png") });
  assert.ok(await measured(page, join(folder, "ball.ply")));
  assert.equal(await page.locator(".failure").isVisible(), false);
  await page.context().close();
});

test("a file beyond the memory has one message", async () => {
  const page = await start();
  await page.evaluate(() => {
    const part = new Blob([new Uint8Array(2 ** 26)]), transfer = new DataTransfer();
    transfer.items.add(new File(Array(17).fill(part), "huge.ply"));
    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
  await ended(page);
  assert.equal(await page.locator(".failure").textContent(), "huge.ply: 1.06 GiB are more than the 1 GiB that this page takes; use the program gaussmap");
  await page.context().close();
});

test("cancelling ends the work, and the next file is measured", async () => {
  gaussmap("shape", "bumpy", "--subdivisions", "6", "-o", "large.ply", "--quiet");
  const page = await start();
  await measured(page, join(folder, "large.ply"));
  await page.click(".decimate button");
  // The page is awake while the worker works: it takes the click.
  await page.click(".cancel");
  await ended(page);
  assert.equal(await page.locator(".failure").textContent(), "Cancelled.");
  assert.ok(await measured(page, join(folder, "large.ply")));
  await page.context().close();
});

test("nothing goes over the network, and nothing could", async () => {
  gaussmap("shape", "torus", "-o", "torus.ply", "--quiet");
  const page = await start();
  assert.ok(await measured(page, join(folder, "torus.ply")));
  assert.deepEqual(page.requests, [address]);
  const refused = await page.evaluate(() => fetch("https://example.org/").then(() => "sent", (e) => e.name));
  assert.equal(refused, "TypeError");
  assert.match(page.complaints.join("\n"), /Content Security Policy/);
  await page.context().close();
});

test("no serious finding of axe", async () => {
  gaussmap("shape", "torus", "-o", "torus.ply", "--quiet");
  const page = await start();
  const findings = async () => {
    await page.evaluate(readFileSync(axe, "utf8"));
    const { violations, passes } = await page.evaluate(() => globalThis.axe.run());
    assert.ok(passes.length > 10);
    return violations.filter((v) => ["serious", "critical"].includes(v.impact)).map((v) => `${v.id}: ${v.nodes.map((n) => n.target).join(" ")}`);
  };
  assert.deepEqual(await findings(), []);
  await measured(page, join(folder, "torus.ply"));
  assert.deepEqual(await findings(), []);
  await page.context().close();
});

// The paper's cow, where its data are at hand.
const cow = join(project, "../shared/data/meshes/seed/cow.ply");
test("the cow", { skip: existsSync(cow) ? false : "../shared/data is not there" }, async () => {
  const page = await start();
  same(await measured(page, cow), JSON.parse(execFileSync(program, ["curvature", cow, "--json"], { encoding: "utf8" })));
  await page.screenshot({ path: join(shots, `compute-${basename(cow)}.png`) });
  await page.context().close();
});
