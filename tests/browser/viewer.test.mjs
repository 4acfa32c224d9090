// The viewer in a browser: what it draws, says and refuses. Screenshots stay in build/browser/.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { axe, close, colours, difference, drawn, folder, gaussmap, pixels, shots, show } from "./browser.mjs";
import { readPly } from "./ply.mjs";

before(() => {
  gaussmap("shape", "torus", "--grid", "90x45", "-o", "torus.ply");
  gaussmap("shape", "torus", "--grid", "30x15", "-o", "small.ply");
  gaussmap("curvature", "torus.ply", "--tensor", "-o", "torus.html", "-o", "measured.ply");
  gaussmap("view", "torus.ply", "small.ply", "-o", "two.html");
  gaussmap("curvature", "torus.ply", "--as", "cloud", "-o", "cloud.html", "-o", "cloud.ply");
});
after(close);

const shot = (page, name) => page.screenshot({ path: join(shots, `${name}.png`) });
const quiet = (page) => {
  assert.deepEqual(page.complaints, [], "nothing on the console");
  assert.deepEqual(page.requests, [page.address], "no request but the page itself");
};
const change = async (page, name, value) => {
  await page.selectOption(`[name=${name}]`, value);
  await drawn(page);
};
/** Points at places of the canvas until something is there; what the page says of it. */
async function point(page, places) {
  for (const [x, y] of places) {
    await page.mouse.move(x, y);
    await drawn(page);
    const tip = page.locator(".tip");
    if (await tip.isVisible()) return { ...(await tip.evaluate((t) => ({ ...t.dataset }))), text: await tip.innerText() };
  }
  return assert.fail("nothing under the pointer anywhere");
}
const places = [[300, 470], [250, 400], [450, 520], [600, 460], [450, 250], [700, 380]];

test("a mesh is drawn in many colours, quietly", async () => {
  const page = await show("torus.html");
  const seen = colours(await pixels(page));
  assert.ok(seen.count > 1000, `${seen.count} colours`);
  assert.ok(seen.drawn > 0.15 && seen.drawn < 0.9, `${seen.drawn} of the picture`);
  await shot(page, "mesh");
  quiet(page);
  assert.match(await page.locator(".legend").innerText(), /total curvature k1² \+ k2² \[1\/unit²\]/);
  assert.match(await page.locator(".facts").innerText(), /4,050 vertices, 8,100 faces[\s\S]*undefined\s+0/);
  await page.context().close();
});

test("the value under the pointer is the number in the PLY: vertices, faces, points", async () => {
  const mesh = readPly(join(folder, "measured.ply")), cloud = readPly(join(folder, "cloud.ply"));
  for (const [file, key, ply, property] of [
    ["torus.html", "density", mesh.vertex, "scalar_total_curvature"],
    ["torus.html", "k2", mesh.vertex, "k2"],
    ["torus.html", "kappa:face", mesh.face, "kappa"],
    ["cloud.html", "density", cloud.vertex, "scalar_total_curvature"],
  ]) {
    const page = await show(file, { hash: `#field=${key}` });
    for (const [x, y] of places.slice(0, 2)) {
      const tip = await point(page, [[x, y], ...places]);
      const index = key.endsWith(":face") ? Number(tip.face) : Number(tip.vertex);
      assert.equal(Math.fround(Number(tip.value)), ply[property][index], `${file} ${key} ${index}`);
      assert.match(tip.text, key.endsWith(":face") ? /face [\d,]+/ : file === "cloud.html" ? /point [\d,]+/ : /vertex [\d,]+/);
    }
    if (file === "cloud.html" || key === "density") await shot(page, `hover-${file.slice(0, -5)}`);
    quiet(page);
    await page.context().close();
  }
});

test("the vertex named is the nearest to the pointer, and its coordinates are those of the file", async () => {
  const page = await show("torus.html"), { vertex } = readPly(join(folder, "measured.ply"));
  for (const v of [0, 15, 22]) {
    const at = await page.evaluate((i) => window.gaussmapViewer.stage.placeOf(0, i), v);
    const tip = await page.evaluate(([x, y]) => window.gaussmapViewer.stage.pick(x, y), [at.x, at.y]);
    if (!tip) continue;
    await page.mouse.move(at.x, at.y);
    await drawn(page);
    const named = await page.locator(".tip").evaluate((t) => Number(t.dataset.vertex));
    const where = await page.evaluate((i) => window.gaussmapViewer.stage.placeOf(0, i), named);
    assert.ok(Math.hypot(where.x - at.x, where.y - at.y) < 2.5, "something in front, or the vertex itself");
    const text = await page.locator(".tip").innerText();
    const [x, y, z] = text.match(/\(([^)]+)\)/)[1].split(", ").map(Number);
    for (const [value, axis] of [[x, "x"], [y, "y"], [z, "z"]]) assert.ok(Math.abs(value - vertex[axis][named]) < 2e-6, axis);
  }
  await page.context().close();
});

