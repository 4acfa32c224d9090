// What is looked at: plain arrays, from a page's data or from a computation in the browser.

export type Triple = [number, number, number];

/** One number a vertex or a face, and how to show it. What is not finite is undefined. */
export interface Field {
  name: string;
  label: string;
  unit: string;
  ofFaces: boolean;
  /** Signed: shown about 0. */
  diverging: boolean;
  /** An automatic range that ends below this is rounding noise. */
  noise: number;
  values: Float32Array | Float64Array;
}

/** A mesh, or a cloud where `triangles` is null. The position of vertex v is origin + positions[3v …]. */
export interface Scene {
  name: string;
  origin: Triple;
  positions: Float32Array | Float64Array;
  triangles: Uint32Array | null;
  /** Octahedral, two a vertex; (−32768, −32768) is none. */
  normals: Int16Array | null;
  /** The radius of a point of a cloud; 0: found here. */
  spacing: number;
  /** From the object to the eye at first, and upward. */
  toward: Triple;
  up: Triple;
  fields: Field[];
}

export const vertexCount = (scene: Scene): number => scene.positions.length / 3;
export const faceCount = (scene: Scene): number => (scene.triangles ? scene.triangles.length / 3 : 0);

/** Where the box of what is drawn lies, and half its diagonal (1 for a single point). */
export interface Frame {
  centre: Triple;
  radius: number;
}

export function isFinitePoint(positions: ArrayLike<number>, v: number): boolean {
  return Number.isFinite(positions[3 * v]! + positions[3 * v + 1]! + positions[3 * v + 2]!);
}

/** The corners of finite faces, the finite points of a cloud. */
function forDrawn(scene: Scene, visit: (v: number) => void): void {
  const { positions, triangles } = scene;
  if (!triangles) {
    for (let v = 0; v < vertexCount(scene); ++v) if (isFinitePoint(positions, v)) visit(v);
    return;
  }
  for (let i = 0; i < triangles.length; i += 3) {
    const a = triangles[i]!, b = triangles[i + 1]!, c = triangles[i + 2]!;
    if (!isFinitePoint(positions, a) || !isFinitePoint(positions, b) || !isFinitePoint(positions, c)) continue;
    visit(a), visit(b), visit(c);
  }
}

export function frameOf(scene: Scene): Frame {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const { positions } = scene;
  forDrawn(scene, (v) => {
    for (let axis = 0; axis < 3; ++axis) {
      const x = positions[3 * v + axis]!;
      if (x < low[axis]!) low[axis] = x;
      if (x > high[axis]!) high[axis] = x;
    }
  });
  if (low[0]! > high[0]!) throw new Error(`${scene.name}: nothing to draw, no ${scene.triangles ? "face" : "point"} is finite`);
  const centre = [0, 1, 2].map((a) => scene.origin[a]! + (low[a]! + high[a]!) / 2) as Triple;
  const radius = Math.hypot(high[0]! - low[0]!, high[1]! - low[1]!, high[2]! - low[2]!) / 2;
  return { centre, radius: radius > 0 ? radius : 1 };
}

/** One frame for both where they nearly agree, so that a linked camera looks at the same place of both. */
export function sharedFrames(frames: Frame[]): Frame[] {
  const [a, b] = frames;
  if (!a || !b) return frames;
  const apart = Math.hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1], a.centre[2] - b.centre[2]);
  const near = apart < 0.2 * a.radius && Math.abs(a.radius - b.radius) < 0.2 * a.radius;
  return near ? [a, a] : frames;
}

/** The position of a vertex in the unit of the file. */
export function positionOf(scene: Scene, v: number): Triple {
  return [0, 1, 2].map((a) => scene.origin[a]! + scene.positions[3 * v + a]!) as Triple;
}

/** A direction from its two octahedral numbers (Cigolle et al. 2014), or null for none. */
export function octahedralNormal(normals: Int16Array, v: number): Triple | null {
  if (normals[2 * v] === -32768) return null;
  let x = normals[2 * v]! / 32767, y = normals[2 * v + 1]! / 32767;
  const z = 1 - Math.abs(x) - Math.abs(y);
  if (z < 0) {
    const folded = (1 - Math.abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - Math.abs(x)) * (y < 0 ? -1 : 1);
    x = folded;
  }
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

/** The other way; vectors of no length become none. For scenes made in the browser. */
export function octahedral(vectors: ArrayLike<number>): Int16Array {
  const out = new Int16Array((vectors.length / 3) * 2);
  for (let v = 0; 3 * v < vectors.length; ++v) {
    const x = vectors[3 * v]!, y = vectors[3 * v + 1]!, z = vectors[3 * v + 2]!;
    const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
    if (!(sum > 0 && sum < Infinity)) {
      out[2 * v] = out[2 * v + 1] = -32768;
      continue;
    }
    const fold = z < 0;
    out[2 * v] = Math.round(32767 * (fold ? (1 - Math.abs(y) / sum) * (x < 0 ? -1 : 1) : x / sum));
    out[2 * v + 1] = Math.round(32767 * (fold ? (1 - Math.abs(x) / sum) * (y < 0 ? -1 : 1) : y / sum));
  }
  return out;
}
