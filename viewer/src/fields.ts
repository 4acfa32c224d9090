// Which values can be chosen, over all scenes.
import type { Field, Scene } from "./scene";

export interface Choice {
  /** As in the address: the name, with ":face" for values of faces. */
  key: string;
  label: string;
  /** The field of each scene, or null where it has none; "normals" for colours of directions. */
  fields: (Field | "normals" | null)[];
}

export const keyOf = (field: Field): string => (field.ofFaces ? `${field.name}:face` : field.name);

export function choicesOf(scenes: Scene[]): Choice[] {
  const keys = new Map<string, string>();
  for (const scene of scenes)
    for (const field of scene.fields) keys.set(keyOf(field), field.ofFaces ? `${field.name} (faces)` : field.name);
  const choices: Choice[] = [...keys].map(([key, label]) => ({
    key,
    label,
    fields: scenes.map((scene) => scene.fields.find((f) => keyOf(f) === key) ?? null),
  }));
  if (scenes.some((s) => s.normals))
    choices.push({ key: "normals", label: "normals as colours", fields: scenes.map((s) => (s.normals ? "normals" : null)) });
  return choices;
}
