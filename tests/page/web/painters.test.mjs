// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The painter without a graphics card: where it puts points, which it leaves out, and how it shades.

import assert from 'node:assert/strict'
import test from 'node:test'

import { load, near, random } from './load.mjs'

const { Camera, PlainPainter, mixed, packed } = load('view.js', 'Camera', 'PlainPainter', 'mixed', 'packed')

const width = 60, height = 40, red = [255, 0, 0, 255], green = [0, 255, 0, 255], clear = [9, 9, 9, 0]

/// A painter on a canvas of memory, and a camera that looks north from 10 m south of the origin.
function set() {
  const context = { createImageData: (w, h) => ({ data: new Uint8ClampedArray(4 * w * h) }), putImageData() {} }
  const painter = new PlainPainter({ getContext: () => context })
  painter.resize(width, height)
  painter.clear()
  return { painter, camera: Object.assign(new Camera(), { azimuth: 0, elevation: 0, distance: 10, extent: 10, width, height }) }
}

/// Draws points of [x, y, z, time] in colours.
function draw({ painter, camera }, places, colours, more = {}) {
  const chunk = {}
  painter.takePlaces(chunk, Float32Array.from(places.flat()))
  painter.takeColours(chunk, Uint8Array.from(colours.flat()))
  painter.draw(chunk, 0, places.length, { matrix: camera.matrix(), near: camera.near, size: 0, least: 1, most: 1, now: Infinity, trail: 0,
                                          fresh: [0, 0, 1], slab: { plane: [0, 0, 0, 0], reach: 1 }, many: true, ...more })
}

const colourAt = ({ painter }, x, y) => [...new Uint8Array(painter.grown().colours.buffer, 4 * ((y | 0) * width + (x | 0)), 4)]
const drawn = ({ painter }) => painter.grown().depths.filter(depth => depth < Infinity).length

test('a colour is packed in the bytes of an image: red, green, blue, opaque', () => {
  const bytes = colour => [...new Uint8Array(Uint32Array.of(packed(colour)).buffer)]
  assert.deepEqual(bytes([1, 0, 0]), red)
  assert.deepEqual(bytes([0.2, 0.4, 0.6]), [51, 102, 153, 255])
  assert.equal(mixed(packed([0.2, 0.4, 0.6]), [255, 0, 0], 0), packed([0.2, 0.4, 0.6]))
  assert.equal(mixed(packed([0.2, 0.4, 0.6]), [255, 0, 102], 1), packed([1, 0, 0.4]))
  assert.equal(mixed(packed([0, 0, 0]), [100, 200, 50], 0.5), packed([50 / 255, 100 / 255, 25 / 255]))
})

test('a point is where the camera projects it, in its depth', () => {
  const any = random(7)
  for (let i = 0; i < 200; ++i) {
    const scene = set(), place = [6 * any() - 3, 4 * any() - 2, 4 * any() - 2], [x, y, depth] = scene.camera.project(place)
    draw(scene, [[...place, 0]], [red])
    if (Math.min(Math.abs(x - Math.round(x)), Math.abs(y - Math.round(y))) < 1e-3) continue  // on an edge
    const within = x >= 0 && x < width && y >= 0 && y < height
    assert.equal(drawn(scene), within ? 1 : 0)
    if (!within) continue
    assert.deepEqual(colourAt(scene, x, y), red)
    near(scene.painter.drawn.depths[(y | 0) * width + (x | 0)], depth, 1e-4)
  }
})

test('the nearer of two points is seen, whichever comes first', () => {
  for (const [order, square] of [[[0, 1], 1], [[1, 0], 1], [[0, 1], 3], [[1, 0], 3]]) {
    const scene = set(), places = [[0, 2, 0, 0], [0, -2, 0, 0]], colours = [red, green]
    draw(scene, order.map(i => places[i]), order.map(i => colours[i]), { least: square, most: square })
    assert.deepEqual(colourAt(scene, width / 2, height / 2), green)
  }
})

test('what is later, clear or behind the camera is not drawn', () => {
  for (const [place, colour, more] of [[[0, 0, 0, 5], red, { now: 4 }], [[0, 0, 0, 0], clear, {}], [[0, -11, 0, 0], red, {}],
                                       [[0, 0, 0, 0], clear, { least: 3, most: 3 }]]) {
    const scene = set()
    draw(scene, [place], [colour], more)
    assert.equal(drawn(scene), 0)
  }
})

