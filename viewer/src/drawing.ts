// One scene on the GPU: its surface or points, edges, hairs, and what a click is looked up in.
import * as THREE from "three";
import { edgesOf, type Edges } from "./edges";
import { type Field, type Frame, type Scene, faceCount, isFinitePoint, vertexCount } from "./scene";
import { fragmentShader, hairVertexShader, lineFragmentShader, lineVertexShader, pickShader, undefinedValue, vertexShader } from "./shaders";

/** What all drawings share. */
export interface Look {
  map: THREE.DataTexture;
  undefined0: THREE.Color;
  undefined1: THREE.Color;
  line: THREE.Vector4;
  boundary: THREE.Vector4;
  hair: THREE.Vector4;
}

const mostHairs = 100_000;

export class Drawing {
  readonly visible = new THREE.Scene();
  readonly pickable = new THREE.Scene();
  private readonly uniforms;
  private readonly smooth: THREE.BufferGeometry;
  private flat: { geometry: THREE.BufferGeometry; last: Uint32Array } | null = null;
  private readonly solid: THREE.Mesh | THREE.Points;
  private readonly coarse: THREE.Points;
  private wire: THREE.LineSegments | null = null;
  private boundary: THREE.LineSegments | null = null;
  private hairs: THREE.LineSegments | null = null;
  private edges: Edges | null = null;
  private readonly materials: Record<"smooth" | "flat", THREE.RawShaderMaterial>;
  private readonly whole: number;
  readonly isCloud: boolean;
  /** Mean spacing of the vertices, and the radius of a point, where the frame's radius is 1. */
  readonly spacing: number;
  private readonly pointRadius: number;
  private sizeFactor = 1;
  private readonly fade = { value: 1 };

  constructor(readonly scene: Scene, readonly frame: Frame, private readonly look: Look) {
    const n = vertexCount(scene);
    this.isCloud = !scene.triangles;
    const placed = placedPositions(scene, frame);
    this.smooth = new THREE.BufferGeometry();
    this.smooth.setAttribute("position", new THREE.BufferAttribute(placed, 3));
    this.smooth.setAttribute("value", new THREE.BufferAttribute(new Float32Array(n), 1));
    const normals = scene.normals ?? new Int16Array(2 * n).fill(-32768);
    this.smooth.setAttribute("normal", new THREE.BufferAttribute(normals, 2, true));
    const index = scene.triangles ? finiteTriangles(scene) : shuffledPoints(scene);
    this.smooth.setIndex(new THREE.BufferAttribute(index, 1));
    this.smooth.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1.01);
    this.whole = index.length;

