// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Reading of blocks of points, in the format that `page_columns` documents.

import assert from 'node:assert/strict'
import test from 'node:test'
import vm from 'node:vm'
import { deflateRawSync } from 'node:zlib'

import { load, near, scripts, source } from './load.mjs'

const { bytesOfBase64, readBlock } = load('points.js', 'bytesOfBase64', 'readBlock')

/// Bytes of a block: the length of its head, its head, and deflated planes.
function block(count, columns, planes) {
  const head = new TextEncoder().encode(JSON.stringify({ count, columns })), packed = deflateRawSync(Uint8Array.from(planes.flat()))
  const bytes = new Uint8Array(4 + head.length + packed.length)
  new DataView(bytes.buffer).setUint32(0, head.length, true)
  bytes.set(head, 4)
  bytes.set(packed, 4 + head.length)
  return bytes
}

const column = (name, more) => ({ name, kind: 'linear', offset: 0, step: 1, differences: false, planes: 1, ...more })

test('the scripts of the page are one script, in strict mode', () => {
  assert.deepEqual(scripts, ['points.js', 'painters.js', 'view.js', 'attributes.js', 'marks.js', 'tools.js', 'panel.js'])
  const all = source('panel.js')
  new vm.Script(all)
  assert.throws(() => new vm.Script(`${all}\nwith ({}) ;`), /strict mode/i)
})

test('a code is a number of steps above the offset, in as many bytes as there are planes', async () => {
  const { count, columns, steps } = await readBlock(block(4, [column('z', { offset: 10, step: 0.5, planes: 2 })], [[1, 2, 2, 0], [0, 0, 1, 0]]))
  assert.equal(count, 4)
  assert.deepEqual([...columns.z], [10, 10.5, 138.5, NaN])
  assert.deepEqual(steps, { z: 0.5 })
})

test('six planes are more than 32 bits', async () => {
  const { columns } = await readBlock(block(1, [column('pulse', { planes: 6 })], [[2], [0], [0], [0], [0], [1]]))
  assert.equal(columns.pulse[0], 2 ** 40 + 1)
})

test('differences add up, their signs in the last bit', async () => {
  const codes = [1, 4, 2, 0, 3], differences = [2, 6, 3, 3, 6]
  const { columns } = await readBlock(block(5, [column('x', { differences: true })], [differences]))
  assert.deepEqual([...columns.x], codes.map(code => code > 0 ? code - 1 : NaN))
})

test('codes of a logarithm are factors, and those of a list its values', async () => {
  const { columns } = await readBlock(block(3, [column('amplitude', { kind: 'logarithmic', offset: 2e-6, step: 0.02 }),
    { name: 'object', kind: 'listed', values: [7, 4000000000], differences: false, planes: 1 }], [[1, 0, 101], [2, 1, 0]]))
  assert.equal(columns.amplitude[0], 2e-6)
  assert.ok(Number.isNaN(columns.amplitude[1]))
  near(columns.amplitude[2], 2e-6 * Math.exp(2), 1e-18)
  assert.deepEqual([...columns.object], [4000000000, 7, NaN])
})

test('what is to be added for each pulse is', async () => {
  const { columns } = await readBlock(block(3, [column('pulse'), column('time', { step: 0.25, per_pulse: 10 })], [[1, 2, 4], [1, 3, 0]]))
  assert.deepEqual([...columns.time], [0, 10.5, NaN])
})

test('a block without points has its columns, and no plane', async () => {
  const { count, columns } = await readBlock(block(0, [column('x', { planes: 0 })], []))
  assert.equal(count, 0)
  assert.equal(columns.x.length, 0)
})

test('a block is read from amid other bytes', async () => {
  const bytes = block(2, [column('x')], [[1, 3]]), more = new Uint8Array(bytes.length + 3)
  more.set(bytes, 3)
  assert.deepEqual([...(await readBlock(more.subarray(3))).columns.x], [0, 2])
})

test('a block that is cut or damaged is refused', async () => {
  const bytes = block(2000, [column('x')], [Array.from({ length: 2000 }, (_, i) => i * i % 251)])
  await assert.rejects(readBlock(bytes.subarray(0, bytes.length - 9)))
  bytes[4] = 0x78  // in place of the brace
  await assert.rejects(readBlock(bytes), SyntaxError)
})

test('base64 is that of its standard', () => {  // source: RFC 4648, section 10
  const texts = ['', 'f', 'fo', 'foo', 'foob', 'fooba', 'foobar'], coded = ['', 'Zg==', 'Zm8=', 'Zm9v', 'Zm9vYg==', 'Zm9vYmE=', 'Zm9vYmFy']
  assert.deepEqual(coded.map(text => new TextDecoder().decode(bytesOfBase64(text))), texts)
  const all = Uint8Array.from({ length: 256 }, (_, i) => i)
  assert.deepEqual(bytesOfBase64(Buffer.from(all).toString('base64')), all)
})
