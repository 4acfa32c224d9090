// The picture: one canvas, a pane for each scene, cameras that may be linked, drawn when something changed.
import * as THREE from "three";
import { mapBytes, mapSize, type MapName } from "./colormaps";
import { Drawing, type Look } from "./drawing";
import { pick, type Hit } from "./picking";
import { type Axes, type Pose, anglesOf, axesOf, fieldOfView, fittingDistance, place } from "./pose";
import { frameOf, type Scene, sharedFrames } from "./scene";

export interface Pane {
  drawing: Drawing;
  pose: Pose;
}
export interface Picked extends Hit {
  pane: number;
}

export class Stage {
  readonly panes: Pane[];
  readonly axes: Axes;
  linked = true;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera = new THREE.PerspectiveCamera(fieldOfView);
  private readonly look: Look;
  private readonly marker: THREE.Points;
  private marked: Picked | null = null;
  private waiting = false;
  private size = "";
  private movingUntil = 0;
  private lastFrame = 0;
  private budget = 4_000_000;
  /** Called after each picture. */
  onDrawn: () => void = () => {};

  private observer = new ResizeObserver(() => this.resize());

  constructor(readonly canvas: HTMLCanvasElement, scenes: Scene[]) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // the shaders' colours are those of the screen
    this.renderer.autoClear = false;
    const map = new THREE.DataTexture(new Uint8Array(4 * mapSize), mapSize, 1);
    map.minFilter = map.magFilter = THREE.LinearFilter;
    const grey = (c: number): THREE.Color => new THREE.Color().setRGB(c, c, c, THREE.LinearSRGBColorSpace);
    this.look = {
      map,
      undefined0: grey(0.56),
      undefined1: grey(0.66),
      line: new THREE.Vector4(0, 0, 0, 0.35),
      boundary: new THREE.Vector4(0.92, 0.16, 0.42, 1),
      hair: new THREE.Vector4(0.1, 0.45, 0.9, 0.75),
    };
    const frames = sharedFrames(scenes.map(frameOf));
    this.axes = axesOf(scenes[0]!.up);
    this.panes = scenes.map((scene, i) => ({
      drawing: new Drawing(scene, frames[i]!, this.look),
      pose: { yaw: 0, pitch: 0, distance: 4, target: [0, 0, 0] },
    }));
    this.marker = markerPoint();
    if (isSoftware(this.renderer)) {
      // Seconds for a million triangles: something to see first, the whole thereafter.
      this.budget = 150_000;
      this.movingUntil = Infinity;
    }
    this.resize();
    this.reset();
    this.observer.observe(canvas);
    canvas.addEventListener("webglcontextrestored", () => this.draw());
  }

  /** Pixels of CSS: the pane's left edge and its size. */
  paneBox(pane: number): { left: number; width: number; height: number } {
    const width = this.canvas.clientWidth / this.panes.length;
    return { left: pane * width, width, height: this.canvas.clientHeight };
  }
  paneAt(x: number): number {
    return Math.min(this.panes.length - 1, Math.max(0, Math.floor(x / this.paneBox(0).width)));
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    const size = `${clientWidth} ${clientHeight} ${window.devicePixelRatio}`;
    if (size === this.size) return; // an observer begins by telling what is known: no second picture for that
    this.size = size;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(Math.max(1, clientWidth), Math.max(1, clientHeight), false);
    this.draw();
  }

  setColours(background: string, dark: boolean): void {
    this.renderer.setClearColor(new THREE.Color().setStyle(background, THREE.LinearSRGBColorSpace), 1);
    this.look.line.set(...((dark ? [1, 1, 1, 0.28] : [0, 0, 0, 0.35]) as [number, number, number, number]));
    this.draw();
  }
  setMap(name: MapName): void {
    this.look.map.image.data!.set(mapBytes(name));
    this.look.map.needsUpdate = true;
    this.draw();
  }

  /** From there, the whole object; in all panes, or the one. */
  reset(angles = anglesOf(this.panes[0]!.drawing.scene.toward, this.axes), pane?: number): void {
    const { width, height } = this.paneBox(0), aspect = width / Math.max(1, height);
    const chosen = this.linked || pane === undefined ? this.panes : [this.panes[pane]!];
    const pose: Pose = { ...angles, distance: 4, target: [0, 0, 0] };
    pose.distance = fittingDistance(pose, this.axes, aspect, chosen.map((p) => p.drawing.placed));
    for (const p of chosen) p.pose = pose;
    this.draw();
  }
  setPose(pane: number, pose: Pose): void {
    if (this.linked) for (const p of this.panes) p.pose = pose;
    else this.panes[pane]!.pose = pose;
    this.moving();
  }
  link(linked: boolean): void {
    this.linked = linked;
    if (linked) for (const p of this.panes) p.pose = this.panes[0]!.pose;
    this.draw();
  }

  /** Give back what the browser has few of. */
  close(): void {
    this.observer.disconnect();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Until nothing moves for a while, objects too large to follow are drawn in part. */
  private moving(): void {
    this.movingUntil = performance.now() + 180;
    this.draw();
  }

  draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((now) => {
      this.waiting = false;
      const moving = now < this.movingUntil;
      if (this.movingUntil === Infinity) this.movingUntil = 0;
      if (moving) this.learn(now - this.lastFrame);
      this.lastFrame = now;
      this.render(moving ? this.budget : Infinity);
      if (moving) setTimeout(() => this.draw(), 200);
      this.onDrawn();
    });
  }

  /** Half as much while pictures come late, a little more while they come early. */
  private learn(milliseconds: number): void {
    if (milliseconds > 1000) return; // the first of a movement
    if (milliseconds > 55) this.budget = Math.max(60_000, this.budget / 1.6);
    else if (milliseconds < 22) this.budget = Math.min(20_000_000, this.budget * 1.15);
  }

  private render(budget: number): void {
    const height = this.canvas.clientHeight;
    this.renderer.setScissorTest(true);
    this.panes.forEach(({ drawing, pose }, i) => {
      const box = this.paneBox(i);
      this.renderer.setViewport(box.left, 0, box.width, box.height);
      this.renderer.setScissor(box.left, 0, box.width, box.height);
      this.renderer.clear();
      this.aim(i, pose);
      drawing.setPixels((height * this.renderer.getPixelRatio()) / (2 * Math.tan((fieldOfView * Math.PI) / 360)), pose.distance);
      drawing.setDetail(budget);
      this.renderer.render(drawing.visible, this.camera);
      if (this.marked?.pane !== i) return;
      this.marker.position.fromArray(drawing.placed, 3 * this.marked.vertex);
      this.renderer.render(this.marker, this.camera);
    });
  }

  private aim(pane: number, pose: Pose): void {
    const { width, height } = this.paneBox(pane);
    this.camera.aspect = width / Math.max(1, height);
    place(this.camera, pose, this.axes);
  }

  /** What is drawn at that place of the canvas, in pixels of CSS. */
  pick(x: number, y: number, reach = 6): Picked | null {
    const pane = this.paneAt(x), box = this.paneBox(pane), { drawing, pose } = this.panes[pane]!;
    this.aim(pane, pose);
    drawing.setDetail(Infinity);
    drawing.setPixels(box.height / (2 * Math.tan((fieldOfView * Math.PI) / 360)), pose.distance);
    const hit = pick(this.renderer, drawing, this.camera, x - box.left, y, box.width, box.height, reach);
    return hit && { ...hit, pane };
  }

  /** Where a vertex is on the canvas, in pixels of CSS. */
  placeOf(pane: number, vertex: number): { x: number; y: number } {
    const box = this.paneBox(pane), { drawing, pose } = this.panes[pane]!;
    this.aim(pane, pose);
    const p = new THREE.Vector3().fromArray(drawing.placed, 3 * vertex).project(this.camera);
    return { x: box.left + ((p.x + 1) / 2) * box.width, y: ((1 - p.y) / 2) * box.height };
  }

  mark(picked: Picked | null): void {
    if (picked?.vertex === this.marked?.vertex && picked?.pane === this.marked?.pane) return;
    this.marked = picked;
    this.draw();
  }

  /** The picture without the marker. */
  snapshot(): HTMLCanvasElement {
    const marked = this.marked;
    this.marked = null;
    this.render(Infinity);
    this.marked = marked;
    this.draw();
    return this.canvas;
  }
}

function isSoftware(renderer: THREE.WebGLRenderer): boolean {
  const gl = renderer.getContext(), known = gl.getExtension("WEBGL_debug_renderer_info");
  return known !== null && /swiftshader|llvmpipe|software/i.test(String(gl.getParameter(known.UNMASKED_RENDERER_WEBGL)));
}

/** A ring around a vertex, over everything. */
function markerPoint(): THREE.Points {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3), 3));
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: `precision highp float; uniform mat4 modelViewMatrix, projectionMatrix; in vec3 position;
void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_PointSize = 18.0; }`,
    fragmentShader: `precision highp float; out vec4 color;
void main() {
  float r = length(2.0 * gl_PointCoord - 1.0);
  if (r > 1.0 || r < 0.42) discard;
  color = r > 0.84 || r < 0.56 ? vec4(0.0, 0.0, 0.0, 0.8) : vec4(1.0);
}`,
    transparent: true,
    depthTest: false,
  });
  const points = new THREE.Points(geometry, material);
  points.frustumCulled = false;
  return points;
}
