// How values become colours on the GPU: one value a vertex, a range and a colour map; changing these redraws, no more.

/** Of what is undefined: a number no value reaches, so that no comparison with NaN is left to the driver. */
export const undefinedValue = -3.4e38;

const head = /* glsl */ `
precision highp float;
precision highp int;
`;

/** Shared by faces and points: the direction of a normal from its two octahedral numbers. */
const octahedral = /* glsl */ `
vec3 unfolded(vec2 e) {
  if (e.x < -0.99999 && e.y < -0.99999) return vec3(0.0);
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}
`;

/**
 * `flat`: values of faces, carried by the last corner of each, which no other face has as its last.
 * `points`: discs.
 */
export function vertexShader(kind: "smooth" | "flat" | "points" | "pick" | "pickPoints"): string {
  const pick = kind === "pick" || kind === "pickPoints", points = kind === "points" || kind === "pickPoints";
  const outputs = pick
    ? "flat out uint id;"
    : `${kind === "flat" ? "flat out float vValue; flat out float vUndefined;" : "out float vValue; out float vUndefined;"} out vec3 vNormal; out vec3 vView; out vec3 vWorldNormal;`;
  return `${head}
uniform mat4 modelViewMatrix, projectionMatrix;
uniform mat3 normalMatrix;
uniform float uPointSize, uPixels;
in vec3 position;
in vec2 normal;
in float value;
${outputs}
${octahedral}
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  ${points ? "gl_PointSize = clamp(uPointSize * uPixels / -seen.z, 1.5, 256.0);" : ""}
  ${
    pick
      ? "id = uint(gl_VertexID);"
      : `vUndefined = value < -3.0e38 ? 1.0 : 0.0;
  vValue = vUndefined > 0.0 ? 0.0 : value;
  vWorldNormal = unfolded(normal);
  vNormal = normalMatrix * vWorldNormal;
  vView = seen.xyz;`
  }
}`;
}

/** Light from above the eye and to its left, as in the pictures (src/shading.h). */
export function fragmentShader(kind: "smooth" | "flat" | "points"): string {
  const flat = kind === "flat" ? "flat " : "";
  return `${head}
uniform sampler2D uMap;
uniform float uLow, uHigh;
uniform int uLogarithmic, uNormals, uHasNormals;
uniform vec3 uUndefined0, uUndefined1;
${flat}in float vValue;
${flat}in float vUndefined;
in vec3 vNormal;
in vec3 vView;
in vec3 vWorldNormal;
out vec4 color;
vec3 linear(vec3 c) { return pow(c, vec3(2.2)); }
void main() {
  ${kind === "points" ? "vec2 disc = 2.0 * gl_PointCoord - 1.0; if (dot(disc, disc) > 1.0) discard;" : ""}
  vec3 base;
  if (uNormals == 1) base = dot(vWorldNormal, vWorldNormal) < 0.01 ? uUndefined0 : 0.5 + 0.5 * normalize(vWorldNormal);
  else if (vUndefined > 0.001) base = mod(floor((gl_FragCoord.x + gl_FragCoord.y) / 4.0), 2.0) < 1.0 ? uUndefined0 : uUndefined1;
  else {
    float at = uLogarithmic == 1
      ? (vValue > 0.0 ? log(vValue / uLow) / log(uHigh / uLow) : 0.0)
      : (vValue - uLow) / (uHigh - uLow);
    base = texture(uMap, vec2((clamp(at, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  }
  vec3 n = vNormal;
  ${
    kind === "points"
      ? "if (dot(n, n) < 0.01) n = vec3(disc.x * 0.35, -disc.y * 0.35, 1.0);"
      : `vec3 across = normalize(cross(dFdx(vView), dFdy(vView)));
  // At creases, and where there are no normals, the face's own.
  if (uHasNormals == 0 || dot(n, n) < 0.01 || abs(dot(normalize(n), across)) < 0.8) n = across;`
  }
  n = normalize(n);
  if (n.z < 0.0) n = -n;
  float light = 0.22 + max(0.0, -0.26 * n.x + 0.42 * n.y + 0.78 * n.z);
  float middle = max(0.0, -0.15 * n.x + 0.24 * n.y + 0.959 * n.z);
  float shine = 0.28 * pow(middle, 32.0) * (1.0 - n.z * n.z);
  color = vec4(pow(min(linear(base) * light + shine, 1.0), vec3(1.0 / 2.2)), 1.0);
}`;
}

/** The index of what is under a pixel, from 1, in four bytes. */
export function pickShader(points: boolean): string {
  return `${head}
flat in uint id;
out vec4 color;
void main() {
  ${points ? "vec2 disc = 2.0 * gl_PointCoord - 1.0; if (dot(disc, disc) > 1.0) discard;" : ""}
  uint i = id + 1u;
  color = vec4(float(i & 255u), float((i >> 8) & 255u), float((i >> 16) & 255u), float(i >> 24)) / 255.0;
}`;
}

export const lineVertexShader = `${head}
uniform mat4 modelViewMatrix, projectionMatrix;
uniform float uNearer;
in vec3 position;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= uNearer * gl_Position.w;
}`;

/** A hair from each vertex along its normal: two vertices a line, the line an instance. */
export const hairVertexShader = `${head}
uniform mat4 modelViewMatrix, projectionMatrix;
uniform float uLength;
in vec3 position;
in vec3 root;
in vec2 normal;
${octahedral}
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(root + position.x * uLength * unfolded(normal), 1.0);
}`;

export const lineFragmentShader = `${head}
uniform vec4 uColor;
uniform float uFade;
out vec4 color;
void main() { color = vec4(uColor.rgb, uColor.a * uFade); }`;
