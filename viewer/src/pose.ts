// Where the eye is: turned about an upward axis around a target, in the unit of a frame (half its diagonal is 1).
import * as THREE from "three";
import type { Triple } from "./scene";

export interface Pose {
  yaw: number;
  pitch: number;
  distance: number;
  target: Triple;
}

export const fieldOfView = 30;
const steepest = 1.5533; // 89°, so that upward stays defined

/** The upward axis and the two that yaw turns from and toward. */
export interface Axes {
  up: THREE.Vector3;
  front: THREE.Vector3;
  side: THREE.Vector3;
}

/** For z up, front is −y and side is x; for y up, front is z and side is x. */
export function axesOf(up: Triple): Axes {
  const u = new THREE.Vector3(...up).normalize();
  const side = new THREE.Vector3(1, 0, 0);
  if (Math.abs(u.x) > 0.9) side.set(0, 1, 0);
  side.addScaledVector(u, -side.dot(u)).normalize();
  return { up: u, side, front: side.clone().cross(u) };
}

export function directionOf(pose: Pose, axes: Axes): THREE.Vector3 {
  const flat = Math.cos(pose.pitch);
  return new THREE.Vector3()
    .addScaledVector(axes.front, flat * Math.cos(pose.yaw))
    .addScaledVector(axes.side, flat * Math.sin(pose.yaw))
    .addScaledVector(axes.up, Math.sin(pose.pitch));
}

export function anglesOf(toward: Triple, axes: Axes): { yaw: number; pitch: number } {
  const d = new THREE.Vector3(...toward).normalize();
  const pitch = Math.asin(Math.min(1, Math.max(-1, d.dot(axes.up))));
  return { yaw: Math.atan2(d.dot(axes.side), d.dot(axes.front)), pitch: Math.min(steepest, Math.max(-steepest, pitch)) };
}

export function turned(pose: Pose, yaw: number, pitch: number): Pose {
  return { ...pose, yaw: pose.yaw + yaw, pitch: Math.min(steepest, Math.max(-steepest, pose.pitch + pitch)) };
}

export function zoomed(pose: Pose, factor: number): Pose {
  return { ...pose, distance: Math.min(50, Math.max(0.005, pose.distance * factor)) };
}

/** Across the picture by parts of its height. */
export function moved(pose: Pose, axes: Axes, right: number, up: number): Pose {
  const toward = directionOf(pose, axes), x = axes.up.clone().cross(toward).normalize(), y = toward.clone().cross(x);
  const scale = 2 * pose.distance * Math.tan((fieldOfView * Math.PI) / 360);
  const target = new THREE.Vector3(...pose.target).addScaledVector(x, -right * scale).addScaledVector(y, -up * scale);
  return { ...pose, target: target.toArray() };
}

export function place(camera: THREE.PerspectiveCamera, pose: Pose, axes: Axes): void {
  const toward = directionOf(pose, axes);
  camera.position.set(...pose.target).addScaledVector(toward, pose.distance);
  camera.up.copy(axes.up);
  camera.lookAt(...pose.target);
  const reach = camera.position.length() + 1.1;
  camera.far = reach;
  camera.near = Math.max(pose.distance / 200, camera.position.length() - 1.1);
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
}

/** The distance at which all of the points are seen, with a little room. */
export function fittingDistance(pose: Pose, axes: Axes, aspect: number, clouds: Float32Array[]): number {
  const toward = directionOf(pose, axes), x = axes.up.clone().cross(toward).normalize(), y = toward.clone().cross(x);
  const slope = Math.tan((fieldOfView * Math.PI) / 360) * 0.9;
  let distance = 0.1;
  for (const placed of clouds) {
    const step = 3 * Math.max(1, Math.floor(placed.length / 3 / 20_000));
    for (let i = 0; i < placed.length; i += step) {
      const p = [placed[i]! - pose.target[0], placed[i + 1]! - pose.target[1], placed[i + 2]! - pose.target[2]] as const;
      const at = (axis: THREE.Vector3): number => axis.x * p[0] + axis.y * p[1] + axis.z * p[2];
      distance = Math.max(distance, at(toward) + Math.abs(at(y)) / slope, at(toward) + Math.abs(at(x)) / (slope * aspect));
    }
  }
  return distance;
}
