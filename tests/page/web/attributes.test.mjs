// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Attributes of points: the words for their values, their histogram, their colours.

import assert from 'node:assert/strict'
import test from 'node:test'

import { blockOf, load, near } from './load.mjs'

const scale = Array.from({ length: 256 }, (_, i) => [i, 0, 255 - i]), kinds = [[1, 1, 1], [2, 2, 2], [3, 3, 3]]
const survey = { objects: { 2: 'house' }, legs: [{ name: 'north' }], colours: { viridis: scale, greys: scale, hues: scale, classes: scale, kinds, light: kinds } }
globalThis.document = { getElementById: () => ({ textContent: JSON.stringify(survey) }) }
const { Colouring, attributes, brief, description, points, power, survey: pageSurvey, whole, written } =
  load('attributes.js', 'Colouring', 'attributes', 'brief', 'description', 'points', 'power', 'survey', 'whole', 'written')

/// Has the page's points be these: columns by name.
function take(columns, steps = {}) {
  const n = Object.values(columns)[0].length
  points.clear()
  points.append({ ...blockOf(Array.from({ length: n }, (_, i) => [i, 0, 0]), columns), steps: { x: 0.001, y: 0.001, z: 0.001, ...steps } })
  return points
}

function colouringBy(name) {
  const colouring = new Colouring()
  colouring.take(name)
  return colouring
}

test('powers have three digits and the unit that suits them', () => {
  const found = [2, 0.9995, 0.01234, 0.9994e-3, 1.5e-6, 3e-10, 4e-14].map(power)
  assert.deepEqual(found, ['2 W', '1 W', '12.3 mW', '999 µW', '1.5 µW', '300 pW', '0.04 pW'])
  assert.equal(whole(1234567.4), '1\u202f234\u202f567')
})

test('values have the unit of their attribute and the decimals of their step', () => {
  take({ range: [1] }, { z: 0.001, incidence: 0.5, scan_angle: 0.05, time: 1e-7, reflectance: 0.002 })
  assert.equal(written('z', 12.3456), '12.346 m')
  assert.equal(written('incidence', 45), '45.0°')
  assert.equal(written('scan_angle', -3.25), '-3.25°')
  assert.equal(written('time', 1.23456789), '1.2345679 s')
  assert.equal(written('reflectance', 0.5), '0.500')
  assert.equal(written('amplitude', 2e-6), '2 µW')
  assert.equal(written('width', NaN), '–')
  assert.deepEqual([written('object', 2), written('object', 3), written('leg', 0), written('leg', 1)], ['house', '3', 'north', '1'])
  assert.deepEqual([written('class', 2), written('class', 77)], ['2 Ground', '77'])
  assert.deepEqual([brief('z', 123.456789), brief('incidence', 0.25), brief('amplitude', 1e-9)], ['123.5 m', '0.25°', '1 nW'])
})

test('a column beyond those of the page is told by its name and unit', () => {
  const columns = { return_number: [1], returns: [2], object: [2], class: [6], leg: [0], amplitude: [1e-3], reflectance: [0.5], pulse: [12345],
                    incidence: [10], scan_angle: [5], channel: [3], time: [7], velocity_x: [1.25], ring: [4] }
  points.clear()
  points.append({ ...blockOf([[0, 0, 0]], columns), steps: { x: 0.001, velocity_x: 0.01, ring: 1 }, units: { velocity_x: 'm/s', ring: '' } })
  const told = Object.fromEntries(description(0))
  assert.deepEqual([told.velocity_x, told.ring], ['1.25 m/s', '4'])
  assert.equal(brief('velocity_x', 1.25), '1.25 m/s')
  delete attributes.velocity_x, delete attributes.ring
})

test('a point is told with all its attributes, the width of its echo and the way of its light only where they are there', () => {
  const columns = { return_number: [1], returns: [2], object: [2], class: [6], leg: [0], amplitude: [1e-3], reflectance: [0.5], pulse: [12345],
                    incidence: [10], scan_angle: [5], channel: [3], time: [7] }
  take(columns)
  const told = Object.fromEntries(description(0))
  assert.equal(told.Return, '1 of 2')
  assert.equal(told.Object, 'house')
  assert.equal(told.Class, '6 Building')
  assert.equal(told.Pulse, '12\u202f345')
  assert.equal(told.Leg, 'north')
  assert.equal(told.Range, '1.000 m')
  assert.ok(!('Echo width' in told) && !('Light' in told))
  take({ ...columns, width: [4], kind: [3] }, { width: 0.001 })
  const more = Object.fromEntries(description(0))
  assert.deepEqual([more['Echo width'], more.Light], ['4.000 ns', 'By a mirror'])
})

