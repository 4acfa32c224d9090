// What the colours mean: on the page, and drawn into a screenshot.
import { mapBytes, mapGradient, mapSize, type MapName } from "./colormaps";
import { counted, logTicks, shortNumber, ticks } from "./numbers";
import { placeOf, type Range } from "./range";

export interface LegendData {
  label: string;
  unit: string;
  range: Range;
  logarithmic: boolean;
  map: MapName;
  /** Values beyond the ends. */
  below: boolean;
  above: boolean;
  undefined: number;
  /** "vertex" or "face" */
  of: string;
}

function ticksOf({ range, logarithmic }: LegendData): number[] {
  const all = logarithmic ? logTicks(range.low, range.high) : ticks(range.low, range.high, 6);
  return all.length >= 2 ? all : [range.low, range.high];
}

function titleOf({ label, unit }: LegendData): string {
  return unit ? `${label} [${unit}]` : label;
}

function undefinedText({ undefined: count, of }: LegendData): string {
  return `${counted(count, of, of === "vertex" ? "vertices" : of + "s")} undefined`;
}

const escaped = (text: string): string => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

/** null: colours that stand for no number, as those of normals. */
export function showLegend(root: HTMLElement, data: LegendData | null, words: string): void {
  if (!data) {
    root.innerHTML = `<div class="title">${escaped(words)}</div><div class="axes"><i style="background:#f77"></i>x <i style="background:#7d7"></i>y <i style="background:#77f"></i>z</div>`;
    return;
  }
  const shape = `${data.below ? "below" : ""} ${data.above ? "above" : ""}`;
  const marks = ticksOf(data).map((v) => `<span style="left:${100 * placeOf(v, data.range, data.logarithmic)}%">${shortNumber(v)}</span>`);
  root.innerHTML = `<div class="title">${escaped(titleOf(data))}</div>
    <div class="bar ${shape}" role="img" aria-label="Colours from ${shortNumber(data.range.low)} to ${shortNumber(data.range.high)}"
      style="background:${mapGradient(data.map, "to right")}"></div>
    <div class="marks">${marks.join("")}</div>
    ${data.undefined ? `<div class="undefined"><i></i>${undefinedText(data)}</div>` : ""}`;
}

/** Into the lower left of a picture; sizes in its pixels. */
export function drawLegend(g: CanvasRenderingContext2D, data: LegendData, height: number, scale: number, ink: string): void {
  const left = 20 * scale, width = 300 * scale, bar = 14 * scale, top = height - 52 * scale;
  g.font = `${13 * scale}px system-ui, sans-serif`;
  g.fillStyle = ink;
  g.textAlign = "left";
  g.fillText(titleOf(data), left, top - 8 * scale);
  const colours = mapBytes(data.map);
  for (let x = 0; x < width; ++x) {
    const at = 4 * Math.round((x / width) * (mapSize - 1));
    g.fillStyle = `rgb(${colours[at]},${colours[at + 1]},${colours[at + 2]})`;
    g.fillRect(left + x, top, 1.5, bar);
  }
  g.fillStyle = ink;
  g.textAlign = "center";
  for (const v of ticksOf(data)) {
    const x = left + width * placeOf(v, data.range, data.logarithmic);
    g.fillRect(x - scale / 2, top + bar, scale, 4 * scale);
    g.fillText(shortNumber(v), x, top + bar + 18 * scale);
  }
  g.textAlign = "left";
  if (data.undefined) g.fillText(undefinedText(data), left + width + 24 * scale, top + bar - 2 * scale);
}
