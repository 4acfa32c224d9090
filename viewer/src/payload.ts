// The data of a page: a head in JSON, and arrays in blocks (docs/viewer.md; the writer is src/page.cpp).
import type { Field, Scene, Triple } from "./scene";

export interface PageData {
  title: string;
  /** The field shown first; empty: the first. */
  field: string;
  low: number | null;
  high: number | null;
  scenes: Scene[];
}

interface ArrayHead {
  block: number;
  rows: number;
  columns: number;
  type: "float32" | "float64" | "octahedral" | "triangles";
}

interface Head {
  format: string;
  version: number;
  title: string;
  field: string;
  low: number | null;
  high: number | null;
  rows_a_block: number;
  scenes: {
    name: string;
    toward: Triple;
    up: Triple;
    spacing: number;
    origin: Triple;
    positions: ArrayHead;
    triangles: ArrayHead | null;
    normals: ArrayHead | null;
    fields: (Omit<Field, "values" | "ofFaces"> & { of: "vertex" | "face"; values: ArrayHead })[];
  }[];
}

/** What is wrong with the page, for people. */
export class BrokenPage extends Error {}

function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const modern = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };
  if (modern.fromBase64) return modern.fromBase64(text);
  const characters = atob(text);
  const out = new Uint8Array(characters.length);
  for (let i = 0; i < out.length; ++i) out[i] = characters.charCodeAt(i);
  return out;
}

async function inflated(index: number, expected: number): Promise<Uint8Array> {
  const element = document.getElementById(`gaussmap-${index}`);
  if (!element) throw new BrokenPage(`block ${index} of its data is missing`);
  const out = new Uint8Array(expected);
  let length = 0;
  try {
    // Straight into the stream: a Blob would take the bytes through another process, in small pieces.
    const stream = new DecompressionStream("deflate"), writer = stream.writable.getWriter();
    const written = Promise.all([writer.write(bytesOf(element.textContent!)), writer.close()]);
    written.catch(() => undefined); // reading tells of it too
    const reader = stream.readable.getReader();
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      const bytes = part.value as Uint8Array;
      if (length + bytes.length <= expected) out.set(bytes, length);
      length += bytes.length;
    }
    await written;
  } catch {
    throw new BrokenPage(`block ${index} of its data is damaged`);
  }
  element.remove();
  if (length !== expected) throw new BrokenPage(`block ${index} holds ${length} bytes instead of ${expected}`);
  return out;
}

/** Rows of a block into `out`: planes of bytes to numbers, zigzag undone, differences summed. 32 and 16 bits. */
function unpack32(planes: Uint8Array, rows: number, columns: number, bytes: 2 | 4, fromFirst: boolean, out: Int32Array): void {
  for (let c = 0; c < columns; ++c) {
    const at = c * bytes * rows;
    let before = 0;
    for (let r = 0; r < rows; ++r) {
      let coded = planes[at + r]! | (planes[at + rows + r]! << 8);
      if (bytes === 4) coded |= (planes[at + 2 * rows + r]! << 16) | (planes[at + 3 * rows + r]! << 24);
      const difference = (coded >>> 1) ^ -(coded & 1);
      before = ((fromFirst && c > 0 ? out[r * columns]! : before) + difference) | 0;
      out[r * columns + c] = before;
    }
  }
}

function unpack64(planes: Uint8Array, rows: number, columns: number, out: BigInt64Array): void {
  for (let c = 0; c < columns; ++c) {
    const at = c * 8 * rows;
    let before = 0n;
    for (let r = 0; r < rows; ++r) {
      let low = 0, high = 0;
      for (let b = 0; b < 4; ++b) {
        low |= planes[at + b * rows + r]! << (8 * b);
        high |= planes[at + (b + 4) * rows + r]! << (8 * b);
      }
      const coded = (BigInt(high >>> 0) << 32n) | BigInt(low >>> 0);
      before = BigInt.asIntN(64, before + ((coded >> 1n) ^ -(coded & 1n)));
      out[r * columns + c] = before;
    }
  }
}

async function arrayOf(head: ArrayHead, rowsABlock: number): Promise<Int32Array | BigInt64Array> {
  const { rows, columns, type } = head;
  const bytes = type === "float64" ? 8 : type === "octahedral" ? 2 : 4;
  const out = bytes === 8 ? new BigInt64Array(rows * columns) : new Int32Array(rows * columns);
  const blocks: Promise<void>[] = [];
  for (let begin = 0, b = head.block; begin < rows; begin += rowsABlock, ++b) {
    const part = Math.min(rowsABlock, rows - begin);
    blocks.push(
      inflated(b, part * columns * bytes).then((planes) => {
        const slot = out.subarray(begin * columns, (begin + part) * columns);
        if (slot instanceof BigInt64Array) unpack64(planes, part, columns, slot);
        else unpack32(planes, part, columns, bytes as 2 | 4, type === "triangles", slot);
      }),
    );
  }
  await Promise.all(blocks);
  return out;
}

async function floats(head: ArrayHead, rowsABlock: number): Promise<Float32Array | Float64Array> {
  const words = await arrayOf(head, rowsABlock);
  return words instanceof BigInt64Array ? new Float64Array(words.buffer) : new Float32Array(words.buffer);
}

function checkCount(what: string, values: ArrayLike<number>, expected: number): void {
  if (values.length !== expected) throw new BrokenPage(`${what} has ${values.length} numbers instead of ${expected}`);
}

async function sceneOf(head: Head["scenes"][number], rowsABlock: number): Promise<Scene> {
  const [positions, corners, directions, ...values] = await Promise.all([
    floats(head.positions, rowsABlock),
    head.triangles ? arrayOf(head.triangles, rowsABlock) : null,
    head.normals ? arrayOf(head.normals, rowsABlock) : null,
    ...head.fields.map((field) => floats(field.values, rowsABlock)),
  ]);
  const triangles = corners ? new Uint32Array(corners.buffer) : null;
  const n = positions.length / 3;
  if (triangles)
    for (let i = 0; i < triangles.length; ++i)
      if (triangles[i]! >= n) throw new BrokenPage(`face ${Math.floor(i / 3)} has a corner ${triangles[i]} of ${n} vertices`);
  if (directions) checkCount("the array of normals", directions as Int32Array, 2 * n);
  const fields = head.fields.map((field, i): Field => {
    const { of, ...rest } = field;
    checkCount(`field ${field.name}`, values[i]!, of === "face" ? (triangles ? triangles.length / 3 : 0) : n);
    return { ...rest, ofFaces: of === "face", values: values[i]! };
  });
  const { name, origin, spacing, toward, up } = head;
  return { name, origin, positions, triangles, normals: directions ? new Int16Array(directions as Int32Array) : null, spacing, toward, up, fields };
}

/** \throws BrokenPage with what is wrong. */
export async function readPage(): Promise<PageData> {
  const element = document.getElementById("gaussmap");
  if (!element) throw new BrokenPage("it holds no data; gaussmap view FILE -o page.html makes a page that does");
  let head: Head;
  try {
    head = JSON.parse(element.textContent!) as Head;
  } catch {
    throw new BrokenPage("the head of its data is damaged");
  }
  if (head.format !== "gaussmap page" || head.version !== 1)
    throw new BrokenPage(`its data are of version ${head.version}, which this viewer does not know`);
  const scenes = await Promise.all(head.scenes.map((scene) => sceneOf(scene, head.rows_a_block)));
  return { title: head.title, field: head.field, low: head.low, high: head.high, scenes };
}
