// What the page and its worker say to each other.

/** Run a verb of the command line on files in the memory of the worker; then read what it wrote, to draw it. */
export interface Request {
  id: number;
  /** A file put there first. */
  file?: { name: string; bytes: File };
  /** The verb and its arguments, or null: nothing to run. */
  run: string[] | null;
  /** A file that is read for drawing, */
  scene?: string;
  /** or as it is. */
  bytes?: string;
}

export interface SceneArrays {
  positions: Float64Array;
  triangles: Uint32Array;
  normals: Float64Array;
  toward: [number, number, number];
  up: [number, number, number];
  fields: { name: string; ofFaces: boolean; values: Float64Array }[];
}

export interface Answer {
  id: number;
  /** 0, or the exit code of the verb. */
  code: number;
  /** Standard output: the report in JSON. Standard error: the complaint where the code is not 0. */
  out: string;
  complaint: string;
  /** Milliseconds of the verb alone. */
  milliseconds: number;
  scene?: SceneArrays;
  bytes?: Uint8Array<ArrayBuffer>;
}

/** First of all: the module, as text of its script and bytes of its code. */
export interface Start {
  script: string;
  code: ArrayBuffer;
}