    this.spacing = this.isCloud ? (2 * scene.spacing) / frame.radius || cloudSpacing(index.length) : meshSpacing(placed, index);
    this.pointRadius = this.isCloud ? this.spacing / 2 : this.spacing;
    this.uniforms = {
      uMap: { value: look.map },
      uLow: { value: 0 },
      uHigh: { value: 1 },
      uLogarithmic: { value: 0 },
      uNormals: { value: 0 },
      uHasNormals: { value: scene.normals ? 1 : 0 },
      uUndefined0: { value: look.undefined0 },
      uUndefined1: { value: look.undefined1 },
      uPointSize: { value: 1 },
      uPixels: { value: 1 },
    };
    const material = (kind: "smooth" | "flat" | "points"): THREE.RawShaderMaterial =>
      new THREE.RawShaderMaterial({
        glslVersion: THREE.GLSL3,
        vertexShader: vertexShader(kind),
        fragmentShader: fragmentShader(kind),
        uniforms: this.uniforms,
        side: THREE.DoubleSide,
        polygonOffset: kind !== "points",
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      });
    const points = material("points");
    this.materials = { smooth: this.isCloud ? points : material("smooth"), flat: material("flat") };
    const pickMaterial = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: vertexShader(this.isCloud ? "pickPoints" : "pick"),
      fragmentShader: pickShader(this.isCloud),
      uniforms: this.uniforms,
      side: THREE.DoubleSide,
      blending: THREE.NoBlending,
    });
    const solid = (of: THREE.Material): THREE.Points | THREE.Mesh => (this.isCloud ? new THREE.Points(this.smooth, of) : new THREE.Mesh(this.smooth, of));
    this.solid = solid(this.materials.smooth);
    this.visible.add(this.solid);
    this.pickable.add(solid(pickMaterial));

    // The few points of a large object that stand for it while it moves.
    const sketch = new THREE.BufferGeometry();
    for (const name of ["position", "value", "normal"]) sketch.setAttribute(name, this.smooth.getAttribute(name)!);
    sketch.boundingSphere = this.smooth.boundingSphere;
    this.coarse = new THREE.Points(sketch, points);
    this.coarse.visible = false;
    this.visible.add(this.coarse);
  }

  /** Draw about this many vertices, or all. Less than all is for moving. */
  setDetail(budget: number): void {
    const all = this.whole <= budget * (this.isCloud ? 1 : 3);
    if (this.isCloud) {
      this.smooth.setDrawRange(0, all ? Infinity : budget);
      this.setPointScale(all ? 1 : Math.min(3, Math.sqrt(this.whole / budget)));
      return;
    }
    if (!all && !this.coarse.geometry.index) this.coarse.geometry.setIndex(new THREE.BufferAttribute(shuffledPoints(this.scene), 1));
    this.solid.visible = all;
    this.coarse.visible = !all;
    if (all) return;
    this.coarse.geometry.setDrawRange(0, budget);
    this.setPointScale(Math.max(1, Math.sqrt(vertexCount(this.scene) / budget)));
  }

  private pointScale = 1;
  private setPointScale(scale: number): void {
    this.pointScale = scale;
    this.uniforms.uPointSize.value = 2 * this.pointRadius * this.sizeFactor * scale;
  }
  setPointSize(factor: number): void {
    this.sizeFactor = factor;
    this.setPointScale(this.pointScale);
  }
  /** The pixels of a length 1 at a distance 1, and how far the eye is. */
  setPixels(pixels: number, distance: number): void {
    this.uniforms.uPixels.value = pixels;
    // Lines closer together than a few pixels would hide the colours.
    this.fade.value = Math.min(1, Math.max(0.12, (pixels * this.spacing) / distance / 9));
  }
  /** The most pixels a point has in radius, seen from that distance to the middle. */
  largestPoint(distance: number): number {
    const nearest = Math.max(0.02, distance - 1);
    return Math.min(128, Math.ceil((this.uniforms.uPointSize.value * this.uniforms.uPixels.value) / nearest / 2) + 1);
  }

  /** Colour by a field, by the normals ("normals"), or by nothing (null: undefined everywhere). */
  setField(field: Field | "normals" | null): void {
    this.uniforms.uNormals.value = field === "normals" ? 1 : 0;
    const ofFaces = field !== null && field !== "normals" && field.ofFaces;
    if (ofFaces && !this.flat) this.flat = faceGeometry(this.smooth, this.scene, this.whole);
    const geometry = ofFaces ? this.flat!.geometry : this.smooth;
    if (this.solid.geometry !== geometry) this.solid.geometry = geometry;
    this.solid.material = ofFaces ? this.materials.flat : this.materials.smooth;
    if (field === "normals") return;
    const attribute = geometry.getAttribute("value") as THREE.BufferAttribute;
    const out = attribute.array as Float32Array;
    if (ofFaces) {
      const last = this.flat!.last;
      for (let f = 0; f < last.length; ++f) out[last[f]!] = shownValue(field.values[f]!);
    } else if (field) {
      for (let v = 0; v < out.length; ++v) out[v] = shownValue(field.values[v]!);
    } else out.fill(undefinedValue);
    attribute.needsUpdate = true;
  }

  setRange(low: number, high: number, logarithmic: boolean): void {
    this.uniforms.uLow.value = low;
    this.uniforms.uHigh.value = high;
    this.uniforms.uLogarithmic.value = logarithmic ? 1 : 0;
  }

  get boundaryEdges(): number {
    return this.isCloud ? 0 : this.edgeLists().boundary.length / 2;
  }

  private edgeLists(): Edges {
    return (this.edges ??= edgesOf(this.smooth.index!.array as Uint32Array, vertexCount(this.scene)));
  }

  private lines(edges: Uint32Array, color: THREE.Vector4, nearer: number): THREE.LineSegments {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.smooth.getAttribute("position")!);
    geometry.setIndex(new THREE.BufferAttribute(edges, 1));
    geometry.boundingSphere = this.smooth.boundingSphere;
    const lines = new THREE.LineSegments(geometry, lineMaterial(lineVertexShader, color, { uNearer: { value: nearer }, uFade: nearer > 0 ? { value: 1 } : this.fade }));
    this.visible.add(lines);
    return lines;
  }

  showEdges(wire: boolean, boundary: boolean): void {
    if (this.isCloud) return;
    if (wire && !this.wire) this.wire = this.lines(this.edgeLists().all, this.look.line, 0);
    if (boundary && !this.boundary) this.boundary = this.lines(this.edgeLists().boundary, this.look.boundary, 2e-5);
    if (this.wire) this.wire.visible = wire;
    if (this.boundary) this.boundary.visible = boundary;
  }

  showHairs(shown: boolean): void {
    if (!this.scene.normals) return;
    if (shown && !this.hairs) this.visible.add((this.hairs = this.hairLines()));
    if (this.hairs) this.hairs.visible = shown;
  }

  private hairLines(): THREE.LineSegments {
    const n = vertexCount(this.scene), step = Math.ceil(n / mostHairs);
    const placed = this.smooth.getAttribute("position")!.array, normals = this.scene.normals!;
    const count = Math.ceil(n / step), roots = new Float32Array(3 * count), directions = new Int16Array(2 * count);
    for (let i = 0; i < count; ++i) {
      const v = i * step;
      roots.set(placed.subarray(3 * v, 3 * v + 3), 3 * i);
      directions.set(normals.subarray(2 * v, 2 * v + 2), 2 * i);
    }
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([0, 0, 0, 1, 0, 0]), 3));
    geometry.setAttribute("root", new THREE.InstancedBufferAttribute(roots, 3));
    geometry.setAttribute("normal", new THREE.InstancedBufferAttribute(directions, 2, true));
    geometry.instanceCount = count;
    geometry.boundingSphere = this.smooth.boundingSphere;
    const length = Math.min(0.08, Math.max(0.015, 1.2 * this.spacing * Math.sqrt(step)));
    return new THREE.LineSegments(geometry, lineMaterial(hairVertexShader, this.look.hair, { uLength: { value: length }, uFade: this.fade }));
  }

  /** Positions in the frame: its centre is 0, its radius 1. */
  get placed(): Float32Array {
    return this.smooth.getAttribute("position")!.array as Float32Array;
  }
  get faces(): number {
    return faceCount(this.scene);
  }
}

