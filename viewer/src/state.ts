// What is chosen, in the fragment of the address: a link shows what its sender saw.
import { mapNames, type MapName } from "./colormaps";
import type { Pose } from "./pose";
import type { Range } from "./range";

export interface State {
  field: string;
  /** null: as fits the field. */
  map: MapName | null;
  /** One a pane, the first for all where they are linked; null: automatic. */
  ranges: (Range | null)[];
  log: boolean;
  wire: boolean;
  hairs: boolean;
  boundary: boolean;
  size: number;
  theme: "auto" | "dark" | "light";
  linkCameras: boolean;
  linkRanges: boolean;
  panel: boolean;
  /** One a pane; null: as it begins. */
  poses: Pose[] | null;
}

export const initialState = (field: string): State => ({
  field, map: null, ranges: [null, null], log: false, wire: false, hairs: false, boundary: false, size: 1,
  theme: "auto", linkCameras: true, linkRanges: true, panel: true, poses: null,
});

const short = (x: number): string => String(Number(x.toPrecision(5)));

export function toFragment(state: State, first: string): string {
  const out = new URLSearchParams();
  if (state.field !== first) out.set("field", state.field);
  if (state.map) out.set("map", state.map);
  const ranges = state.linkRanges ? state.ranges.slice(0, 1) : state.ranges;
  if (ranges.some((r) => r)) out.set("range", ranges.map((r) => (r ? `${r.low},${r.high}` : "")).join(";"));
  for (const flag of ["log", "wire", "hairs", "boundary"] as const) if (state[flag]) out.set(flag, "1");
  if (state.size !== 1) out.set("size", short(state.size));
  if (state.theme !== "auto") out.set("theme", state.theme);
  for (const flag of ["linkCameras", "linkRanges", "panel"] as const) if (!state[flag]) out.set(flag, "0");
  if (state.poses) out.set("view", state.poses.map((p) => [p.yaw, p.pitch, p.distance, ...p.target].map(short).join(",")).join(";"));
  return out.toString().replaceAll("%2C", ",").replaceAll("%3B", ";");
}

/** What of it makes sense; the rest stays as it was. */
export function fromFragment(fragment: string, before: State): State {
  const given = new URLSearchParams(fragment.replace(/^#/, "")), state = { ...before, ranges: [...before.ranges] };
  const numbers = (text: string | null, count: number): number[] | null => {
    const found = (text ?? "").split(",").map(Number);
    return text && found.length === count && found.every(Number.isFinite) ? found : null;
  };
  state.field = given.get("field") ?? state.field;
  const map = given.get("map");
  if (mapNames.includes(map as MapName)) state.map = map as MapName;
  (given.get("range") ?? "").split(";").slice(0, 2).forEach((text, pane) => {
    const range = numbers(text, 2);
    if (range && range[0]! < range[1]!) state.ranges[pane] = { low: range[0]!, high: range[1]! };
  });
  for (const flag of ["log", "wire", "hairs", "boundary"] as const) if (given.get(flag) === "1") state[flag] = true;
  const size = numbers(given.get("size"), 1);
  if (size && size[0]! > 0) state.size = Math.min(5, Math.max(0.2, size[0]!));
  const theme = given.get("theme");
  if (theme === "dark" || theme === "light") state.theme = theme;
  for (const flag of ["linkCameras", "linkRanges", "panel"] as const) if (given.get(flag) === "0") state[flag] = false;
  const poses = (given.get("view") ?? "").split(";").map((text) => numbers(text, 6));
  if (poses.length && poses.every((p) => p !== null && p[2]! > 0))
    state.poses = poses.map((p) => ({ yaw: p![0]!, pitch: p![1]!, distance: p![2]!, target: [p![3]!, p![4]!, p![5]!] }));
  return state;
}
