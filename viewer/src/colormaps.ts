// Colour maps: a few known colours of each, evenly spaced, with what lies between them mixed in OKLab (Ottosson 2020).
// viridis and magma: van der Walt and Smith 2015; cividis: Nuñez, Anderton, Renslow 2018; coolwarm: Moreland 2009.

const anchors = {
  viridis: ["440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"],
  magma: ["000004", "180f3d", "440f76", "721f81", "9e2f7f", "cd4071", "f1605d", "fd9668", "feca8d", "fcfdbf"],
  cividis: ["00224e", "123570", "3b496c", "575d6d", "707173", "8a8678", "a59c74", "c3b369", "e1cc55", "fee838"],
  coolwarm: ["3b4cc0", "6788ee", "9abbff", "c9d7f0", "dddddd", "edd1c2", "f7a889", "e26952", "b40426"],
} as const;

export type MapName = keyof typeof anchors;
export const mapNames = Object.keys(anchors) as MapName[];
export const mapSize = 256;

const decode = (c: number): number => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const encode = (c: number): number => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

function toLab(hex: string): number[] {
  const [r, g, b] = [0, 2, 4].map((at) => decode(parseInt(hex.slice(at, at + 2), 16) / 255)) as [number, number, number];
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

function toBytes(lab: number[]): number[] {
  const [L, a, b] = lab as [number, number, number];
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  return linear.map((c) => Math.round(255 * encode(Math.min(1, Math.max(0, c)))));
}

/** mapSize colours, four bytes each. */
export function mapBytes(name: MapName): Uint8Array<ArrayBuffer> {
  const labs = anchors[name].map(toLab);
  const out = new Uint8Array(4 * mapSize);
  for (let i = 0; i < mapSize; ++i) {
    const at = (i / (mapSize - 1)) * (labs.length - 1);
    const below = Math.min(Math.floor(at), labs.length - 2), part = at - below;
    const lab = labs[below]!.map((c, k) => c + part * (labs[below + 1]![k]! - c));
    out.set([...toBytes(lab), 255], 4 * i);
  }
  return out;
}

/** "linear-gradient(…)" in that direction, of the part [from, to] of the map. */
export function mapGradient(name: MapName, direction: string, from = 0, to = 1): string {
  const bytes = mapBytes(name);
  const stops = Array.from({ length: 33 }, (_, i) => {
    const at = 4 * Math.round(Math.min(1, Math.max(0, from + (to - from) * (i / 32))) * (mapSize - 1));
    return `rgb(${bytes[at]},${bytes[at + 1]},${bytes[at + 2]})`;
  });
  return `linear-gradient(${direction}, ${stops.join(",")})`;
}
