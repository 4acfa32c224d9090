// The page that measures files in the browser: opening, measuring, decimating, saving.
import "../style.css";
import "./compute.css";
import { counted, shortNumber } from "../numbers";
import type { Scene } from "../scene";
import { showPage, type Viewer } from "../viewer";
import { Cancelled, Engine } from "./engine";
import { sceneOf } from "./scenes";

const find = <T extends HTMLElement>(selector: string): T => document.querySelector<T>(selector)!;
const app = find("#app"), summary = find(".summary"), failure = find(".failure"), download = find<HTMLButtonElement>(".download");
const decimate = find<HTMLFormElement>(".decimate"), cancel = find<HTMLButtonElement>(".cancel"), chooser = find<HTMLInputElement>("input[type=file]");
const ratio = decimate.elements.namedItem("ratio") as HTMLInputElement, fast = decimate.elements.namedItem("fast") as HTMLInputElement;
const engine = new Engine();

/** The mesh or cloud that is open. */
let opened: { name: string; faces: number; scene: Scene; file: File } | null = null;
let result = { path: "", name: "" };
let viewer: Viewer | null = null;
let busy = false;

/** A name that the command line takes for a file. */
const safe = (name: string): string => (name.startsWith("-") ? `./${name}` : name).replaceAll("\n", " ");
const stem = (name: string): string => name.replace(/\.[^.]*$/, "");

function draw(scenes: Scene[]): void {
  viewer?.close();
  viewer = showPage(app, { title: scenes.map((s) => s.name).join(" and "), field: "scalar_total_curvature", low: null, high: null, scenes });
}

function offer(path: string, name: string): void {
  result = { path, name };
  download.textContent = `Save ${name}`;
  download.hidden = false;
}

/** What is done now, with what may be clicked meanwhile; complaints are shown. */
async function during(what: string, work: () => Promise<void>): Promise<void> {
  if (busy) return;
  busy = true;
  document.body.dataset["state"] = "busy";
  const before = summary.textContent!;
  summary.textContent = `${what} …`;
  failure.hidden = true;
  cancel.hidden = false;
  download.hidden = true;
  try {
    await work();
    document.body.dataset["state"] = "done";
  } catch (error) {
    summary.textContent = before;
    failure.textContent = error instanceof Cancelled ? "Cancelled." : (error as Error).message;
    failure.hidden = false;
    document.body.dataset["state"] = "failed";
  } finally {
    busy = false;
    cancel.hidden = true;
  }
}

function showTarget(): void {
  const part = Number(ratio.value) / 100;
  find(".decimate output").textContent = `${ratio.value} %: ${counted(Math.floor(part * (opened?.faces ?? 0)), "face")}`;
}

const open = (file: File): Promise<void> =>
  during(`Measuring ${file.name}`, async () => {
    const name = safe(file.name), written = "/out/curvature.ply";
    const answer = await engine.ask({ file: { name, bytes: file }, run: ["curvature", name, "-o", written, "--json", "--quiet"], scene: written });
    const report = JSON.parse(answer.out), mesh = report.kind === "mesh", scene = sceneOf(file.name, answer.scene!);
    opened = { name, faces: report.faces, scene, file };
    draw([scene]);
    offer(written, `${stem(file.name)}-curvature.ply`);
    decimate.hidden = !mesh;
    showTarget();
    const size = mesh ? `${counted(report.vertices, "vertex", "vertices")} and ${counted(report.faces, "face")}` : counted(report.vertices, "point");
    const { density } = report, numbers = density.rms === null ? "no value is defined" : `mean ${shortNumber(density.mean)}, rms ${shortNumber(density.rms)} 1/unit²`;
    summary.textContent =
      `${file.name}: ${size}. Total curvature: ${numbers}; ${report.undefined} undefined. ` +
      `Measured in ${shortNumber(answer.milliseconds / 1000)} s.${report.notes.length ? ` Note: ${report.notes.join("; ")}.` : ""}`;
    summary.dataset["report"] = answer.out;
  });

const decimated = (): Promise<void> =>
  during(`Decimating ${opened!.scene.name}`, async () => {
    const { name, file, scene } = opened!, written = "/out/decimated.ply", shown = "/out/decimated-curvature.ply";
    const options = ["--ratio", String(Number(ratio.value) / 100), ...(fast.checked ? ["--fast"] : [])];
    const answer = await engine.ask({ file: { name, bytes: file }, run: ["decimate", name, ...options, "-o", written, "--json", "--quiet"] });
    const report = JSON.parse(answer.out);
    const measured = await engine.ask({ run: ["curvature", written, "-o", shown, "--quiet"], scene: shown });
    draw([scene, sceneOf(`${stem(scene.name)}, decimated`, measured.scene!)]);
    offer(written, `${stem(scene.name)}-decimated.ply`);
    summary.textContent =
      `${scene.name}: ${counted(report.faces_in, "face")} became ${counted(report.faces_out, "face")} in ${shortNumber(answer.milliseconds / 1000)} s; ` +
      `distance rms ${shortNumber(report.error.rms)}, at most about ${shortNumber(report.error.max)} of the diagonal.${report.reason ? ` Stopped: ${report.reason}.` : ""}`;
    summary.dataset["report"] = answer.out;
  });

async function save(): Promise<void> {
  const { bytes } = await engine.ask({ run: null, bytes: result.path });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes!]));
  link.download = result.name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

chooser.addEventListener("change", () => {
  const file = chooser.files?.[0];
  chooser.value = "";
  if (file) void open(file);
});
document.addEventListener("dragover", (e) => e.preventDefault());
document.addEventListener("drop", (e) => {
  e.preventDefault();
  const file = e.dataTransfer?.files[0];
  if (file) void open(file);
});
ratio.addEventListener("input", showTarget);
decimate.addEventListener("submit", (e) => {
  e.preventDefault();
  if (opened) void decimated();
});
download.addEventListener("click", () => void save());
cancel.addEventListener("click", () => {
  engine.cancel();
});
document.documentElement.dataset["theme"] = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
document.body.dataset["state"] = "ready";
