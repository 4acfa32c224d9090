// Runs the command line compiled to WebAssembly, away from the page, which stays awake.
import type { Answer, Request, SceneArrays, Start } from "./messages";

interface Module {
  FS: {
    mkdir(path: string): void;
    chdir(path: string): void;
    readdir(path: string): string[];
    unlink(path: string): void;
    writeFile(path: string, bytes: Uint8Array): void;
    readFile(path: string): Uint8Array<ArrayBuffer>;
  };
  HEAPU8: Uint8Array;
  ccall(name: string, result: "number" | "string", types: "string"[], values: string[]): unknown;
}
declare const gaussmap: (options: object) => Promise<Module>;
declare function importScripts(address: string): void;

/** More would not fit in the four gigabytes of a module together with what is made of it. */
const mostBytes = 2 ** 30;

let module: Promise<Module>;
let out: string[] = [], complaints: string[] = [];

async function start({ script, code }: Start): Promise<Module> {
  const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  importScripts(address);
  URL.revokeObjectURL(address);
  const made = await gaussmap({ wasmBinary: code, print: (line: string) => out.push(line), printErr: (line: string) => complaints.push(line) });
  made.FS.mkdir("/in");
  made.FS.mkdir("/out");
  made.FS.chdir("/in");
  return made;
}

async function put({ FS }: Module, { name, bytes }: { name: string; bytes: File }): Promise<void> {
  for (const folder of ["/in", "/out"]) for (const old of FS.readdir(folder)) if (old !== "." && old !== "..") FS.unlink(`${folder}/${old}`);
  if (bytes.size > mostBytes) throw new Error(`${name}: ${(bytes.size / mostBytes).toFixed(2)} GiB are more than the 1 GiB that this page takes; use the program gaussmap`);
  FS.writeFile(`/in/${name}`, new Uint8Array(await bytes.arrayBuffer()));
}

/** A copy of an array of the module, whose memory moves when it grows. */
function copied<T>(made: Module, { at, length }: { at: number; length: number }, Kind: new (buffer: ArrayBuffer) => T, size: number): T {
  return new Kind(made.HEAPU8.slice(at, at + length * size).buffer as ArrayBuffer);
}

function sceneOf(made: Module, path: string): SceneArrays {
  const head = JSON.parse(made.ccall("gaussmap_scene", "string", ["string"], [path]) as string);
  if (head.error) throw new Error(head.error);
  return {
    positions: copied(made, head.positions, Float64Array, 8),
    triangles: copied(made, head.triangles, Uint32Array, 4),
    normals: copied(made, head.normals, Float64Array, 8),
    toward: head.toward,
    up: head.up,
    fields: head.fields.map((f: { name: string; ofFaces: boolean; values: { at: number; length: number } }) => ({ ...f, values: copied(made, f.values, Float64Array, 8) })),
  };
}

async function answered(request: Request): Promise<Answer> {
  const answer: Answer = { id: request.id, code: 0, out: "", complaint: "", milliseconds: 0 };
  try {
    const made = await module;
    out = [], (complaints = []);
    if (request.file) await put(made, request.file);
    if (request.run) {
      const begin = performance.now();
      answer.code = made.ccall("gaussmap_run", "number", ["string"], [request.run.join("\n")]) as number;
      answer.milliseconds = performance.now() - begin;
      answer.out = out.join("\n");
      answer.complaint = complaints.join("\n");
    }
    if (answer.code === 0 && request.scene) answer.scene = sceneOf(made, request.scene);
    if (answer.code === 0 && request.bytes) answer.bytes = made.FS.readFile(request.bytes);
  } catch (error) {
    answer.code = 1;
    // The browser gives no memory, or the code ran into a wall of it: both come as errors of the browser.
    const memory = error instanceof RangeError || error instanceof WebAssembly.RuntimeError;
    const reason = error instanceof Error ? error.message : String(error);
    answer.complaint = memory ? `out of memory (${reason}); open a smaller file, or use the program gaussmap` : reason;
  }
  return answer;
}

onmessage = async ({ data }: MessageEvent<Start | Request>) => {
  if ("script" in data) {
    module = start(data);
    return;
  }
  const answer = await answered(data);
  const { scene, bytes } = answer;
  const moved = [...(scene ? [scene.positions, scene.triangles, scene.normals, ...scene.fields.map((f) => f.values)] : []), ...(bytes ? [bytes] : [])];
  postMessage(answer, { transfer: moved.map((array) => array.buffer) });
};
