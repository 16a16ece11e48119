// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Compares a tree of random leaves as it is read from OBJ, from a glTF file made here, and from the files that gltfpack makes of both: the
// triangles are the same, to the quantum of the file. Usage: compare.mjs NODE_MODULES PROGRAM, which prints triangles.

import assert from "node:assert";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [modules, program] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "pulsecast-"));

/** Numbers in [0, 1), always the same. Source: Steele & Vigna 2021, multiplier of 32 bits. */
let state = 1;
const random = () => (state = (Math.imul(state, 0x915f77f5) + 1) >>> 0) / 2 ** 32;

/** Corners of triangles, of leaves of up to 20 cm in a crown of 4 m x 4 m x 6 m above a trunk, in single precision. */
const leaves = 1500;
const triangles = [[-0.1, 0, 0, 0.1, 0, 0, 0, 0, 3], [0, -0.1, 0, 0, 0.1, 0, 0, 0, 3]].map((one) => one.map(Math.fround));
for (let leaf = 0; leaf < leaves; ++leaf) {
  const base = [4 * random() - 2, 4 * random() - 2, 2 + 6 * random()];
  triangles.push([0, 1, 2].flatMap(() => base.map((x) => Math.fround(x + 0.2 * (random() - 0.5)))));
}

const path = (name) => join(folder, name);
writeFileSync(path("tree.obj"), triangles.map((t) => [0, 3, 6].map((k) => `v ${t.slice(k, k + 3).join(" ")}\n`).join("")).join("") +
  triangles.map((_, i) => `f ${3 * i + 1} ${3 * i + 2} ${3 * i + 3}\n`).join(""));
const places = triangles.flat();
const along = (k) => places.filter((_, i) => i % 3 === k);
writeFileSync(path("tree.gltf"), JSON.stringify({
  asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
  accessors: [{ bufferView: 0, componentType: 5126, type: "VEC3", count: places.length / 3,
                min: [0, 1, 2].map((k) => Math.min(...along(k))), max: [0, 1, 2].map((k) => Math.max(...along(k))) }],
  bufferViews: [{ buffer: 0, byteLength: 4 * places.length }],
  buffers: [{ byteLength: 4 * places.length,
              uri: "data:application/octet-stream;base64," + Buffer.from(Float32Array.from(places).buffer).toString("base64") }],
}));

const size = Math.max(...[0, 1, 2].map((k) => Math.max(...along(k)) - Math.min(...along(k))));
const files = [["tree.obj", 0], ["tree.gltf", 0]];
for (const [options, quantum] of [[["-noq"], 0], [["-vpf"], size / (2 ** 14 - 1)], [[], size / (2 ** 14 - 1)], [["-vp", "12"], size / (2 ** 12 - 1)],
                                  [["-vp", "16", "-vpn"], size / (2 ** 15 - 1)], [["-c", "-cf"], size / (2 ** 14 - 1)]])
  for (const from of ["tree.obj", "tree.gltf"])
    for (const ending of ["glb", "gltf"]) {
      const to = `${from.replace(".", "_")}${options.join("")}.${ending}`;
      execFileSync(process.execPath, [join(modules, "gltfpack/cli.js"), "-i", path(from), "-o", path(to), ...options]);
      files.push([to, quantum]);
    }

/** Greatest difference of two triangles, from any corner on. */
const difference = (a, b) => Math.min(...[0, 3, 6].map((shift) => Math.max(...a.map((x, i) => Math.abs(x - b[(i + shift) % 9])))));
const middle = (t) => t[0] + t[3] + t[6];

try {
  const printed = execFileSync(program, files.map(([name]) => path(name)), { encoding: "utf8", maxBuffer: 2 ** 30, stdio: ["ignore", "pipe", "ignore"] });
  const read = printed.split("\n\n").slice(0, -1).map((one) => one.split("\n").map((line) => line.trim().split(" ").map(Number)));
  assert.equal(read.length, files.length);
  read.forEach((found, i) => {
    const [name, quantum] = files[i];
    assert.equal(found.length, triangles.length, name);
    const tolerance = 0.51 * quantum + 1e-6;
    const left = new Set(found);
    for (const triangle of triangles) {
      const same = [...left].find((one) => Math.abs(middle(one) - middle(triangle)) < 4 * tolerance && difference(one, triangle) <= tolerance);
      assert.ok(same, `${name}: no triangle at ${triangle}`);
      left.delete(same);
    }
  });
  // OBJ keeps the order, and all digits but for a few units in the last place
  triangles.forEach((triangle, i) => assert.ok(triangle.every((x, k) => Math.abs(read[0][i][k] - x) < 1e-14), `tree.obj: triangle ${i}`));
  console.log(`${triangles.length} triangles of each of ${files.length} files are the same`);
} finally {
  rmSync(folder, { recursive: true });
}
