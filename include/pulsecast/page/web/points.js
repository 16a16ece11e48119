// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

'use strict'

// ---------------------------------------------------------------------------------------------------------- the points

const byId = id => document.getElementById(id)

function bytesOfBase64(text) {
  const chars = atob(text), bytes = new Uint8Array(chars.length)
  for (let i = 0; i < chars.length; ++i) bytes[i] = chars.charCodeAt(i)
  return bytes
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))
  return new Uint8Array(await new Response(stream).arrayBuffer())
}

/// Values of every column of a block, as arrays by name; NaN for a missing value.
async function readBlock(bytes) {
  const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true)
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + size)))
  const planes = await inflated(bytes.subarray(4 + size))
  const block = { count: head.count, columns: {}, steps: {}, units: {} }
  let at = 0
  for (const column of head.columns) {
    const codes = new Float64Array(head.count)
    for (let k = 0, weight = 1; k < column.planes; ++k, weight *= 256, at += head.count)
      for (let i = 0; i < head.count; ++i) codes[i] += planes[at + i] * weight
    if (column.differences)
      for (let i = 0, before = 0; i < head.count; ++i) {
        before += codes[i] % 2 ? -(codes[i] + 1) / 2 : codes[i] / 2
        codes[i] = before
      }
    const { offset, step, values } = column
    const value = column.kind === 'listed' ? c => values[c - 1]
      : column.kind === 'logarithmic' ? c => offset * Math.exp((c - 1) * step) : c => offset + (c - 1) * step
    const each = column.per_pulse ?? 0, { pulse } = block.columns
    for (let i = 0; i < head.count; ++i) codes[i] = codes[i] > 0 ? value(codes[i]) + (each && each * pulse[i]) : NaN
    block.columns[column.name] = codes
    block.steps[column.name] = step
    if (column.unit !== undefined) block.units[column.name] = column.unit
  }
  return block
}

/// All points, in pulse order, an array for each attribute. They are drawn in chunks, each in random order, so that the first part of each
/// chunk is a uniform sample; after the first eighth, each next 1024 points are in pulse order.
class Points {
  static chunkSize = 65536

  constructor() {
    this.count = 0
    this.room = 0
    this.arrays = {}
    this.exact = new Set(['x', 'y', 'z', 'time', 'pulse'])  // beyond single precision
    this.steps = {}
    this.chunks = []
    const pack = Uint32Array.from({ length: Points.chunkSize }, (_, i) => i)
    for (let i = pack.length - 1, seed = 1; i > 0; --i) {
      seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0  // source: Press et al. 2007, Numerical Recipes, ch. 7.1
      const k = Math.floor(seed / 4294967296 * (i + 1)), card = pack[i]
      pack[i] = pack[k], pack[k] = card
    }
    for (let begin = Points.chunkSize / 8; begin < Points.chunkSize; begin += 1024)
      pack.subarray(begin, begin + 1024).sort()  // neighbours in time are neighbours in the picture, whose memory is at hand
    this.pack = pack
  }

  array(name) {
    const type = this.exact.has(name) ? Float64Array : name === 'object' || name === 'key' ? Uint32Array : Float32Array
    if (!this.arrays[name] || this.arrays[name].length < this.room) {
      const grown = new type(this.room)
      if (this.arrays[name]) grown.set(this.arrays[name])
      this.arrays[name] = grown
    }
    return this.arrays[name]
  }

  append({ count, columns, steps, units }) {
    if (count === 0) return
    const first = this.count
    this.count += count
    if (this.count > this.room) this.room = first === 0 ? count : Math.max(this.count, 2 * this.room)
    Object.assign(this.steps, steps)
    for (const name in units) {
      this.exact.add(name)
      attributes[name] ??= { label: name, unit: units[name], further: true }
    }
    for (const name of ['x', 'y', 'z']) {
      const away = this.array('to_' + name), here = columns[name], from = columns['from_' + name]
      for (let i = 0; i < count; ++i) away[first + i] = from[i] - here[i]
    }
    const range = this.array('range'), { to_x, to_y, to_z } = this.arrays
    for (let i = first; i < this.count; ++i) range[i] = Math.hypot(to_x[i], to_y[i], to_z[i])
    this.steps.range = this.steps.x
    for (const name in columns) if (!name.startsWith('from_')) this.array(name).set(columns[name], first)
    this.touch(first)
  }

  /// Keeps the points with a key of at most `largest`. Returns the new index of point `of`; -1 if it is removed.
  thin(largest, of = -1) {
    const { key } = this.arrays
    if (!key) return of
    let kept = 0, there = -1
    for (let i = 0; i < this.count; ++i) {
      if (key[i] > largest) continue
      if (i === of) there = kept
      if (kept !== i) for (const name in this.arrays) this.arrays[name][kept] = this.arrays[name][i]
      ++kept
    }
    if (kept < this.count) this.count = kept, this.touch(0)
    return there
  }

  clear() {
    this.count = 0
    this.touch(0)
  }

  /// Makes the chunks from a point on anew.
  touch(first) {
    const size = Points.chunkSize, chunks = Math.ceil(this.count / size)
    for (const chunk of this.chunks.splice(chunks)) chunk.free?.()
    for (let k = Math.min(Math.floor(first / size), this.chunks.length); k < chunks; ++k) {
      const chunk = this.chunks[k] ??= { first: k * size }
      chunk.count = Math.min(size, this.count - chunk.first)
      const { x, y, z, time } = this.arrays
      const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity]
      for (let i = chunk.first, end = i + chunk.count; i < end; ++i) {
        if (x[i] < least[0]) least[0] = x[i]
        if (x[i] > most[0]) most[0] = x[i]
        if (y[i] < least[1]) least[1] = y[i]
        if (y[i] > most[1]) most[1] = y[i]
        if (z[i] < least[2]) least[2] = z[i]
        if (z[i] > most[2]) most[2] = z[i]
      }
      Object.assign(chunk, { least, most, begin: time[chunk.first], placesAreOld: true, coloursAreOld: true })
    }
  }

  /// Points of a chunk, numbered within it, in drawing order.
  order(chunk) {
    return chunk.count === Points.chunkSize ? this.pack : this.pack.filter(i => i < chunk.count)
  }

  /// Range of an attribute without a share of the points at either end, estimated from a sample.
  usual(name, share = 0.005) {
    const values = this.arrays[name], sample = []
    const stride = Math.max(1, Math.floor(this.count / 50000))
    for (let i = 0; i < this.count; i += stride) if (Number.isFinite(values[i])) sample.push(values[i])
    if (sample.length === 0) return [0, 1]
    const sorted = Float64Array.from(sample).sort(), last = sorted.length - 1
    return [sorted[Math.floor(share * last)], sorted[Math.ceil((1 - share) * last)]]
  }
}
