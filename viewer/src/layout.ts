// The page's elements, with their names for people who hear them.
import { mapNames } from "./colormaps";

const check = (name: string, label: string, key = ""): string =>
  `<label class="check"><input type="checkbox" name="${name}" />${label}${key ? ` <kbd>${key}</kbd>` : ""}</label>`;
const view = (name: string, label: string, key: string): string =>
  `<button type="button" data-view="${name}" title="${label} (${key})">${label}</button>`;

export const layout = `
<div class="stage">
  <canvas class="picture" tabindex="0" role="img"></canvas>
  <div class="names" aria-hidden="true"></div>
  <div class="legends"></div>
  <div class="tip" hidden></div>
  <div class="spoken" role="status" aria-live="polite"></div>
  <button type="button" class="toggle" data-do="panel" aria-expanded="true" aria-controls="panel" title="Show or hide the controls (H)">☰<span class="spoken"> Controls</span></button>
</div>
<form class="panel" id="panel" aria-label="Controls">
  <h1></h1>
  <section aria-label="Values">
    <label class="row">Values <select name="field"></select></label>
    <label class="row">Colours <select name="map">${mapNames.map((m) => `<option>${m}</option>`).join("")}</select></label>
  </section>
  <section aria-label="Range of the colours" class="ranges">
    <div class="which row" hidden role="radiogroup" aria-label="Range of">
      <label class="check"><input type="radio" name="pane" value="0" checked />left</label>
      <label class="check"><input type="radio" name="pane" value="1" />right</label>
    </div>
    <div class="values"></div>
    <div class="row ends">
      <input name="low" inputmode="decimal" aria-label="Value of the first colour" autocomplete="off" />
      <button type="button" data-do="auto" title="0 to the 98th percentile (A)">Auto</button>
      <input name="high" inputmode="decimal" aria-label="Value of the last colour" autocomplete="off" />
    </div>
    ${check("log", "Logarithmic", "L")}
  </section>
  <section aria-label="Shown">
    ${check("wire", "Wireframe", "W")}${check("hairs", "Normals as hairs", "N")}${check("boundary", "Boundary edges", "B")}
    <label class="row size">Point size <input type="range" name="size" min="-1.5" max="1.5" step="0.05" aria-label="Point size" /></label>
    <div class="links">${check("linkCameras", "Link cameras")}${check("linkRanges", "Link ranges")}</div>
  </section>
  <section aria-label="View" class="views">
    ${view("reset", "Reset", "R")}${view("front", "Front", "1")}${view("back", "Back", "2")}${view("left", "Left", "3")}
    ${view("right", "Right", "4")}${view("top", "Top", "5")}${view("bottom", "Bottom", "6")}
  </section>
  <section aria-label="Numbers" class="facts"></section>
  <section aria-label="Page" class="actions">
    <button type="button" data-do="screenshot" title="Save the picture (S)">Screenshot</button>
    <button type="button" data-do="theme" title="Dark or light (T)">Dark / light</button>
    <button type="button" data-do="help" title="Keys (?)">Keys</button>
  </section>
</form>
<dialog class="help" aria-label="Keys">
  <h2>Keys and gestures</h2>
  <table>
    <tr><th scope="row">drag, one finger, arrows</th><td>turn</td></tr>
    <tr><th scope="row">right drag, two fingers, Shift + arrows</th><td>move</td></tr>
    <tr><th scope="row">wheel, pinch, + −</th><td>nearer, farther</td></tr>
    <tr><th scope="row">double click</th><td>turn about that place</td></tr>
    <tr><th scope="row">hover, tap</th><td>value, index and coordinates</td></tr>
    <tr><th scope="row">F</th><td>next values</td></tr>
    <tr><th scope="row">A · L</th><td>automatic range · logarithmic</td></tr>
    <tr><th scope="row">W · N · B</th><td>wireframe · normals · boundary</td></tr>
    <tr><th scope="row">R · 1 … 6</th><td>reset · front, back, left, right, top, bottom</td></tr>
    <tr><th scope="row">S · T · H</th><td>screenshot · dark or light · controls</td></tr>
    <tr><th scope="row">arrows, Page, Home, End on a handle</th><td>move it by percentiles</td></tr>
  </table>
  <button type="button" data-do="close">Close</button>
</dialog>`;
