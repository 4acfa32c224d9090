// Just enough PLY to look at what the program wrote: binary little endian, lists skipped.
import { readFileSync } from "node:fs";

const readers = { float: ["readFloatLE", 4], double: ["readDoubleLE", 8], int: ["readInt32LE", 4], uint: ["readUInt32LE", 4], uchar: ["readUInt8", 1], char: ["readInt8", 1], short: ["readInt16LE", 2], ushort: ["readUInt16LE", 2] };

/** { element: { property: [values] } } */
export function readPly(path) {
  const bytes = readFileSync(path), mark = "end_header\n", end = bytes.indexOf(mark) + mark.length;
  const elements = [];
  for (const line of bytes.toString("latin1", 0, end).split("\n")) {
    const words = line.split(" ");
    if (words[0] === "format" && words[1] !== "binary_little_endian") throw new Error(line);
    if (words[0] === "element") elements.push({ name: words[1], count: Number(words[2]), properties: [] });
    if (words[0] === "property") elements.at(-1).properties.push({ name: words.at(-1), types: words[1] === "list" ? words.slice(2, 4) : [words[1]], values: [] });
  }
  let at = end;
  const take = (type) => {
    const [read, size] = readers[type];
    return bytes[read]((at += size) - size);
  };
  for (const { count, properties } of elements)
    for (let i = 0; i < count; ++i)
      for (const { types, values } of properties) {
        if (types.length === 1) values.push(take(types[0]));
        else for (let k = take(types[0]); k > 0; --k) take(types[1]);
      }
  if (at !== bytes.length) throw new Error(`${path}: ${bytes.length - at} bytes left over`);
  return Object.fromEntries(elements.map((e) => [e.name, Object.fromEntries(e.properties.map((p) => [p.name, p.values]))]));
}
