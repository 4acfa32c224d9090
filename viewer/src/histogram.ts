// How the values are spread, and two handles for the first and the last colour: by pointer, finger or key.
import { mapBytes, mapSize, type MapName } from "./colormaps";
import { logTicks, shortNumber, ticks } from "./numbers";
import { fractionBelow, placeOf, type Range, type Statistics, valueAt, valueOfPlace } from "./range";

export interface HistogramData {
  statistics: Statistics[];
  range: Range;
  logarithmic: boolean;
  map: MapName;
}

const bins = 90;

export class Histogram {
  private data: HistogramData | null = null;
  private axis: Range = { low: 0, high: 1 };
  private readonly canvas: HTMLCanvasElement;
  private readonly marks: HTMLElement;
  private readonly handles: [HTMLElement, HTMLElement];

  constructor(root: HTMLElement, private readonly changed: (range: Range) => void) {
    root.classList.add("histogram");
    root.innerHTML = `<canvas aria-hidden="true"></canvas>
      <div class="handle low" role="slider" tabindex="0" aria-label="Value of the first colour" aria-valuemin="0" aria-valuemax="100"></div>
      <div class="handle high" role="slider" tabindex="0" aria-label="Value of the last colour" aria-valuemin="0" aria-valuemax="100"></div>
      <div class="marks" aria-hidden="true"></div>`;
    this.canvas = root.querySelector("canvas")!;
    this.marks = root.querySelector(".marks")!;
    this.handles = [root.querySelector(".low")!, root.querySelector(".high")!];
    this.handles.forEach((handle, which) => {
      handle.addEventListener("pointerdown", (e) => {
        handle.setPointerCapture(e.pointerId);
        e.stopPropagation();
      });
      handle.addEventListener("pointermove", (e) => {
        if (handle.hasPointerCapture(e.pointerId)) this.moveTo(which, this.valueUnder(e.clientX));
      });
      handle.addEventListener("keydown", (e) => this.key(e, which));
    });
    this.canvas.addEventListener("pointerdown", (e) => {
      const value = this.valueUnder(e.clientX), { low, high } = this.data!.range;
      const place = (v: number): number => placeOf(v, this.axis, this.data!.logarithmic);
      const which = Math.abs(place(value) - place(low)) < Math.abs(place(value) - place(high)) ? 0 : 1;
      this.handles[which].focus();
      this.handles[which].setPointerCapture(e.pointerId);
      this.moveTo(which, value);
    });
    new ResizeObserver(() => this.data && this.paint()).observe(root);
  }

  show(data: HistogramData): void {
    const before = this.data;
    this.data = data;
    // While a handle is dragged the axis stays.
    const same = before && before.logarithmic === data.logarithmic && before.statistics.every((s, i) => s === data.statistics[i]) && before.statistics.length === data.statistics.length;
    if (!same || data.range.low < this.axis.low || data.range.high > this.axis.high) this.axis = axisOf(data);
    this.paint();
  }

  private get pooled(): Statistics[] {
    return this.data!.statistics.filter((s) => s.sorted.length > 0);
  }

  /** Percentile of a value among all that are shown, 0 to 100. */
  private percentile(value: number): number {
    const all = this.pooled;
    const size = all.reduce((sum, s) => sum + s.sorted.length, 0);
    return size ? (100 * all.reduce((sum, s) => sum + fractionBelow(s.sorted, value) * s.sorted.length, 0)) / size : 0;
  }
  private valueOfPercentile(percent: number): number {
    return Math.max(...this.pooled.map((s) => valueAt(s.sorted, percent / 100)));
  }

