// What lies under a pixel: its index is drawn into a few pixels and read back, the face is then found by its corners.
import * as THREE from "three";
import type { Drawing } from "./drawing";
import { isFinitePoint } from "./scene";

export interface Hit {
  vertex: number;
  /** −1 on a cloud. */
  face: number;
}

const targets = new Map<number, THREE.WebGLRenderTarget>();
function targetOf(size: number): THREE.WebGLRenderTarget {
  const found = targets.get(size);
  if (found) return found;
  const made = new THREE.WebGLRenderTarget(size, size, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
  targets.set(size, made);
  return made;
}

/**
 * \param x y  of the pane, in its pixels from the upper left; width and height are the pane's.
 * \param reach  pixels around in which the nearest point of a cloud is taken.
 */
export function pick(
  renderer: THREE.WebGLRenderer, drawing: Drawing, camera: THREE.PerspectiveCamera,
  x: number, y: number, width: number, height: number, reach: number,
): Hit | null {
  // A point is drawn only where its middle is inside, so those around are needed too.
  const around = drawing.isCloud ? Math.max(reach, drawing.largestPoint(camera.position.length())) : 0, size = 2 * around + 1;
  const target = targetOf(size);
  const eye = camera.clone();
  eye.setViewOffset(width, height, Math.floor(x) - around, Math.floor(y) - around, size, size);
  const clear = renderer.getClearColor(new THREE.Color()), alpha = renderer.getClearAlpha();
  renderer.setRenderTarget(target);
  renderer.setScissorTest(false);
  renderer.setClearColor(0, 0);
  renderer.clear();
  renderer.render(drawing.pickable, eye);
  const side = 2 * Math.min(reach, around) + 1, corner = around - (side - 1) / 2;
  const bytes = new Uint8Array(4 * side * side);
  renderer.readRenderTargetPixels(target, corner, corner, side, side, bytes);
  renderer.setRenderTarget(null);
  renderer.setClearColor(clear, alpha);

  let best = -1, nearest = Infinity;
  for (let i = 0; i < side * side; ++i) {
    const id = bytes[4 * i]! + bytes[4 * i + 1]! * 256 + bytes[4 * i + 2]! * 65536 + bytes[4 * i + 3]! * 16777216;
    if (id === 0) continue;
    const far = Math.hypot((i % side) - (side - 1) / 2, Math.floor(i / side) - (side - 1) / 2);
    if (far < nearest) (nearest = far), (best = id - 1);
  }
  if (best < 0) return null;
  if (drawing.isCloud) return { vertex: best, face: -1 };
  const at = new THREE.Vector3((2 * (Math.floor(x) + 0.5)) / width - 1, 1 - (2 * (Math.floor(y) + 0.5)) / height, 0.5);
  return faceUnder(drawing, best, camera.position, at.unproject(camera).sub(camera.position).normalize());
}

/** The face with that last corner that the ray meets first, or misses least; of its corners the one nearest to where. */
function faceUnder(drawing: Drawing, last: number, from: THREE.Vector3, along: THREE.Vector3): Hit | null {
  const triangles = drawing.scene.triangles!, placed = drawing.placed;
  const corner = (v: number): THREE.Vector3 => new THREE.Vector3(placed[3 * v], placed[3 * v + 1], placed[3 * v + 2]);
  let best: Hit | null = null, least = Infinity, depth = Infinity;
  for (let f = 0; f < drawing.faces; ++f) {
    if (triangles[3 * f + 2] !== last) continue;
    const ids = [triangles[3 * f]!, triangles[3 * f + 1]!, last] as const;
    if (!ids.every((v) => isFinitePoint(drawing.scene.positions, v))) continue;
    const [a, b, c] = ids.map(corner) as [THREE.Vector3, THREE.Vector3, THREE.Vector3];
    const u = b.clone().sub(a), v = c.clone().sub(a), p = along.clone().cross(v), determinant = u.dot(p);
    if (determinant === 0) continue;
    // Möller and Trumbore 1997.
    const t = from.clone().sub(a), q = t.clone().cross(u);
    const beta = t.dot(p) / determinant, gamma = along.dot(q) / determinant, far = v.dot(q) / determinant;
    const outside = Math.max(0, -beta, -gamma, beta + gamma - 1);
    if (outside > least + 1e-9 || (outside >= least - 1e-9 && far >= depth)) continue;
    least = outside, (depth = far);
    const where = from.clone().addScaledVector(along, far);
    const distances = [a, b, c].map((k) => k.distanceToSquared(where));
    best = { vertex: ids[distances.indexOf(Math.min(...distances))]!, face: f };
  }
  return best;
}
