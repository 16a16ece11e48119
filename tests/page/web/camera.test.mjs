// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The camera: its axes, its projection, and what hands do with it.

import assert from 'node:assert/strict'
import test from 'node:test'

import { load, near, random } from './load.mjs'

const { Camera } = load('view.js', 'Camera')
const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0)
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
const close = (a, b, error, what) => a.forEach((v, k) => near(v, b[k], error, `${what} ${'xyz'[k]}`))

/// Cameras of all kinds, and places before them.
function* cameras(n) {
  const draw = random(2)
  for (let i = 0; i < n; ++i) {
    const extent = 10 ** (4 * draw() - 1), camera = Object.assign(new Camera(), {
      target: [0, 0, 0].map(() => extent * (draw() - 0.5)), azimuth: 7 * draw(), elevation: Math.PI * (draw() - 0.5),
      distance: extent * (0.1 + 2 * draw()), extent, width: 200 + 1000 * draw(), height: 200 + 1000 * draw() })
    const [r, u, f] = camera.axes(), deep = 0.9 * camera.distance * (draw() - 0.5)
    const place = camera.target.map((t, k) => t + 0.1 * camera.distance * ((draw() - 0.5) * r[k] + (draw() - 0.5) * u[k]) + deep * f[k])
    yield { camera, place }
  }
}

test('azimuth 0 looks north, elevation 0 along the ground, elevation 90 degrees down', () => {
  const level = Object.assign(new Camera(), { azimuth: 0, elevation: 0 }), down = Object.assign(new Camera(), { azimuth: 0, elevation: Math.PI / 2 })
  assert.deepEqual(level.axes().map(axis => axis.map(v => v + 0)), [[1, 0, 0], [0, 0, 1], [0, 1, 0]])
  close(down.axes()[2], [0, 0, -1], 1e-15, 'forward')
  close(down.axes()[1], [0, 1, 0], 1e-15, 'up')
  close(Object.assign(new Camera(), { azimuth: Math.PI / 2, elevation: 0 }).axes()[2], [1, 0, 0], 1e-15, 'forward at 90 degrees')
})

test('the axes are right-handed and of length 1', () => {
  for (const { camera } of cameras(200)) {
    const [r, u, f] = camera.axes()
    for (const [a, b, expected] of [[r, r, 1], [u, u, 1], [f, f, 1], [r, u, 0], [u, f, 0], [f, r, 0]]) near(dot(a, b), expected, 1e-14)
    close(cross(r, f), u, 1e-14, 'up')
  }
})

test('the target is in the middle, at the distance', () => {
  for (const { camera } of cameras(200)) {
    const [x, y, depth] = camera.project(camera.target)
    near(x, camera.width / 2, 1e-6), near(y, camera.height / 2, 1e-6), near(depth / camera.distance, 1, 1e-9)
  }
})

test('the matrix puts places where the projection does', () => {
  for (const { camera, place } of cameras(500)) {
    const m = camera.matrix(), [x, y, w] = [0, 1, 3].map(k => m[k] * place[0] + m[4 + k] * place[1] + m[8 + k] * place[2] + m[12 + k])
    const [sx, sy, depth] = camera.project(place), { width, height } = camera, error = 0.01  // px: the matrix is of floats
    near(width / 2 * (1 + x / w), sx, error), near(height / 2 * (1 - y / w), sy, error), near(w / depth, 1, 1e-4)
  }
})

test('the near and the far plane are -1 and 1 deep', () => {
  for (const { camera } of cameras(100)) {
    const m = camera.matrix(), eye = camera.eye(), forward = camera.axes()[2]
    for (const [distance, expected, error] of [[camera.near, -1, 0.02], [camera.far, 1, 1e-4]]) {
      const p = eye.map((v, k) => v + distance * forward[k])
      const [z, w] = [2, 3].map(k => m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k])
      near(z / w, expected, error)
    }
  }
})

test('zooming keeps what is at the pixel, in the depth of the target', () => {
  for (const { camera } of cameras(200)) {
    const [r, u] = camera.axes(), place = camera.target.map((t, k) => t + 0.1 * camera.distance * (r[k] - 0.5 * u[k]))
    const [x, y] = camera.project(place), before = camera.distance
    camera.zoom(1.3, x, y)
    near(before / camera.distance, 1.3, 1e-9)
    const [x2, y2] = camera.project(place)
    near(x2, x, 1e-6), near(y2, y, 1e-6)
  }
})

test('zooming ends before the target and far beyond the scene', () => {
  const camera = new Camera()
  camera.zoom(1e9)
  assert.equal(camera.distance, camera.extent * 1e-4)
  camera.zoom(1e-30)
  assert.equal(camera.distance, 20 * camera.extent)
})

test('panning moves what is in the depth of the target by so many pixels', () => {
  for (const { camera } of cameras(100)) {
    const place = camera.target
    camera.pan(30, 20)
    const [x, y] = camera.project(place)
    near(x, camera.width / 2 + 30, 1e-6), near(y, camera.height / 2 - 20, 1e-6)
  }
})

test('turning keeps the target and ends at the zenith and the nadir', () => {
  const camera = new Camera(), { azimuth, target } = camera
  camera.turn(0.1, 9)
  near(camera.azimuth, azimuth - 0.1, 1e-15)
  assert.equal(camera.elevation, Math.PI / 2)
  camera.turn(0, -9)
  assert.equal(camera.elevation, -Math.PI / 2)
  assert.equal(camera.target, target)
})

test('what is framed is in the middle and before the camera, at most a little of it outside', () => {
  const draw = random(3)
  for (const [width, height] of [[1000, 700], [300, 900], [1600, 300]])
    for (let i = 0; i < 50; ++i) {
      const least = [0, 0, 0].map(() => 100 * (draw() - 0.5)), most = least.map(v => v + 50 * draw())
      const camera = Object.assign(new Camera(), { width, height, azimuth: 7 * draw(), elevation: 1.5 * draw() })
      camera.fit(least, most)
      for (let corner = 0; corner < 8; ++corner) {
        const [x, y, depth] = camera.project([0, 1, 2].map(k => (corner >> k & 1 ? most : least)[k]))
        assert.ok(depth > camera.near && depth < camera.far, `depth ${depth}`)
        assert.ok(x > -0.2 * width && x < 1.2 * width && y > -0.2 * height && y < 1.2 * height, `${x}, ${y} of ${width} x ${height}`)
      }
    }
})
