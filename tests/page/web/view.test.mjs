// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The view: what is in sight, what is picked, what is framed, and how many points a frame has.

import assert from 'node:assert/strict'
import test from 'node:test'

import { blockOf, load, near, random } from './load.mjs'

const { Camera, Points, View } = load('view.js', 'Camera', 'Points', 'View')

/// A view without a canvas.
function viewOf(places, more = {}) {
  const points = new Points()
  points.append(blockOf(places))
  return Object.assign(Object.create(View.prototype), { points, camera: new Camera(), now: Infinity, start: 0, ratio: 1, ways: [],
    origin: [0, 0, 0], slab: { plane: [0, 0, 0, 0], reach: 1 }, wake() {}, ...more })
}

const cloud = (draw, n) => Array.from({ length: n }, () => [40 * draw() - 20, 40 * draw() - 20, 10 * draw()])

test('a chunk is in sight if any of its points is', () => {
  const draw = random(4), view = viewOf(cloud(draw, 50)), [chunk] = view.points.chunks, { x, y, z } = view.points.arrays
  let hidden = 0
  for (let i = 0; i < 2000; ++i) {
    Object.assign(view.camera, { target: [200 * draw() - 100, 200 * draw() - 100, 5], azimuth: 7 * draw(), elevation: 3 * draw() - 1.5,
                                 distance: 5 + 60 * draw(), width: 800, height: 500 })
    const seen = [...x.keys()].some(k => {
      const [px, py, depth] = view.camera.project([x[k], y[k], z[k]])
      return depth > view.camera.near && depth < view.camera.far && px >= 0 && px < 800 && py >= 0 && py < 500
    })
    const inSight = view.inSight(chunk, view.camera.matrix())
    assert.ok(inSight || !seen, 'a chunk is hidden of which a point is seen')
    hidden += !inSight
  }
  assert.ok(hidden > 200, `${hidden} are hidden`)
})

test('the foremost point under the pointer is picked, unless it is hidden or later', () => {
  const view = viewOf([[0, 30, 0], [0, 10, 0], [0, 20, 0], [9, 20, 0]])
  Object.assign(view.camera, { target: [0, 0, 0], azimuth: 0, elevation: 0, distance: 20, width: 800, height: 600 })
  assert.equal(view.pick(401, 301), 1)
  assert.equal(view.pick(401, 301, 1), -1)
  view.hides = i => i === 1
  assert.equal(view.pick(401, 301), 2)
  view.now = 0.5  // the points are a second apart
  assert.equal(view.pick(401, 301), 0)
  view.camera.azimuth = Math.PI  // all are behind
  assert.equal(view.pick(400, 300), -1)
  assert.equal(Object.assign(view, { origin: null }).pick(400, 300), -1)
})

test('a slice hides the points and chunks outside it', () => {
  const view = viewOf([[0, 30, 0], [0, 10, 0], [0, 20, 0]], { origin: [0, 5, 0], slab: { plane: [0, 1, 0, 15], reach: 1 } })
  Object.assign(view.camera, { target: [0, 0, 0], azimuth: 0, elevation: 0, distance: 20, width: 800, height: 600 })
  assert.equal(view.pick(400, 300), 2)
  const [chunk] = view.points.chunks, matrix = view.camera.matrix()
  for (const [middle, expected] of [[3.9, false], [4.1, true], [25.9, true], [26.1, false]]) {
    view.slab.plane[3] = middle
    assert.equal(view.inSight(chunk, matrix), expected)
  }
})

test('every point of a sparse cloud can be picked where it is projected', () => {
  const view = viewOf(cloud(random(5), 30), { origin: [5, -3, 1] }), { x, y, z } = view.points.arrays
  Object.assign(view.camera, { target: [0, 0, 0], distance: 80, width: 3000, height: 2000 })
  for (let i = 0; i < 30; ++i) {
    const [px, py, depth] = view.camera.project(view.relative([x[i], y[i], z[i]])), picked = view.pick(px, py)
    if (picked === i) continue
    const [qx, qy, front] = view.camera.project(view.relative([x[picked], y[picked], z[picked]]))
    assert.ok(Math.hypot(qx - px, qy - py) <= 7 && front < depth, 'another in front is picked')
  }
})

test('all is framed, with the places of the instrument that stand near, and places become relative once', () => {
  const places = cloud(random(6), 500).map(([x, y, z]) => [500000 + x, 5000000 + y, z])
  const view = viewOf(places, { origin: null, ways: [{ places: [[500000, 5000000, 20]] }, { places: [[0, 0, 0]] }] })
  view.fit()
  const { origin, camera } = view
  near(origin[0], 500000, 2), near(origin[1], 5000000, 2), near(origin[2], 5, 1)
  near(camera.target[2] + origin[2], 10, 0.5, 'the middle of the height')
  assert.ok(camera.extent > 40 && camera.extent < 80, `${camera.extent} m`)
  near(view.spacing, 1.79, 0.5, 'the spacing of 500 points on 40 m by 40 m')
  view.points.append(blockOf([[500900, 5000000, 0]]))
  view.fit()
  assert.equal(view.origin, origin)
})

test('slow frames have fewer points, fast ones more, within bounds', () => {
  const view = viewOf([[0, 0, 0]], { rate: 30, budget: 100000, done: 0.5 }), budget = interval => (view.keepPace(interval), view.budget)
  assert.equal(budget(1000 / 30), 100000)
  assert.equal(budget(1000 / 15), 50000)
  assert.equal(budget(5000), 25000)
  assert.equal(budget(5000), 20000)
  near(budget(1000 / 60), 24000, 1e-6)
  near(budget(1000 / 33), 26400, 1e-6)
  view.done = 1
  near(budget(1), 26400, 1e-6)
  Object.assign(view, { budget: 1.9e7, done: 0.5 })
  assert.equal(budget(1), 2e7)
})