test('points are squares of the wanted size, large ones round, cut at the edge', () => {
  const { camera } = set(), middle = camera.project([0, 0, 0]), depth = middle[2]
  for (const [size, least, most, expected] of [[0, 3, 9, 9], [3 * depth, 1, 9, 9], [3 * depth, 2, 9, 9], [5 * depth, 1, 9, 21], [50 * depth, 1, 7, 37]]) {
    const scene = set()
    draw(scene, [[0, 0, 0, 0]], [red], { size, least, most })
    assert.equal(drawn(scene), expected)
  }
  const scene = set()
  draw(scene, [[-3, 0, 0, 0], [5.4, 0, 0, 0]], [red, red], { least: 7, most: 7 })
  assert.ok(drawn(scene) >= 49 && drawn(scene) < 98, `${drawn(scene)} pixels`)
})

test('points grown at once are the squares of each, the nearer one before the other', () => {
  const any = random(8)
  for (const [size, many] of [[2, true], [3, true], [4, true], [6, true], [2, false], [3, false]]) {
    const scene = set(), expected = new Float32Array(width * height).fill(Infinity)
    const places = Array.from({ length: 40 }, () => [4 * any() - 2, 4 * any() - 2, 3 * any() - 1.5, 0])
    draw(scene, places, places.map(() => red), { least: size, most: size, many })
    assert.equal(scene.painter.growth > 0, many)
    for (const place of places) {
      const [x, y, depth] = scene.camera.project(place), [left, top] = [x, y].map(v => Math.max(0, v - (size - 1) / 2 | 0))
      for (let row = top; row < Math.min(height, top + size); ++row)
        for (let column = left; column < Math.min(width, left + size); ++column)
          expected[row * width + column] = Math.min(expected[row * width + column], depth)
    }
    scene.painter.grown().depths.forEach((depth, at) => depth === expected[at] || near(depth, expected[at], 1e-4, `depth of size ${size} at ${at}`))
  }
})

test('what is outside the slice is not drawn', () => {
  for (const [y, expected] of [[0.9, 0], [1.1, 1], [2.9, 1], [3.1, 0]]) {
    const scene = set()
    draw(scene, [[0, y, 0, 0]], [red], { slab: { plane: [0, 1, 0, 2], reach: 1 } })
    assert.equal(drawn(scene), expected)
  }
})

test('what is new has a trace of the colour of what is new', () => {
  const scene = set()
  draw(scene, [[0, 0, 0, 8], [2, 0, 0, 1]], [red, red], { now: 8, trail: 2 })
  const [x, y] = scene.camera.project([2, 0, 0])
  assert.deepEqual(colourAt(scene, width / 2, height / 2), [38, 0, 216, 255])  // 0.85 of the way to blue
  assert.deepEqual(colourAt(scene, x, y), red)
})

test('shading darkens what lies behind a neighbour on any side, and leaves a plane as it is', () => {
  const look = { shading: true, sky: [[0, 0, 1], [0, 0, 1]] }, scene = set(), { painter } = scene
  const pixel = (x, y) => painter.pixels[y * width + x], white = packed([1, 1, 1])
  const { depths, colours } = painter.drawn
  depths.fill(10)
  colours.fill(white)
  depths[20 * width + 30] = 8
  depths[30 * width + 30] = Infinity
  painter.show(look)
  for (const [x, y] of [[30, 20], [32, 20], [5, 5], [0, 0], [width - 1, height - 1]]) assert.equal(pixel(x, y), white)
  for (const [x, y] of [[29, 20], [31, 20], [30, 19], [30, 21]]) {
    const [r, g, b, opaque] = new Uint8Array(painter.pixels.buffer, 4 * (y * width + x), 4)
    assert.ok(r > 150 && r < 230 && g === r && b === r && opaque === 255, `${[r, g, b]} at ${[x, y]}`)
  }
  assert.equal(pixel(30, 30), packed([0, 0, 1]))
  painter.show({ ...look, shading: false })
  assert.equal(pixel(30, 21), white)
})