function lineMaterial(shader: string, color: THREE.Vector4, uniforms: Record<string, THREE.IUniform>): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: shader,
    fragmentShader: lineFragmentShader,
    uniforms: { uColor: { value: color }, ...uniforms },
    transparent: true,
    depthWrite: false,
  });
}

/** Centred and scaled to the frame in double precision, then rounded. */
function placedPositions({ positions, origin }: Scene, { centre, radius }: Frame): Float32Array {
  const out = new Float32Array(positions.length);
  const shift = [0, 1, 2].map((a) => origin[a]! - centre[a]!);
  for (let i = 0; i < out.length; ++i) {
    const x = (positions[i]! + shift[i % 3]!) / radius;
    out[i] = x - x === 0 ? x : 0;
  }
  return out;
}

const shownValue = (v: number): number => (v - v === 0 ? Math.min(3.3e38, Math.max(-2.9e38, v)) : undefinedValue);

/** Without the faces that have a corner that is not finite. */
function finiteTriangles({ positions, triangles }: Scene): Uint32Array {
  const n = positions.length;
  let finite = true;
  for (let i = 0; i < n && finite; ++i) finite = Number.isFinite(positions[i]!);
  if (finite) return triangles!;
  const out = new Uint32Array(triangles!.length);
  let count = 0;
  for (let i = 0; i < out.length; i += 3)
    if ([0, 1, 2].every((k) => isFinitePoint(positions, triangles![i + k]!))) {
      out.set(triangles!.subarray(i, i + 3), count);
      count += 3;
    }
  return out.slice(0, count);
}