  private key(e: KeyboardEvent, which: number): void {
    const steps: Record<string, number> = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -100, End: 100 };
    const step = steps[e.key];
    if (step === undefined) return;
    e.preventDefault();
    e.stopPropagation();
    const { low, high } = this.data!.range, from = which === 0 ? low : high;
    const to = Math.min(100, Math.max(0, Math.round(this.percentile(from)) + step));
    let value = to === 0 && which === 0 && !this.data!.logarithmic ? Math.min(0, this.valueOfPercentile(0)) : this.valueOfPercentile(to);
    // Many equal values: the percentile moves, the value does not; a part of the axis then.
    if (value === from || (step > 0) !== value > from) value = valueOfPlace(placeOf(from, this.axis, this.data!.logarithmic) + Math.sign(step) * 0.02, this.axis, this.data!.logarithmic);
    this.moveTo(which, value);
  }

  private valueUnder(clientX: number): number {
    const box = this.canvas.getBoundingClientRect();
    const place = Math.min(1, Math.max(0, (clientX - box.left) / box.width));
    return valueOfPlace(place, this.axis, this.data!.logarithmic);
  }

  private moveTo(which: number, value: number): void {
    const { low, high } = this.data!.range, apart = (this.axis.high - this.axis.low) * 1e-4;
    if (!Number.isFinite(value)) return;
    if (this.data!.logarithmic && !(value > 0)) return;
    if (which === 0) this.changed({ low: Math.min(value, high - Math.min(apart, (high - low) / 2)), high });
    else this.changed({ low, high: Math.max(value, low + Math.min(apart, (high - low) / 2)) });
  }

  private paint(): void {
    const { range, logarithmic, map } = this.data!;
    const ratio = window.devicePixelRatio || 1, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width) return;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const g = this.canvas.getContext("2d")!;
    g.scale(ratio, ratio);
    const counts = countsOf(this.pooled, this.axis, logarithmic), most = Math.max(1, ...counts);
    const colours = mapBytes(map), bar = width / bins;
    counts.forEach((count, i) => {
      if (count === 0) return;
      const value = valueOfPlace((i + 0.5) / bins, this.axis, logarithmic);
      const at = 4 * Math.round(Math.min(1, Math.max(0, placeOf(value, range, logarithmic))) * (mapSize - 1));
      // The square root keeps the few in sight beside the many.
      const tall = Math.max(1.5, Math.sqrt(count / most) * (height - 4));
      g.fillStyle = `rgb(${colours[at]},${colours[at + 1]},${colours[at + 2]})`;
      g.fillRect(i * bar, height - tall, Math.max(1, bar - 0.6), tall);
    });
    [range.low, range.high].forEach((value, which) => {
      const handle = this.handles[which]!, percent = this.percentile(value);
      const place = Math.min(1, Math.max(0, placeOf(value, this.axis, logarithmic)));
      handle.style.left = `${100 * place}%`;
      handle.setAttribute("aria-valuenow", percent.toFixed(1));
      handle.setAttribute("aria-valuetext", `${shortNumber(value)}, percentile ${percent.toFixed(0)}`);
      handle.title = `${shortNumber(value)} (percentile ${percent.toFixed(1)})`;
    });
    const values = logarithmic ? logTicks(this.axis.low, this.axis.high) : ticks(this.axis.low, this.axis.high, 5);
    this.marks.replaceChildren(
      ...values.map((v) => {
        const mark = document.createElement("span");
        mark.textContent = shortNumber(v);
        mark.style.left = `${100 * placeOf(v, this.axis, logarithmic)}%`;
        return mark;
      }),
    );
  }
}

/** From 0, or what is below it, to a little beyond the range and most of the values: a long tail does not squeeze the rest. */
function axisOf({ statistics, range, logarithmic }: HistogramData): Range {
  const some = statistics.filter((s) => s.sorted.length > 0);
  const ends = (fraction: number): number[] => some.map((s) => valueAt(s.sorted, fraction));
  if (logarithmic) {
    const least = Math.min(range.low, ...some.map((s) => valueAt(s.sorted, Math.max(0.002, fractionBelow(s.sorted, Number.MIN_VALUE) + 1e-3))).filter((v) => v > 0));
    const most = Math.max(range.high, ...ends(0.998));
    return { low: least / 1.2, high: most * 1.2 };
  }
  const low = Math.min(range.low, ...ends(0.002)), high = Math.max(range.high, ...ends(0.992));
  const most = Math.min(high, low + 3 * (range.high - low));
  return { low, high: Math.max(range.high + 0.08 * (range.high - low), most) };
}

function countsOf(statistics: Statistics[], axis: Range, logarithmic: boolean): number[] {
  const counts = new Array<number>(bins).fill(0);
  for (const { sorted } of statistics) {
    const step = Math.max(1, Math.floor(sorted.length / 200_000));
    for (let i = 0; i < sorted.length; i += step) {
      const place = placeOf(sorted[i]!, axis, logarithmic);
      if (place >= 0 && place <= 1) counts[Math.min(bins - 1, Math.floor(place * bins))]! += 1;
    }
  }
  return counts;
}