test("handles recolour, by key, pointer and number; Auto takes it back", async () => {
  const page = await show("torus.html"), first = await pixels(page);
  const high = page.locator(".handle.high"), text = () => page.locator("[name=high]").inputValue();
  const automatic = await text();
  await high.focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("PageDown");
  const second = await pixels(page);
  assert.ok(difference(first, second) > 0.1);
  assert.ok(Number(await text()) < Number(automatic));
  assert.match(await high.getAttribute("aria-valuetext"), /^\S+, percentile \d\d$/);
  const box = await page.locator(".histogram canvas").boundingBox();
  await page.mouse.move(box.x + 1, box.y + 70);
  const low = await page.locator(".handle.low").boundingBox();
  await page.mouse.move(low.x + 9, low.y + 70);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.5, box.y + 70, { steps: 4 });
  await page.mouse.up();
  assert.ok(difference(second, await pixels(page)) > 0.1);
  assert.ok(Number(await page.locator("[name=low]").inputValue()) > 0);
  await shot(page, "range");
  await page.locator("[name=high]").fill("100");
  await page.locator("[name=high]").press("Enter");
  await page.locator("[name=low]").fill("0");
  await page.locator("[name=low]").press("Enter");
  const third = await pixels(page);
  assert.equal(await text(), "100");
  await page.getByRole("button", { name: "Auto" }).click();
  assert.equal(await text(), automatic);
  assert.ok(difference(third, await pixels(page)) > 0.1);
  await page.locator("[name=log]").check();
  assert.ok(Number(await page.locator("[name=low]").inputValue()) > 0, "a logarithm begins above 0");
  assert.ok(difference(first, await pixels(page)) > 0.1);
  quiet(page);
  await page.context().close();
});

test("fields, maps, wireframe, hairs and boundary each change the picture", async () => {
  const page = await show("torus.html");
  let before = await pixels(page);
  const differs = async (what) => {
    const now = await pixels(page);
    assert.ok(difference(before, now) > 0.003, what);
    before = now;
  };
  for (const key of ["k2", "kappa:face", "gaussian", "normals", "density"]) {
    await change(page, "field", key);
    await differs(key);
    if (key === "k2") assert.equal(await page.locator("[name=map]").inputValue(), "coolwarm");
    if (key === "normals") assert.equal(await page.locator(".ranges").isVisible(), false);
  }
  for (const map of ["magma", "cividis", "coolwarm", "viridis"]) {
    await change(page, "map", map);
    await differs(map);
  }
  for (const key of ["w", "n"]) {
    await page.locator("canvas.picture").press(key);
    await differs(key);
  }
  await shot(page, "wireframe-hairs");
  await page.locator("canvas.picture").press("n");
  await page.locator("canvas.picture").press("w");
  await drawn(page);
  before = await pixels(page);
  for (const press of ["ArrowLeft", "Shift+ArrowUp", "+", "5", "r"]) {
    await page.locator("canvas.picture").press(press);
    await page.waitForTimeout(250);
    await differs(press);
  }
  quiet(page);
  await page.context().close();
});

