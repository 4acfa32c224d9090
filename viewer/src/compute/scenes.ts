// What the worker computed, as scenes of the viewer.
import { type Field, octahedral, type Scene } from "../scene";
import type { SceneArrays } from "./messages";

function fieldOf(field: SceneArrays["fields"][number], diagonal: number, faces: number): Field {
  const { name, ofFaces, values } = field;
  // Rounding noise of a plane, as the program draws it: 1e-9 / diagonal², and its integral over one of the faces.
  return ofFaces
    ? { name, label: "kappa of the face", unit: "", ofFaces, diverging: false, noise: 1e-9 / Math.max(1, faces), values }
    : { name, label: "total curvature k1² + k2²", unit: "1/unit²", ofFaces, diverging: false, noise: 1e-9 / diagonal ** 2, values };
}

export function sceneOf(name: string, arrays: SceneArrays): Scene {
  const { positions, toward, up } = arrays;
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    const x = positions[i]!;
    if (!Number.isFinite(x)) continue;
    low[i % 3] = Math.min(low[i % 3]!, x);
    high[i % 3] = Math.max(high[i % 3]!, x);
  }
  const diagonal = Math.hypot(high[0]! - low[0]!, high[1]! - low[1]!, high[2]! - low[2]!) || 1;
  return {
    name,
    origin: [0, 0, 0],
    positions,
    triangles: arrays.triangles.length ? arrays.triangles : null,
    normals: arrays.normals.length ? octahedral(arrays.normals) : null,
    spacing: 0,
    toward,
    up,
    fields: arrays.fields.map((f) => fieldOf(f, diagonal, arrays.triangles.length / 3)),
  };
}
