// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Points in memory: growing, thinning, and the chunks and the order in which they are drawn.

import assert from 'node:assert/strict'
import test from 'node:test'

import { blockOf, load, near, random } from './load.mjs'

const { Points } = load('points.js', 'Points')

function pointsAt(places, more) {
  const points = new Points()
  points.append(blockOf(places, more))
  return points
}
const line = n => Array.from({ length: n }, (_, i) => [i, 2 * i, -i])

test('blocks are appended with all that they hold', () => {
  const points = pointsAt([[500000.0005, 1, 2], [3, 4, 5]], { pulse: [2 ** 40 + 1, 2 ** 40 + 3], object: [4294967295, 7] })
  points.append(blockOf([[6, 7, 8]], { from_x: [9], from_y: [11], from_z: [8], object: [1] }))
  assert.equal(points.count, 3)
  const values = name => [...points.arrays[name].subarray(0, 3)]
  assert.deepEqual(values('x'), [500000.0005, 3, 6])
  assert.deepEqual(values('pulse'), [2 ** 40 + 1, 2 ** 40 + 3, 0])
  assert.deepEqual(values('object'), [4294967295, 7, 1])
  assert.deepEqual(values('to_z'), [1, 1, 0])
  assert.deepEqual(values('range'), [1, 1, 5])
  assert.deepEqual(points.steps, { x: 0.001, range: 0.001 })
})

test('thinning keeps the points of the least keys, in their order', () => {
  const points = pointsAt(line(5), { key: [5, 1, 9, 2, 3] })
  assert.equal(points.thin(9, 3), 3)
  assert.equal(points.thin(4, 3), 1)
  assert.deepEqual([...points.arrays.pulse.subarray(0, points.count)], [1, 3, 4])
  assert.equal(points.thin(2, 2), -1)
  assert.deepEqual([...points.arrays.pulse.subarray(0, points.count)], [1, 3])
})

test('thinning takes a point out of every attribute, whatever came in between', () => {
  const draw = random(1), points = new Points(), expected = []
  for (let round = 0, pulse = 0; round < 5; ++round) {
    const places = Array.from({ length: 700 }, () => [draw(), draw(), draw()])
    const key = Float64Array.from(places, () => Math.floor(draw() * 4294967296)), numbers = Float64Array.from(places, () => pulse++)
    points.append(blockOf(places, { key, pulse: numbers }))
    places.forEach((place, i) => expected.push({ place, key: key[i], pulse: numbers[i] }))
    const largest = 4294967296 * (1 - 0.15 * round)
    points.thin(largest)
    expected.splice(0, Infinity, ...expected.filter(point => point.key <= largest))
  }
  assert.equal(points.count, expected.length)
  assert.ok(points.count > 500 && points.count < 2500)
  expected.forEach(({ place, key, pulse }, i) => {
    const { arrays } = points
    assert.deepEqual([arrays.x[i], arrays.y[i], arrays.z[i], arrays.key[i], arrays.pulse[i]], [...place, key, pulse])
  })
})

test('nothing is thinned where there are no keys', () => {
  const { key, ...columns } = blockOf(line(3)).columns
  const points = new Points()
  points.append({ count: 3, columns, steps: {} })
  assert.equal(points.thin(0, 2), 2)
  assert.equal(points.count, 3)
})

test('chunks hold all points, their bounds and when they begin', () => {
  const size = Points.chunkSize, points = pointsAt(line(2 * size + 10))
  assert.deepEqual(points.chunks.map(c => [c.first, c.count]), [[0, size], [size, size], [2 * size, 10]])
  const last = points.chunks[2]
  assert.deepEqual([last.least, last.most], [[2 * size, 4 * size, -2 * size - 9], [2 * size + 9, 4 * size + 18, -2 * size]])
  assert.equal(last.begin, 2 * size)
})

test('only chunks that grow are made anew, and those that are gone are freed', () => {
  const size = Points.chunkSize, points = pointsAt(line(size + 5))
  let freed = 0
  for (const chunk of points.chunks) Object.assign(chunk, { placesAreOld: false, coloursAreOld: false, free: () => ++freed })
  points.append(blockOf(line(size)))
  assert.deepEqual(points.chunks.map(c => [c.count, c.placesAreOld]), [[size, false], [size, true], [5, true]])
  points.clear()
  assert.equal(points.chunks.length, 0)
  assert.equal(freed, 2)
  assert.equal(points.count, 0)
})

test('a chunk is drawn in an order of which every first part is a fair sample', () => {
  const size = Points.chunkSize, points = pointsAt(line(size + 1000))
  for (const chunk of points.chunks) {
    const order = points.order(chunk), part = Math.floor(chunk.count / 4)
    assert.deepEqual([...order].sort((a, b) => a - b), Array.from({ length: chunk.count }, (_, i) => i))
    const mean = order.subarray(0, part).reduce((sum, i) => sum + i, 0) / part
    near(mean / chunk.count, 0.5, 4 / Math.sqrt(12 * part), 'the mean of a quarter')
  }
})

test('usual values leave out a half percent at either end, and what is no number', () => {
  const values = Float64Array.from({ length: 1000 }, (_, i) => 999 - i)
  assert.deepEqual(pointsAt(line(1000), { width: values }).usual('width'), [4, 995])
  assert.deepEqual(pointsAt(line(1000), { width: values }).usual('width', 0), [0, 999])
  assert.deepEqual(pointsAt(line(3), { width: [NaN, 5, Infinity] }).usual('width'), [5, 5])
  assert.deepEqual(pointsAt(line(3), { width: [NaN, NaN, NaN] }).usual('width'), [0, 1])
})