test("boundary edges and undefined vertices are drawn apart and counted", async () => {
  gaussmap("shape", "catenoid", "-o", "open.ply");
  writeFileSync(join(folder, "lonely.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv 0 1 0\nv 5 5 5\nv 0.5 0.5 1\nf 1 2 3\nf 1 3 4\nf 1 2 6\n");
  gaussmap("view", "lonely.obj", "-o", "lonely.html");
  const lonely = await show("lonely.html");
  assert.match(await lonely.locator(".facts").innerText(), /undefined\s+1/);
  assert.match(await lonely.locator(".legend").innerText(), /1 vertex undefined/);
  await lonely.context().close();
  gaussmap("view", "open.ply", "-o", "open.html");
  const page = await show("open.html"), first = await pixels(page);
  await page.locator("[name=boundary]").check();
  assert.ok(difference(first, await pixels(page)) > 0.001);
  assert.match(await page.locator(".facts").innerText(), /boundary\s+144 edges/);
  await shot(page, "boundary");
  quiet(page);
  await page.context().close();
});

test("a plane looks like a plane", async () => {
  gaussmap("shape", "plane", "-o", "plane.ply");
  // Noise of rounding on it.
  const text = (gaussmap("convert", "plane.ply", "-o", "plane.obj"), readFileSync(join(folder, "plane.obj"), "utf8"));
  writeFileSync(join(folder, "noisy.obj"), text.replace(/^v (\S+) (\S+) (\S+)/gm, (_, x, y) => `v ${x} ${y} ${(Math.sin(1e4 * x * y) * 1e-12).toExponential(5)}`));
  gaussmap("view", "noisy.obj", "-o", "plane.html", "--from", "0,0,1");
  const page = await show("plane.html");
  const { seen, back } = colours(await pixels(page));
  const surface = [...seen].filter(([colour]) => colour !== back).sort((a, b) => b[1] - a[1]);
  assert.ok(surface[0][1] > 20_000, "the plane is there");
  const blue = (colour) => (colour >> 16) & 255, green = (colour) => (colour >> 8) & 255;
  for (const [colour, count] of surface) if (count > 500) assert.ok(blue(colour) > green(colour), "the first colour alone: violet");
  await shot(page, "plane");
  await page.context().close();
});

test("two objects side by side, cameras and ranges linked or not", async () => {
  const page = await show("two.html");
  const poses = () => page.evaluate(() => window.gaussmapViewer.stage.panes.map((p) => p.pose.yaw));
  assert.equal(await page.locator(".names span").count(), 2);
  await shot(page, "two");
  await page.locator("canvas.picture").press("ArrowLeft");
  let [a, b] = await poses();
  assert.equal(a, b);
  await page.locator("[name=linkCameras]").uncheck();
  await page.mouse.move(700, 400);
  await page.mouse.down();
  await page.mouse.move(760, 400, { steps: 3 });
  await page.mouse.up();
  [a, b] = await poses();
  assert.notEqual(a, b);
  assert.equal(await page.locator(".legend").count(), 1);
  await page.locator("[name=linkRanges]").uncheck();
  await drawn(page);
  assert.equal(await page.locator(".legend").count(), 2);
  await page.locator("[name=pane][value='1']").check();
  const before = await pixels(page);
  await page.locator(".handle.high").focus();
  for (let i = 0; i < 5; ++i) await page.keyboard.press("PageDown");
  const after = await pixels(page), half = before.width / 2;
  let left = 0, right = 0;
  for (let i = 0; i < before.data.length; i += 4)
    if (before.data.readUInt32LE(i) !== after.data.readUInt32LE(i)) (i / 4) % before.width < half ? ++left : ++right;
  assert.ok(left === 0 && right > 1000, `${left} and ${right} pixels changed`);
  await shot(page, "two-unlinked");
  quiet(page);
  await page.context().close();
});

test("the address holds what was chosen, and brings it back", async () => {
  const page = await show("torus.html");
  await change(page, "field", "k2");
  await page.locator("[name=wire]").check();
  await page.locator("[name=high]").fill("1.5");
  await page.locator("[name=high]").press("Enter");
  await page.locator("canvas.picture").press("ArrowLeft");
  await page.locator("canvas.picture").press("t");
  await page.waitForTimeout(500);
  const hash = new URL(page.url()).hash;
  assert.match(hash, /field=k2/);
  const again = await show("torus.html", { hash });
  await page.reload();
  await page.locator("#app[data-ready=true]").waitFor();
  assert.equal(await again.locator("[name=field]").inputValue(), "k2");
  assert.equal(await again.locator("[name=high]").inputValue(), "1.5");
  assert.ok(await again.locator("[name=wire]").isChecked());
  assert.equal(difference(await pixels(page), await pixels(again)), 0);
  await page.context().close();
  await again.context().close();
});

test("dark and light, by preference and by key", async () => {
  const brightness = async (page) => colours(await pixels(page)).back & 255;
  const dark = await show("torus.html", { colorScheme: "dark" }), light = await show("torus.html", { colorScheme: "light" });
  assert.ok((await brightness(dark)) < 60 && (await brightness(light)) > 200);
  await shot(dark, "dark");
  await dark.locator("canvas.picture").press("t");
  assert.ok((await brightness(dark)) > 200);
  await dark.context().close();
  await light.context().close();
});

test("no serious finding of axe, in light, dark and help", async () => {
  for (const [file, colorScheme] of [["two.html", "light"], ["torus.html", "dark"]]) {
    const page = await show(file, { colorScheme });
    await page.addScriptTag({ path: axe });
    for (const dialog of [false, true]) {
      if (dialog) await page.locator("canvas.picture").press("?");
      const { violations, passes } = await page.evaluate(() => window.axe.run());
      const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
      assert.deepEqual(serious.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" ")}`), []);
      assert.ok(passes.length > 5, "axe looked");
    }
    await shot(page, `help-${colorScheme}`);
    await page.context().close();
  }
});

test("touch: a tap names, one finger turns, two zoom; small screens", async () => {
  const page = await show("torus.html", { hasTouch: true, isMobile: true, viewport: { width: 420, height: 800 } });
  for (const [x, y] of [[120, 260], [200, 290], [300, 250]]) {
    await page.touchscreen.tap(x, y);
    await drawn(page);
    if (await page.locator(".tip").isVisible()) break;
  }
  assert.match(await page.locator(".tip").innerText(), /vertex/);
  assert.match(await page.locator(".stage > [role=status]").innerText(), /density/);
  await shot(page, "phone");
  const pose = () => page.evaluate(() => ({ ...window.gaussmapViewer.stage.panes[0].pose }));
  const touch = await page.context().newCDPSession(page), first = await pose();
  const send = (type, ...points) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await send("touchStart", [200, 250]);
  await send("touchMove", [260, 250]);
  await send("touchEnd");
  const second = await pose();
  assert.notEqual(first.yaw, second.yaw);
  await send("touchStart", [180, 250], [220, 250]);
  await send("touchMove", [140, 250], [260, 250]);
  await send("touchEnd");
  assert.ok((await pose()).distance < 0.7 * second.distance);
  quiet(page);
  await page.context().close();
});

test("a screenshot has the picture and its legend", async () => {
  const page = await show("torus.html");
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("canvas.picture").press("s")]);
  assert.equal(download.suggestedFilename(), "torus-density.png");
  await download.saveAs(join(shots, "screenshot.png"));
  const bytes = readFileSync(join(shots, "screenshot.png"));
  assert.equal(bytes.readUInt32BE(0), 0x89504e47);
  assert.equal(bytes.readUInt32BE(16), await page.evaluate(() => document.querySelector("canvas.picture").width));
  await page.context().close();
});

test("a broken page says what is wrong", async () => {
  const whole = readFileSync(join(folder, "torus.html"), "utf8");
  const block = /(<script type="text\/plain" id="gaussmap-0">)([^<]*)/;
  for (const [name, page, words] of [
    ["cut", whole.slice(0, whole.indexOf('id="gaussmap-1"')) + '"></script></body>' + whole.match(/<script type="module">[\s\S]*?<\/script>/)[0], /block \d+ of its data is missing/],
    ["damaged", whole.replace(block, (_, a, b) => a + b.slice(0, 200) + "AAAA" + b.slice(204)), /block 0 of its data is damaged/],
    ["short", whole.replace(block, (_, a) => a + "eJwDAAAAAAE="), /block 0 holds 0 bytes instead of/],
    ["no-head", whole.replace(/(id="gaussmap">)\{/, "$1"), /the head of its data is damaged/],
    ["future", whole.replace('"version":1', '"version":9'), /version 9, which this viewer does not know/],
    ["empty", whole.replace(/<script type="application\/json"[\s\S]*?<\/script>/, ""), /holds no data/],
  ]) {
    writeFileSync(join(folder, `${name}.html`), page);
    const shown = await show(`${name}.html`, { ready: false });
    await shown.locator("[role=alert]").waitFor();
    assert.match(await shown.locator("[role=alert]").innerText(), words, name);
    if (name === "damaged") await shot(shown, "broken");
    await shown.context().close();
  }
});

test("a million vertices: drawn, picked, turned", async () => {
  gaussmap("shape", "waves", "--grid", "1000x1000", "-o", "large.ply");
  gaussmap("view", "large.ply", "-o", "large.html");
  const page = await show("large.html");
  assert.match(await page.locator(".facts").innerText(), /1,000,000 vertices, 1,996,002 faces/);
  assert.ok(colours(await pixels(page)).drawn > 0.15);
  const tip = await point(page, places);
  assert.ok(Number(tip.vertex) < 1e6 && Number(tip.value) >= 0);
  await page.locator("canvas.picture").press("ArrowLeft");
  await page.waitForTimeout(500);
  await shot(page, "million");
  quiet(page);
  await page.context().close();
});
