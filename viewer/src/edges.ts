// The edges of a mesh, each once, and which of them bound it.

export interface Edges {
  /** Two vertices an edge. */
  all: Uint32Array;
  /** Those of one face alone. */
  boundary: Uint32Array;
}

/** Half-edges gathered at their lower vertex by counting; the few of each vertex are compared. O(n + m). */
export function edgesOf(triangles: Uint32Array, vertices: number): Edges {
  const start = new Uint32Array(vertices + 1);
  const each = (visit: (low: number, high: number) => void): void => {
    for (let i = 0; i < triangles.length; i += 3)
      for (let k = 0; k < 3; ++k) {
        const a = triangles[i + k]!, b = triangles[i + ((k + 1) % 3)]!;
        if (a < b) visit(a, b);
        else if (b < a) visit(b, a);
      }
  };
  each((low) => ++start[low + 1]!);
  for (let v = 0; v < vertices; ++v) start[v + 1]! += start[v]!;
  const highs = new Uint32Array(start[vertices]!), next = start.slice(0, vertices);
  each((low, high) => (highs[next[low]!++] = high));

  const all = new Uint32Array(2 * highs.length), boundary = new Uint32Array(2 * highs.length);
  let edges = 0, open = 0;
  for (let v = 0; v < vertices; ++v) {
    const mine = highs.subarray(start[v]!, start[v + 1]!);
    if (mine.length > 16) mine.sort();
    else
      for (let i = 1; i < mine.length; ++i)
        for (let j = i; j > 0 && mine[j - 1]! > mine[j]!; --j) [mine[j - 1], mine[j]] = [mine[j]!, mine[j - 1]!];
    for (let i = 0; i < mine.length; ) {
      let end = i + 1;
      while (end < mine.length && mine[end] === mine[i]) ++end;
      all[edges++] = v, (all[edges++] = mine[i]!);
      if (end - i === 1) boundary[open++] = v, (boundary[open++] = mine[i]!);
      i = end;
    }
  }
  return { all: all.slice(0, edges), boundary: boundary.slice(0, open) };
}