/** The finite points in an order whose every beginning is spread over all of them. */
function shuffledPoints({ positions }: Scene): Uint32Array {
  const out = new Uint32Array(positions.length / 3);
  let count = 0;
  for (let v = 0; v < out.length; ++v) if (isFinitePoint(positions, v)) out[count++] = v;
  let state = 1;
  for (let i = count - 1; i > 0; --i) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    const j = Math.floor((state / 2 ** 32) * (i + 1)), other = out[j]!;
    out[j] = out[i]!;
    out[i] = other;
  }
  return out.slice(0, count);
}

const cloudSpacing = (points: number): number => Math.min(0.1, 3 / Math.sqrt(points));

/** The side of a square as large as the mean triangle pair; of a sample of faces. */
function meshSpacing(placed: Float32Array, triangles: Uint32Array): number {
  const faces = triangles.length / 3, step = Math.max(1, Math.floor(faces / 10_000));
  let area = 0, count = 0;
  for (let f = 0; f < faces; f += step, ++count) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * f + k]!) as [number, number, number];
    const u = [0, 1, 2].map((i) => placed[b + i]! - placed[a + i]!), w = [0, 1, 2].map((i) => placed[c + i]! - placed[a + i]!);
    area += 0.5 * Math.hypot(u[1]! * w[2]! - u[2]! * w[1]!, u[2]! * w[0]! - u[0]! * w[2]!, u[0]! * w[1]! - u[1]! * w[0]!);
  }
  return Math.sqrt((2 * area) / Math.max(1, count));
}

/**
 * The surface for values of faces: corners are turned, and vertices repeated where they must be, so that each face has a
 * last corner of its own, whose value `flat` varyings take. About as many vertices as faces, a third of what three a
 * face would need.
 */
function faceGeometry(smooth: THREE.BufferGeometry, scene: Scene, indices: number): { geometry: THREE.BufferGeometry; last: Uint32Array } {
  const triangles = scene.triangles!, n = vertexCount(scene), m = triangles.length / 3;
  const taken = new Uint8Array(n), source: number[] | Uint32Array = new Uint32Array(n + m);
  for (let v = 0; v < n; ++v) source[v] = v;
  let count = n, kept = 0;
  const index = new Uint32Array(indices), last = new Uint32Array(m);
  const placed = smooth.getAttribute("position")!.array as Float32Array;
  const drop = indices < triangles.length;
  for (let f = 0; f < m; ++f) {
    let a = triangles[3 * f]!, b = triangles[3 * f + 1]!, c = triangles[3 * f + 2]!;
    if (drop && ![a, b, c].every((v) => isFinitePoint(scene.positions, v))) continue;
    if (taken[c]) {
      if (!taken[a]) [a, b, c] = [b, c, a];
      else if (!taken[b]) [a, b, c] = [c, a, b];
    }
    if (taken[c]) {
      source[count] = c;
      c = count++;
    } else taken[c] = 1;
    last[f] = c;
    index[kept++] = a, (index[kept++] = b), (index[kept++] = c);
  }
  const positions = new Float32Array(3 * count), normals = new Int16Array(2 * count);
  const directions = smooth.getAttribute("normal")!.array as Int16Array;
  for (let v = 0; v < count; ++v) {
    const s = source[v]!;
    positions[3 * v] = placed[3 * s]!, (positions[3 * v + 1] = placed[3 * s + 1]!), (positions[3 * v + 2] = placed[3 * s + 2]!);
    normals[2 * v] = directions[2 * s]!, (normals[2 * v + 1] = directions[2 * s + 1]!);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 2, true));
  geometry.setAttribute("value", new THREE.BufferAttribute(new Float32Array(count), 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  geometry.boundingSphere = smooth.boundingSphere;
  return { geometry, last };
}
