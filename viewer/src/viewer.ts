// The viewer: a picture and its controls over one or two scenes. Another page of ours may hand it scenes it computed.
import type { MapName } from "./colormaps";
import { type Choice, choicesOf } from "./fields";
import { Histogram } from "./histogram";
import { layout } from "./layout";
import { drawLegend, type LegendData, showLegend } from "./legend";
import { counted, shortNumber } from "./numbers";
import type { PageData } from "./payload";
import { listen } from "./pointer";
import type { Triple } from "./scene";
import { anglesOf } from "./pose";
import { automaticRange, type Range, statisticsOf, unionOf, valueAt } from "./range";
import { type Field, faceCount, vertexCount } from "./scene";
import { Stage, type Picked } from "./stage";
import { fromFragment, initialState, type State, toFragment } from "./state";
import { showTip, tipOf } from "./tip";

export interface Viewer {
  readonly stage: Stage;
  readonly state: State;
  /** Leave the page to another viewer. */
  close(): void;
}

const presets: Record<string, [number, number, number]> = {
  front: [1, 0, 0], back: [-1, 0, 0], left: [0, -1, 0], right: [0, 1, 0], top: [0.001, 0, 1], bottom: [0.001, 0, -1],
};

export function showPage(root: HTMLElement, data: PageData): Viewer {
  const { scenes } = data;
  const shown = new AbortController();
  root.innerHTML = layout;
  const find = <T extends HTMLElement>(selector: string): T => root.querySelector<T>(selector)!;
  const canvas = find<HTMLCanvasElement>("canvas.picture"), panel = find<HTMLFormElement>(".panel");
  const input = (name: string): HTMLInputElement => panel.elements.namedItem(name) as HTMLInputElement;
  document.title = data.title;
  find("h1").textContent = data.title;

  const choices = choicesOf(scenes);
  const first = choices.find((c) => c.key === data.field || c.key === `${data.field}:face`) ?? choices[0];
  if (!first) throw new Error("there are no values to show");
  const state = fromFragment(location.hash, initialState(first.key));
  const choice = (): Choice => choices.find((c) => c.key === state.field) ?? first;
  find<HTMLSelectElement>("[name=field]").replaceChildren(...choices.map((c) => new Option(c.label, c.key)));

  const stage = new Stage(canvas, scenes);
  const fields = (): Field[] => choice().fields.filter((f): f is Field => f !== null && f !== "normals");
  const mapOf = (): MapName => state.map ?? (fields().some((f) => f.diverging) ? "coolwarm" : "viridis");
  const logarithmic = (): boolean => state.log && fields().length > 0 && fields().every((f) => statisticsOf(f).least >= 0 && statisticsOf(f).most > 0);
  let active = 0, hovered: Picked | null = null;

  /** The range that is shown in a pane. */
  function rangeOf(pane: number): Range {
    const linked = state.linkRanges || scenes.length === 1;
    const chosen = state.ranges[linked ? 0 : pane];
    const log = logarithmic();
    if (chosen && (!log || chosen.low > 0)) return chosen;
    const automatic = (p: number): Range[] => {
      const field = choice().fields[p];
      return field && field !== "normals" ? [automaticRange(field, stage.panes[p]!.drawing.frame.radius, log)] : [];
    };
    if (!linked) return automatic(pane)[0] ?? { low: 0, high: 1 };
    if (!chosen && state.field === first!.key && data.low !== null && data.high !== null && (!log || data.low > 0)) return { low: data.low, high: data.high };
    const all = scenes.flatMap((_, p) => automatic(p));
    const range = all.length ? unionOf(all) : { low: 0, high: 1 };
    return chosen ? { low: range.low, high: Math.max(chosen.high, range.low * 1.01) } : range;
  }
  /** What the colour map is spread over: about 0 where it has a middle. */
  function spreadOf(pane: number): Range {
    const range = rangeOf(pane);
    if (mapOf() !== "coolwarm" || !fields().some((f) => f.diverging)) return range;
    const reach = Math.max(Math.abs(range.low), Math.abs(range.high));
    return { low: -reach, high: reach };
  }

  function legendOf(pane: number, together: boolean): LegendData | null {
    const shown = together ? fields() : choice().fields.slice(pane, pane + 1).filter((f): f is Field => f !== null && f !== "normals");
    const field = shown[0];
    if (!field) return null;
    const range = spreadOf(pane), log = logarithmic(), slack = 1e-6 * (range.high - range.low);
    const all = shown.map(statisticsOf);
    return {
      label: field.label, unit: field.unit, range, logarithmic: log, map: mapOf(), of: field.ofFaces ? "face" : scenes[pane]!.triangles ? "vertex" : "point",
      below: all.some((s) => s.least < range.low - slack), above: all.some((s) => s.most > range.high + slack),
      undefined: all.reduce((sum, s) => sum + s.undefined, 0),
    };
  }

  /** Everything but the values on the GPU: fast enough for each step of a drag. */
  function recolour(): void {
    const log = logarithmic();
    stage.panes.forEach(({ drawing }, pane) => {
      const { low, high } = spreadOf(pane);
      drawing.setRange(low, high, log);
    });
    stage.setMap(mapOf());
    const together = state.linkRanges || scenes.length === 1;
    if (together) active = 0;
    const range = rangeOf(active), shown = together ? fields() : choice().fields.slice(active, active + 1).filter((f): f is Field => f !== null && f !== "normals");
    find(".ranges").hidden = shown.length === 0;
    if (shown.length > 0) histogram.show({ statistics: shown.map(statisticsOf), range, logarithmic: log, map: mapOf() });
    for (const end of ["low", "high"] as const) if (document.activeElement !== input(end)) input(end).value = shortNumber(range[end]);
    const legends = find(".legends");
    const count = together ? 1 : scenes.length;
    while (legends.children.length < count) legends.append(Object.assign(document.createElement("div"), { className: "legend" }));
    while (legends.children.length > count) legends.lastChild!.remove();
    [...legends.children].forEach((element, pane) => {
      (element as HTMLElement).style.left = `${(100 * pane) / count}%`;
      showLegend(element as HTMLElement, legendOf(pane, together), choice().fields.includes("normals") ? "direction of the normal" : "no such value");
    });
    remember();
  }

  /** Another field: its values go to the GPU. */
  function revalue(): void {
    choice().fields.forEach((field, pane) => stage.panes[pane]!.drawing.setField(field));
    input("log").disabled = fields().length === 0 || fields().some((f) => statisticsOf(f).least < 0);
    find<HTMLSelectElement>("[name=field]").value = choice().key;
    find<HTMLSelectElement>("[name=map]").value = mapOf();
    showFacts();
    recolour();
    const title = choice().label;
    canvas.setAttribute("aria-label", `${scenes.map((s) => s.name).join(" and ")}, coloured by ${title}. Arrow keys turn, plus and minus zoom.`);
  }

  function showFacts(): void {
    find(".facts").replaceChildren(
      ...scenes.map((scene, pane) => {
        const field = choice().fields[pane], list = document.createElement("dl");
        const row = (name: string, text: string): void => {
          list.append(Object.assign(document.createElement("dt"), { textContent: name }), Object.assign(document.createElement("dd"), { textContent: text }));
        };
        if (scenes.length > 1) row(pane === 0 ? "left" : "right", scene.name);
        row("size", scene.triangles ? `${counted(vertexCount(scene), "vertex", "vertices")}, ${counted(faceCount(scene), "face")}` : counted(vertexCount(scene), "point"));
        if (state.boundary && scene.triangles) row("boundary", counted(stage.panes[pane]!.drawing.boundaryEdges, "edge"));
        if (field && field !== "normals") {
          const { sorted, least, most, undefined: count } = statisticsOf(field);
          if (sorted.length) row("min · median · max", [least, valueAt(sorted, 0.5), most].map(shortNumber).join(" · "));
          row("undefined", count.toLocaleString("en-US"));
        }
        return list;
      }),
    );
  }

  function showParts(): void {
    for (const flag of ["log", "wire", "hairs", "boundary", "linkCameras", "linkRanges"] as const) input(flag).checked = state[flag];
    input("size").value = String(Math.log2(state.size));
    for (const { drawing } of stage.panes) {
      drawing.showEdges(state.wire, state.boundary);
      drawing.showHairs(state.hairs);
      drawing.setPointSize(state.size);
    }
    find(".which").hidden = state.linkRanges || scenes.length === 1;
    root.classList.toggle("bare", !state.panel);
    find(".toggle").setAttribute("aria-expanded", String(state.panel));
    stage.draw();
    remember();
  }

  const prefersDark = matchMedia("(prefers-color-scheme: dark)");
  const isDark = (): boolean => (state.theme === "auto" ? prefersDark.matches : state.theme === "dark");
  function showTheme(): void {
    document.documentElement.dataset["theme"] = isDark() ? "dark" : "light";
    stage.setColours(getComputedStyle(document.documentElement).getPropertyValue("--paper").trim(), isDark());
    recolour();
  }
  prefersDark.addEventListener("change", showTheme, { signal: shown.signal });

  let remembering = 0;
  function remember(): void {
    clearTimeout(remembering);
    remembering = window.setTimeout(() => {
      const fragment = toFragment(state, first!.key);
      history.replaceState(null, "", fragment ? `#${fragment}` : location.pathname + location.search);
    }, 150);
  }

  function hover(at: { x: number; y: number } | null, tapped: boolean): void {
    hovered = at && stage.pick(at.x, at.y, tapped ? 14 : 6);
    stage.mark(hovered);
    const tip = find(".tip");
    if (!hovered) return showTip(tip, null, 0, 0, canvas.getBoundingClientRect());
    const { drawing } = stage.panes[hovered.pane]!;
    const words = tipOf(drawing.scene, drawing.frame, choice().fields[hovered.pane]!, hovered);
    showTip(tip, words, at!.x, at!.y, { width: canvas.clientWidth, height: canvas.clientHeight });
    tip.dataset["vertex"] = String(hovered.vertex);
    tip.dataset["face"] = String(hovered.face);
    if (tapped) find(".stage > [role=status]").textContent = [words.title, ...words.lines].join(", ");
  }

  function look(name: string): void {
    const { axes } = stage, preset = presets[name];
    const toward = preset && ([0, 1, 2].map((i) => axes.front.getComponent(i) * preset[0] + axes.side.getComponent(i) * preset[1] + axes.up.getComponent(i) * preset[2]) as Triple);
    stage.reset(toward && anglesOf(toward, axes));
    state.poses = name === "reset" ? null : stage.panes.map((p) => p.pose);
    remember();
  }

  function screenshot(): void {
    const picture = stage.snapshot(), out = document.createElement("canvas");
    out.width = picture.width, (out.height = picture.height);
    const g = out.getContext("2d")!, scale = picture.width / canvas.clientWidth;
    g.drawImage(picture, 0, 0);
    const together = state.linkRanges || scenes.length === 1, ink = isDark() ? "#e8eaed" : "#1c2024";
    scenes.forEach((scene, pane) => {
      g.save();
      g.translate((pane * picture.width) / scenes.length, 0);
      g.fillStyle = ink;
      g.font = `${14 * scale}px system-ui, sans-serif`;
      g.fillText(scene.name, 20 * scale, 30 * scale);
      const legend = legendOf(pane, together);
      if (legend && (pane === 0 || !together)) drawLegend(g, legend, picture.height, scale, ink);
      g.restore();
    });
    out.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob!);
      link.download = `${scenes[0]!.name.replace(/\.\w+$/, "")}-${choice().key.replace(":", "-")}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }

  const actions: Record<string, () => void> = {
    auto: () => ((state.ranges = [null, null]), recolour()),
    screenshot,
    theme: () => ((state.theme = isDark() ? "light" : "dark"), showTheme()),
    help: () => find<HTMLDialogElement>(".help").showModal(),
    close: () => find<HTMLDialogElement>(".help").close(),
    panel: () => ((state.panel = !state.panel), showParts()),
  };
  const flip = (flag: "log" | "wire" | "hairs" | "boundary"): void => {
    if (!input(flag).disabled) input(flag).click();
  };
  const nextField = (): void => {
    const at = choices.indexOf(choice());
    choose(choices[(at + 1) % choices.length]!.key);
  };
  function choose(key: string): void {
    state.field = key;
    state.ranges = [null, null];
    state.map = null;
    revalue();
  }
  const keys: Record<string, () => void> = {
    f: nextField, a: actions["auto"]!, l: () => flip("log"), w: () => flip("wire"), n: () => flip("hairs"), b: () => flip("boundary"),
    r: () => look("reset"), s: screenshot, t: actions["theme"]!, h: actions["panel"]!, "?": actions["help"]!,
    ...Object.fromEntries(Object.keys(presets).map((name, i) => [String(i + 1), () => look(name)])),
  };
  document.addEventListener("keydown", (e) => {
    const typing = e.target instanceof HTMLSelectElement || (e.target instanceof HTMLInputElement && e.target.inputMode === "decimal");
    if (e.altKey || e.metaKey || e.ctrlKey || typing) return;
    keys[e.key.toLowerCase()]?.();
  }, { signal: shown.signal });
  root.addEventListener("click", (e) => {
    const button = (e.target as HTMLElement).closest<HTMLElement>("button");
    if (button?.dataset["do"]) actions[button.dataset["do"]]!();
    if (button?.dataset["view"]) look(button.dataset["view"]);
  }, { signal: shown.signal });
  panel.addEventListener("submit", (e) => e.preventDefault());
  panel.addEventListener("input", (e) => {
    const { name, value } = e.target as HTMLInputElement;
    if (name === "size") (state.size = 2 ** Number(value)), showParts();
  }, { signal: shown.signal });
  panel.addEventListener("change", (e) => {
    const target = e.target as HTMLInputElement, { name, value, checked } = target;
    if (name === "field") choose(value);
    else if (name === "map") (state.map = value as MapName), recolour();
    else if (name === "log") (state.log = checked), (state.ranges = [null, null]), recolour();
    else if (name === "pane") (active = Number(value)), recolour();
    else if (name === "low" || name === "high") typed(name, value);
    else if (name === "linkCameras") (state.linkCameras = checked), stage.link(checked), showParts();
    else if (name === "linkRanges") (state.linkRanges = checked), showParts(), recolour();
    else if (name === "wire" || name === "hairs" || name === "boundary") (state[name] = checked), showParts(), showFacts();
  }, { signal: shown.signal });
  function typed(end: "low" | "high", text: string): void {
    const range = { ...rangeOf(active), [end]: Number(text) };
    if (text.trim() && Number.isFinite(range[end]) && range.low < range.high) state.ranges[active] = range;
    recolour();
    input(end).value = shortNumber(rangeOf(active)[end]);
  }

  const histogram = new Histogram(find(".values"), (range) => {
    state.ranges[active] = range;
    recolour();
  });
  find(".names").replaceChildren(
    ...scenes.map((scene) => Object.assign(document.createElement("span"), { textContent: scene.name })),
  );
  find(".links").hidden = find(".names").hidden = scenes.length === 1;
  find(".size").hidden = scenes.every((s) => s.triangles);
  for (const flag of ["wire", "boundary"]) input(flag).closest("label")!.hidden = scenes.every((s) => !s.triangles);
  input("hairs").closest("label")!.hidden = scenes.every((s) => !s.normals);

  let waiting = 0;
  listen(stage, {
    hover(at, tapped) {
      cancelAnimationFrame(waiting);
      if (tapped || !at) hover(at, tapped);
      else waiting = requestAnimationFrame(() => hover(at, false));
    },
    changed() {
      state.poses = stage.panes.map((p) => p.pose);
      remember();
    },
  });
  if (state.poses) {
    stage.link(state.linkCameras);
    state.poses.slice(0, scenes.length).forEach((pose, pane) => stage.setPose(pane, pose));
  } else stage.link(state.linkCameras);
  revalue();
  showParts();
  showTheme();
  root.dataset["ready"] = "true";
  return {
    stage,
    state,
    close() {
      shown.abort();
      clearTimeout(remembering);
      stage.close();
    },
  };
}
