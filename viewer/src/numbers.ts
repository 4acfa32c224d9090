// Numbers for people.

/** The fewest digits that give the stored number back: what a file that holds it says. */
export function exactDigits(value: number, single: boolean): string {
  if (!Number.isFinite(value)) return "undefined";
  if (single)
    for (let digits = 1; digits < 10; ++digits) {
      const text = value.toPrecision(digits);
      if (Math.fround(Number(text)) === value) return String(Number(text));
    }
  return String(value);
}

/** About three digits. */
export function shortNumber(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(size >= 1000 ? 4 : 3)));
}

export const grouped = (n: number): string => n.toLocaleString("en-US");

/** "1 face", "1,234 faces" */
export const counted = (n: number, one: string, many = one + "s"): string => `${grouped(n)} ${n === 1 ? one : many}`;

/** Round numbers between the ends, about `wanted` of them. */
export function ticks(low: number, high: number, wanted: number): number[] {
  const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999)!;
  const out: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(Number((i * step).toPrecision(12)));
  return out;
}

/** Powers of ten between positive ends, and their 2 and 5 where there are few. */
export function logTicks(low: number, high: number): number[] {
  const decades = Math.log10(high / low);
  const steps = decades > 3 ? [1] : decades > 1 ? [1, 3] : [1, 2, 5];
  const skip = Math.max(1, Math.ceil(decades / 6));
  const out: number[] = [];
  for (let p = Math.floor(Math.log10(low)); p <= Math.log10(high); ++p)
    for (const s of steps) if (p % skip === 0) {
      const v = Number(`${s}e${p}`);
      if (v >= low * 0.9999 && v <= high * 1.0001) out.push(v);
    }
  return out;
}
