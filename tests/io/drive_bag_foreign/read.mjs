// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Has a program write bags of drives, reads each with @mcap/core, decodes every message by the schema in the file with @foxglove/rosmsg and
// @foxglove/rosmsg2-serialization, and compares it, field by field, with what the program tells of it. Usage: node read.mjs NODE_MODULES
// PROGRAM, where NODE_MODULES is the folder with the modules, and `PROGRAM FOLDER SEED` writes a bag.

import { deepStrictEqual, strictEqual } from 'node:assert'
import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'

const [modules, program] = process.argv.slice(2)
const require = createRequire(join(resolve(modules), 'any.js'))
const { McapIndexedReader } = require('@mcap/core')
const { parse } = require('@foxglove/rosmsg')
const { MessageReader } = require('@foxglove/rosmsg2-serialization')
const folder = mkdtempSync(join(tmpdir(), 'pulsecast_drive_'))

/// Message as JSON has it: lists for typed arrays, words for numbers that are not finite or have 64 bits.
function plain(value) {
  if (typeof value === 'bigint') return String(value)
  if (typeof value === 'number') return Number.isFinite(value) ? value : String(value)
  if (Array.isArray(value) || ArrayBuffer.isView(value)) return Array.from(value, plain)
  if (value === null || typeof value !== 'object') return value
  const { nanosec, ...fields } = value
  const all = nanosec === undefined ? fields : { ...fields, nsec: nanosec }
  return Object.fromEntries(Object.entries(all).map(([name, field]) => [name, plain(field)]))
}

/// Numbers agree to rounding; all else is equal, with fields in the same order.
function compare(found, told, place) {
  if (typeof told === 'number' && typeof found === 'number')
    return strictEqual(Math.abs(found - told) <= 1e-14 * Math.max(1, Math.abs(told)), true, `${place}: ${found}, not ${told}`)
  if (told === null || typeof told !== 'object') return strictEqual(found, told, `${place}: ${found}, not ${told}`)
  deepStrictEqual(Object.keys(found), Object.keys(told), place)
  for (const name of Object.keys(told)) compare(found[name], told[name], `${place}.${name}`)
}

async function read(seed) {
  execFileSync(program, [folder, String(seed)], { stdio: 'inherit' })
  const bytes = readFileSync(join(folder, 'drive.mcap'))
  const told = readFileSync(join(folder, 'drive.jsonl'), 'utf8').trim().split('\n').map((line) => JSON.parse(line))
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size)))
  }
  const reader = await McapIndexedReader.Initialize({ readable })
  strictEqual(reader.statistics.metadataCount, 1)
  deepStrictEqual(reader.metadataIndexes.map(({ name }) => name), ['rosbag2'])
  for await (const record of reader.readMetadata()) deepStrictEqual([record.name, record.metadata.size], ['rosbag2', 0])
  const decoders = new Map(), topics = new Map()
  for (const [id, { topic, schemaId, metadata, messageEncoding }] of reader.channelsById) {
    const { name, encoding, data } = reader.schemasById.get(schemaId)
    deepStrictEqual([encoding, messageEncoding, name.split('/')[1]], ['ros2msg', 'cdr', 'msg'])
    const latched = /^- history: 1\n[^]*\n  durability: 1\n/.test(metadata.get('offered_qos_profiles'))
    strictEqual(latched, topic === '/tf_static')
    decoders.set(id, new MessageReader(parse(new TextDecoder().decode(data), { ros2: true })))
    topics.set(id, topic)
  }
  let i = 0, last = 0n
  const types = new Set()
  for await (const { channelId, logTime, publishTime, data } of reader.readMessages({ validateCrcs: true })) {
    const expected = told[i], place = `seed ${seed}, message ${i}, ${expected?.topic}`
    deepStrictEqual([topics.get(channelId), String(logTime), String(publishTime)], [expected.topic, expected.logTime, expected.publishTime], place)
    compare(plain(decoders.get(channelId).readMessage(data)), expected.message, place)
    strictEqual(logTime >= last, true)
    last = logTime
    types.add(expected.topic)
    ++i
  }
  strictEqual(i, told.length)
  return types
}

try {
  const types = new Set()
  for (let seed = 0; seed < 20; ++seed) for (const type of await read(seed)) types.add(type)
  deepStrictEqual([...types].sort(), ['/clock', '/depth/image', '/ground_truth/odom', '/imu/data', '/livox/lidar', '/scan', '/tf', '/tf_static'])
  console.log('20 bags: all messages as told')
} catch (error) {
  console.error(error instanceof Error ? error.message : error)
  process.exitCode = 1
} finally {
  rmSync(folder, { recursive: true })
}
