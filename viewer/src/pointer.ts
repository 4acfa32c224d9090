// Mouse, pen, touch and keys on the canvas.
import { type Pose, moved, turned, zoomed } from "./pose";
import type { Stage } from "./stage";

export interface PointerEvents {
  /** The pointer rests or taps there (canvas pixels), or has left (null). */
  hover(at: { x: number; y: number } | null, tapped: boolean): void;
  changed(): void;
}

/**
 * One finger or the left button turns, two fingers or another button (or Shift) move, the wheel and two fingers zoom,
 * a double click looks at what is there.
 */
export function listen(stage: Stage, events: PointerEvents): void {
  const { canvas } = stage;
  const down = new Map<number, { x: number; y: number }>();
  let pane = 0, travelled = 0, moving = false;
  const at = (e: MouseEvent): { x: number; y: number } => {
    const box = canvas.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  };
  const change = (pose: Pose): void => {
    stage.setPose(pane, pose);
    events.changed();
  };
  const pose = (): Pose => stage.panes[pane]!.pose;

  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("pointerdown", (e) => {
    if (down.size === 0) travelled = 0, (pane = stage.paneAt(at(e).x)), (moving = e.button !== 0 || e.shiftKey || e.ctrlKey);
    down.set(e.pointerId, at(e));
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("pointermove", (e) => {
    const before = down.get(e.pointerId), now = at(e);
    if (!before) return events.hover(now, false);
    const height = canvas.clientHeight, dx = now.x - before.x, dy = now.y - before.y;
    travelled += Math.abs(dx) + Math.abs(dy);
    if (travelled > 4) events.hover(null, false);
    if (down.size === 2) {
      const other = [...down.entries()].find(([id]) => id !== e.pointerId)![1];
      const apart = (p: { x: number; y: number }): number => Math.hypot(p.x - other.x, p.y - other.y) || 1;
      change(zoomed(moved(pose(), stage.axes, dx / 2 / height, -dy / 2 / height), apart(before) / apart(now)));
    } else if (down.size === 1) {
      if (moving) change(moved(pose(), stage.axes, dx / height, -dy / height));
      else change(turned(pose(), (-dx / height) * 3.5, (dy / height) * 3.5));
    }
    down.set(e.pointerId, now);
  });
  const up = (e: PointerEvent): void => {
    if (!down.delete(e.pointerId)) return;
    if (e.type === "pointerup" && travelled <= 4 && down.size === 0) events.hover(at(e), true);
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => events.hover(null, false));
  canvas.addEventListener(
    "wheel",
    (e) => {
      e.preventDefault();
      const place = at(e), factor = Math.exp(Math.max(-0.5, Math.min(0.5, e.deltaY * (e.deltaMode === 1 ? 0.05 : 0.0015))));
      pane = stage.paneAt(place.x);
      const box = stage.paneBox(pane);
      // What is under the pointer stays there.
      const right = (place.x - box.left - box.width / 2) / box.height, above = 0.5 - place.y / box.height;
      const held = moved(pose(), stage.axes, -right, -above);
      const near = zoomed(held, factor);
      change(moved(near, stage.axes, right, above));
    },
    { passive: false },
  );
  canvas.addEventListener("dblclick", (e) => {
    const place = at(e), hit = stage.pick(place.x, place.y);
    if (!hit) return;
    pane = hit.pane;
    const placed = stage.panes[pane]!.drawing.placed;
    change({ ...pose(), target: [0, 1, 2].map((a) => placed[3 * hit.vertex + a]!) as Pose["target"] });
  });
  canvas.addEventListener("keydown", (e) => {
    if (e.altKey || e.metaKey || e.ctrlKey) return;
    const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const arrow = arrows[e.key];
    if (arrow && e.shiftKey) change(moved(pose(), stage.axes, 0.05 * arrow[0], 0.05 * arrow[1]));
    else if (arrow) change(turned(pose(), 0.12 * arrow[0], 0.12 * arrow[1]));
    else if (e.key === "+" || e.key === "=") change(zoomed(pose(), 0.87));
    else if (e.key === "-") change(zoomed(pose(), 1.15));
    else return;
    e.preventDefault();
  });
}