test('points are drawn in their own colours, those without one in grey, and none is hidden', () => {
  take({ colour: [0xff0000, 0x00ff01, NaN, 0x0a0bff, 0] })
  const colouring = colouringBy('colour'), out = new Uint8Array(20)
  colouring.fill({ first: 0, count: 5 }, [4, 0, 1, 2, 3], out)
  assert.deepEqual([...out], [0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 1, 255, 128, 128, 128, 255, 10, 11, 255, 255])
  assert.ok(![...points.arrays.colour].some(value => colouring.hides(value)))
  assert.deepEqual([0xff0000, 0x0a0bff, 1, NaN].map(value => written('colour', value)), ['#ff0000', '#0a0bff', '#000001', '–'])
  assert.equal(Object.fromEntries(description(3)).Colour, '#0a0bff')
  colouring.take('z')  // and back to an amount
  colouring.fill({ first: 0, count: 1 }, [0], out)
  assert.equal(out[3], 255)
})

test('every colour is exact in the arrays of the page', () => {
  const all = [0xffffff, 0xfffffe, 0xff00fe, 0x010203]
  take({ colour: all })
  assert.deepEqual([...points.arrays.colour.subarray(0, 4)], all)
})

test('the class is the first choice where it differs and most heights are alike', () => {
  const heights = Array.from({ length: 1000 }, (_, i) => i < 700 ? 0.001 * i : i), kinds = heights.map((_, i) => i < 700 ? 2 : 5)
  take({ z: heights, class: kinds })
  assert.equal(Colouring.first(), 'class')
  take({ z: heights, class: kinds.map(() => 2) })
  assert.equal(Colouring.first(), 'z')
  take({ z: heights.map((_, i) => i), class: kinds })
  assert.equal(Colouring.first(), 'z')
})

test('the legs are set-ups where none moves', () => {
  const { legs } = survey, place = [0, 0, 0]
  for (const [places, expected] of [[[[place], [place]], 'Set-up'], [[[place], [place, place]], 'Leg'], [[[place]], 'Leg']]) {
    pageSurvey.legs = places.map(places => ({ places }))
    assert.equal(attributes.leg.label, expected)
  }
  pageSurvey.legs = legs
})

test('bars count all usual values of an amount, and kinds are told by their number', () => {
  take({ z: Array.from({ length: 1000 }, (_, i) => i) })
  const { bins, ends } = colouringBy('z')
  assert.deepEqual(ends, [4, 995])
  assert.equal(bins.reduce((a, b) => a + b), 991)  // from 4 up to, not with, 995
  assert.ok(Math.max(...bins) - Math.min(...bins) <= 1)
  take({ class: [2, 5, 5, 2, 5, 6] })
  assert.deepEqual(colouringBy('class').kinds, [[5, 3], [2, 2], [6, 1]])
  take({ z: [7, 7, 7] })
  assert.deepEqual(colouringBy('z').ends, [6.5, 7.5])
})

test('an attribute that is plotted by its logarithm is counted and hidden by it', () => {
  take({ amplitude: [1e-6, 1e-5, 1e-4, NaN] })
  const colouring = colouringBy('amplitude')
  near(colouring.ends[0], -6, 1e-6), near(colouring.ends[1], -4, 1e-6)
  colouring.shown = [-5, -4.5]
  assert.deepEqual([1e-6, 1e-5, 1e-4, NaN].map(v => colouring.hides(v)), [true, false, true, true])
  near(colouring.unplotted(colouring.plotted(3e-5)), 3e-5, 1e-15)
})

test('colours go along the scale, and what is hidden is clear', () => {
  take({ z: Array.from({ length: 256 }, (_, i) => i) })
  const colouring = colouringBy('z'), [chunk] = points.chunks, order = points.order(chunk), out = new Uint8Array(4 * 256)
  const colourOf = i => [...out.subarray(4 * order.indexOf(i), 4 * order.indexOf(i) + 4)]
  colouring.ends = [0, 255]
  colouring.fill(chunk, order, out)
  for (const i of [0, 1, 100, 255]) assert.deepEqual(colourOf(i), [i, 0, 255 - i, 255])
  colouring.shown = [100, 151]  // a part is stretched over all colours
  colouring.fill(chunk, order, out)
  assert.deepEqual([colourOf(100), colourOf(101), colourOf(151)], [[0, 0, 255, 255], [5, 0, 250, 255], [255, 0, 0, 255]])
  assert.deepEqual([colourOf(99), colourOf(152)], [[0, 0, 255, 0], [255, 0, 0, 0]])
})

test('kinds have colours of their own, and those that are hidden are clear', () => {
  take({ return_number: [1, 2, 4, 1] })
  const colouring = colouringBy('return_number'), [chunk] = points.chunks, out = new Uint8Array(16)
  colouring.hidden.add(2)
  colouring.fill(chunk, [0, 1, 2, 3], out)
  assert.deepEqual([...out], [1, 1, 1, 255, 2, 2, 2, 0, 1, 1, 1, 255, 1, 1, 1, 255])  // the colours are three, and go round
  assert.deepEqual(attributes.class.colour(70), scale[64])
  assert.deepEqual(attributes.object.colour(0), scale[77])
})
