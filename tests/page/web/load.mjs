// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Runs scripts of the page in Node.js: those that need no browser until they are asked to draw.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { Duplex } from 'node:stream'
import vm from 'node:vm'
import { createInflateRaw } from 'node:zlib'

const web = new URL('../../../include/pulsecast/page/web/', import.meta.url)
const read = name => readFileSync(new URL(name, web), 'utf8')

/// Names of the scripts, in the order in which the page runs them.
export const scripts = [...read('index.html').matchAll(/^@(.+\.js)@$/gm)].map(match => match[1])

/// Source of the scripts up to and including `last`, which the page runs as one.
export const source = last => scripts.slice(0, scripts.indexOf(last) + 1).map(read).join('\n')

/// Values of `names` once the scripts up to and including `last` have run.
export const load = (last, ...names) => vm.runInThisContext(`(() => { ${source(last)}\nreturn { ${names.join(', ')} } })()`)

/// Node.js 18 has the stream, but not this format.
globalThis.DecompressionStream = class {
  constructor(format) {
    assert.equal(format, 'deflate-raw')
    return Duplex.toWeb(createInflateRaw())
  }
}

/// Random numbers from 0 to 1 that are the same each time. Source: Steele et al. 2014, SplitMix, as 32 bits.
export function random(seed) {
  return () => {
    seed = seed + 0x9e3779b9 | 0
    let z = seed
    z = Math.imul(z ^ z >>> 16, 0x21f0aaad)
    z = Math.imul(z ^ z >>> 15, 0x735a2d97)
    return ((z ^ z >>> 15) >>> 0) / 4294967296
  }
}

/// Columns of a block, as `readBlock` gives them: points at `places`, each seen from 1 m above, a second apart.
export function blockOf(places, more = {}) {
  const all = f => Float64Array.from(places, f)
  const columns = { x: all(p => p[0]), y: all(p => p[1]), z: all(p => p[2]), from_x: all(p => p[0]), from_y: all(p => p[1]),
                    from_z: all(p => p[2] + 1), time: all((_, i) => i), pulse: all((_, i) => i), key: all((_, i) => i) }
  return { count: places.length, columns: { ...columns, ...more }, steps: { x: 0.001 } }
}

export function near(found, expected, error, what = 'a value') {
  assert.ok(Math.abs(found - expected) <= error, `${what} is ${found}, not ${expected}`)
}
