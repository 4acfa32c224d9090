// Which values get the first and the last colour: the rule of include/gaussmap/picture.h, so that a page and a picture agree.
import type { Field } from "./scene";

export interface Range {
  low: number;
  high: number;
}

/** What is known of a field's values; of over two million, the percentiles are those of an even sample. */
export interface Statistics {
  count: number;
  undefined: number;
  least: number;
  most: number;
  sorted: Float32Array | Float64Array;
}

const sampleSize = 2_000_000;
const known = new WeakMap<Field, Statistics>();

export function statisticsOf(field: Field): Statistics {
  const found = known.get(field);
  if (found) return found;
  const { values } = field;
  let undefinedCount = 0, least = Infinity, most = -Infinity;
  for (let i = 0; i < values.length; ++i) {
    const v = values[i]!;
    if (v - v !== 0) ++undefinedCount;
    else {
      if (v < least) least = v;
      if (v > most) most = v;
    }
  }
  const step = Math.max(1, Math.ceil(values.length / sampleSize));
  const sample = values.slice(0, Math.ceil(values.length / step));
  let kept = 0;
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i]!)) sample[kept++] = values[i]!;
  const result = { count: values.length, undefined: undefinedCount, least, most, sorted: sample.slice(0, kept).sort() };
  known.set(field, result);
  return result;
}

/** Value at a fraction of the ranks, linear between them; NaN of nothing. */
export function valueAt(sorted: ArrayLike<number>, fraction: number): number {
  if (sorted.length === 0) return NaN;
  const rank = Math.min(1, Math.max(0, fraction)) * (sorted.length - 1);
  const below = Math.floor(rank), low = sorted[below]!;
  return below + 1 === sorted.length ? low : low + (rank - below) * (sorted[below + 1]! - low);
}

/** The fraction of ranks below a value. */
export function fractionBelow(sorted: ArrayLike<number>, value: number): number {
  let begin = 0, end = sorted.length;
  while (begin < end) {
    const middle = (begin + end) >> 1;
    if (sorted[middle]! < value) begin = middle + 1;
    else end = middle;
  }
  return sorted.length > 1 ? Math.min(1, begin / (sorted.length - 1)) : 0;
}

/** \param radius  half the diagonal of the box. */
export function automaticRange(field: Field, radius: number, logarithmic: boolean): Range {
  const { sorted, least, most } = statisticsOf(field);
  if (logarithmic && most > 0) {
    const first = fractionBelow(sorted, Number.MIN_VALUE);
    const low = valueAt(sorted, first + 0.02 * (1 - first)), high = valueAt(sorted, first + 0.98 * (1 - first));
    if (low > 0 && high > low) return { low, high };
  }
  let low = 0, high = 0;
  if (sorted.length > 0) {
    const first = valueAt(sorted, 0.02), last = valueAt(sorted, 0.98), reach = Math.max(Math.abs(first), Math.abs(last));
    high = field.diverging ? (most <= 0 ? 0 : reach) : last;
    low = least < 0 ? (field.diverging ? -reach : first) : 0;
  }
  const noise = field.noise > 0 && Math.max(Math.abs(low), Math.abs(high)) < field.noise;
  if (!noise && high > low) return { low, high };
  // Nothing varies. A flat object keeps a scale that belongs to its size.
  if (noise) low = 0;
  const square = 1 / (4 * radius * radius);
  const scale = field.unit === "1/unit²" ? square : field.unit === "1/unit" ? Math.sqrt(square) : 1;
  return { low, high: low + scale > low ? low + scale : low + Math.max(Math.abs(low) * 1e-6, Number.MIN_VALUE) };
}

export function unionOf(ranges: Range[]): Range {
  return { low: Math.min(...ranges.map((r) => r.low)), high: Math.max(...ranges.map((r) => r.high)) };
}

/** Where a value lies between the ends, 0 to 1 inside. */
export function placeOf(value: number, { low, high }: Range, logarithmic: boolean): number {
  if (!logarithmic) return (value - low) / (high - low);
  if (!(value > 0)) return -Infinity;
  return Math.log(value / low) / Math.log(high / low);
}

export function valueOfPlace(place: number, { low, high }: Range, logarithmic: boolean): number {
  return logarithmic ? low * (high / low) ** place : low + place * (high - low);
}
