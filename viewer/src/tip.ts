// What is under the pointer, in words.
import { exactDigits, grouped } from "./numbers";
import { type Field, type Frame, octahedralNormal, positionOf, type Scene } from "./scene";
import type { Hit } from "./picking";

export interface Tip {
  /** The number as the file holds it. */
  value: string;
  title: string;
  lines: string[];
}

/** Coordinates that were stored as differences are good to 6e-8 of the size; more digits would be made up. */
function coordinate(scene: Scene, frame: Frame, value: number): string {
  const exact = scene.origin.every((c) => c === 0);
  if (exact) return exactDigits(value, scene.positions instanceof Float32Array);
  const decimals = Math.min(15, Math.max(0, 6 - Math.floor(Math.log10(frame.radius))));
  return String(Number(value.toFixed(decimals)));
}

export function tipOf(scene: Scene, frame: Frame, field: Field | "normals" | null, hit: Hit): Tip {
  const at = positionOf(scene, hit.vertex).map((c) => coordinate(scene, frame, c));
  const where = [`(${at.join(", ")})`];
  const vertex = `${hit.face < 0 ? "point" : "vertex"} ${grouped(hit.vertex)}`;
  if (field === "normals") {
    const n = scene.normals && octahedralNormal(scene.normals, hit.vertex);
    return { value: "", title: n ? `normal (${n.map((c) => c.toFixed(3)).join(", ")})` : "no normal", lines: [vertex, ...where] };
  }
  if (!field) return { value: "", title: "no such value here", lines: [vertex, ...where] };
  const number = field.values[field.ofFaces ? hit.face : hit.vertex]!;
  const value = exactDigits(number, field.values instanceof Float32Array);
  const unit = field.unit && Number.isFinite(number) ? ` ${field.unit}` : "";
  const lines = field.ofFaces ? [`face ${grouped(hit.face)}`, `nearest ${vertex}`] : [vertex];
  return { value, title: `${field.name} ${value}${unit}`, lines: [...lines, ...where] };
}

export function showTip(root: HTMLElement, tip: Tip | null, x: number, y: number, bounds: { width: number; height: number }): void {
  root.hidden = !tip;
  if (!tip) return;
  root.dataset["value"] = tip.value;
  root.replaceChildren(
    ...[tip.title, ...tip.lines].map((text, i) => {
      const line = document.createElement(i === 0 ? "b" : "span");
      line.textContent = text;
      return line;
    }),
  );
  const { offsetWidth, offsetHeight } = root;
  root.style.left = `${Math.max(4, x + 18 + offsetWidth > bounds.width ? x - offsetWidth - 14 : x + 18)}px`;
  root.style.top = `${Math.max(4, y + 18 + offsetHeight > bounds.height ? y - offsetHeight - 14 : y + 18)}px`;
}

