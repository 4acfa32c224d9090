// meshoptimizer.mjs MODE IN.off OUT_PREFIX FACES…: meshoptimizer of npm, whose simplifier is its C++ as WebAssembly.
//
// Mode "update" is simplifyWithUpdate, which moves the vertices that are kept; "keep" is simplify. Prints one line a result
// as peers.py does.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const root = join(process.cwd(), 'node_modules/meshoptimizer'); // the folder that npm installed it into
const { MeshoptSimplifier } = await import(pathToFileURL(join(root, 'meshopt_simplifier.js')).href);
const { version } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));

/// Positions and triangles; what else a line of a vertex holds (normals) is left.
function readOff(path) {
    const lines = readFileSync(path, 'latin1').split('\n');
    const [vertices, faces] = lines[1].split(' ').map(Number);
    const positions = new Float32Array(3 * vertices), indices = new Uint32Array(3 * faces);
    for (let v = 0; v < vertices; ++v) positions.set(lines[2 + v].split(' ', 3).map(Number), 3 * v);
    for (let f = 0; f < faces; ++f) {
        const [count, ...corners] = lines[2 + vertices + f].split(' ').map(Number);
        if (count !== 3) throw new Error(`${path}: face ${f} is no triangle`);
        indices.set(corners.slice(0, 3), 3 * f);
    }
    return { positions, indices };
}

function writeOff(path, positions, indices) {
    const lines = [`OFF\n${positions.length / 3} ${indices.length / 3} 0`];
    for (let i = 0; i < positions.length; i += 3) lines.push(`${positions[i]} ${positions[i + 1]} ${positions[i + 2]}`);
    for (let i = 0; i < indices.length; i += 3) lines.push(`3 ${indices[i]} ${indices[i + 1]} ${indices[i + 2]}`);
    writeFileSync(path, lines.join('\n') + '\n');
}

function simplify(mode, mesh, faces) {
    const positions = mesh.positions.slice(), indices = mesh.indices.slice();
    const begin = performance.now();
    let left;
    if (mode === 'update') {
        const none = new Float32Array(0);
        const [count] = MeshoptSimplifier.simplifyWithUpdate(indices, positions, 3, none, 0, [], null, 3 * faces, 1e9);
        left = indices.subarray(0, count);
    } else {
        [left] = MeshoptSimplifier.simplify(indices, positions, 3, 3 * faces, 1e9);
    }
    return { seconds: (performance.now() - begin) / 1000, positions, indices: left };
}

await MeshoptSimplifier.ready;
const [mode, input, prefix, ...targets] = process.argv.slice(2);
const name = mode === 'update' ? 'meshoptimizer-moving' : 'meshoptimizer-npm';
const call = mode === 'update' ? 'simplifyWithUpdate, target_error=1e9, WebAssembly' : 'simplify, target_error=1e9, WebAssembly';
const mesh = readOff(input);
for (const target of targets) {
    const { seconds, positions, indices } = simplify(mode, mesh, Number(target));
    const path = `${prefix}${name}_${target}.off`;
    writeOff(path, positions, indices);
    console.log([name, version, call, target, indices.length / 3, seconds.toFixed(4), path].join('\t'));
}
