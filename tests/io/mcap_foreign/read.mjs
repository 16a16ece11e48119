// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Has a program write MCAP files, reads each with both readers of @mcap/core, by its index and as a stream, and compares channels, schemas,
// statistics and every message with what the program tells of them. Decodes scans by the schema in the file, with @foxglove/rosmsg, and
// compares every number of every point. Usage: node read.mjs NODE_MODULES PROGRAM, where NODE_MODULES is the folder with the modules, and
// `PROGRAM FOLDER` writes the files.

import { deepStrictEqual, strictEqual } from 'node:assert'
import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'

const [modules, program] = process.argv.slice(2)
const require = createRequire(join(resolve(modules), 'any.js'))
const { McapIndexedReader, McapStreamReader } = require('@mcap/core')
const { parse } = require('@foxglove/rosmsg')
const { MessageReader } = require('@foxglove/rosmsg2-serialization')
const folder = mkdtempSync(join(tmpdir(), 'pulsecast_mcap_'))

const hexOf = (bytes) => Buffer.from(bytes).toString('hex')
const messageOf = ({ channelId, sequence, logTime, publishTime, data }) =>
  ({ channelId, sequence, logTime: String(logTime), publishTime: String(publishTime), data: hexOf(data) })
const channelOf = (channel, schema, messages) => ({
  topic: channel.topic,
  schemaName: schema?.name ?? '',
  schemaEncoding: schema?.encoding,
  schema: schema && hexOf(schema.data),
  messageEncoding: channel.messageEncoding,
  messages,
  metadata: Object.fromEntries(channel.metadata)
})

/// Channels as told; those without a schema tell nothing of it.
const withoutSchema = (channel) => (channel.schemaName === '' ? { ...channel, schemaEncoding: undefined, schema: undefined } : channel)

/// Number types by the values of sensor_msgs/PointField.
const getters = [, 'getInt8', 'getUint8', 'getInt16', 'getUint16', 'getInt32', 'getUint32', 'getFloat32', 'getFloat64']

function compareScan(message, reader, scan) {
  const cloud = reader.readMessage(Buffer.from(message.data, 'hex'))
  const { stamp, frame_id } = cloud.header
  deepStrictEqual([frame_id, String(BigInt(stamp.sec) * 1000000000n + BigInt(stamp.nsec ?? stamp.nanosec))], ['lidar', scan.stamp])
  deepStrictEqual([cloud.height, cloud.width, cloud.is_bigendian, cloud.is_dense], [1, scan.points.length, false, true])
  deepStrictEqual([cloud.point_step, cloud.row_step], [scan.step, scan.step * scan.points.length])
  deepStrictEqual(cloud.fields.map((field) => ({ ...field })), scan.fields)
  strictEqual(cloud.data.length, cloud.row_step)
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength)
  scan.points.forEach((point, i) => {
    const found = cloud.fields.map((field) => view[getters[field.datatype]](i * cloud.point_step + field.offset, true))
    found.forEach((number, k) => strictEqual(number, Number(point[k]), `point ${i}, ${cloud.fields[k].name}`))
  })
  return scan.points.length
}

async function readByIndex(bytes, channels, messages) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size)))
  }
  const reader = await McapIndexedReader.Initialize({ readable })
  strictEqual(reader.header.profile, 'ros2')
  strictEqual(reader.header.library.split(' ')[0], 'pulsecast')
  const { statistics, channelsById, schemasById, chunkIndexes } = reader
  strictEqual(channelsById.size, channels.length)
  channels.forEach((channel, id) => {
    const found = channelsById.get(id)
    deepStrictEqual(channelOf(found, schemasById.get(found.schemaId), Number(statistics.channelMessageCounts.get(id))), channel)
  })
  deepStrictEqual(
    { ...statistics, channelMessageCounts: undefined, type: undefined },
    {
      type: undefined,
      messageCount: BigInt(messages.length),
      schemaCount: new Set(channels.filter((c) => c.schemaName !== '').map((c) => `${c.schemaName} ${c.schema}`)).size,
      channelCount: channels.length,
      attachmentCount: 0,
      metadataCount: 0,
      chunkCount: chunkIndexes.length,
      messageStartTime: BigInt(messages.at(0)?.logTime ?? 0),
      messageEndTime: BigInt(messages.at(-1)?.logTime ?? 0),
      channelMessageCounts: undefined
    }
  )
  const compareRead = async (wanted, args) => {
    let i = 0
    for await (const message of reader.readMessages({ validateCrcs: true, ...args })) deepStrictEqual(messageOf(message), wanted[i++])
    strictEqual(i, wanted.length)
  }
  await compareRead(messages, {})
  if (messages.length === 0) return chunkIndexes.length
  const topics = [channels[0].topic], from = BigInt(messages[messages.length >> 2].logTime), to = BigInt(messages.at(-2).logTime)
  const inside = ({ logTime, channelId }) => channelId === 0 && BigInt(logTime) >= from && BigInt(logTime) <= to
  await compareRead(messages.filter(inside), { topics, startTime: from, endTime: to })
  return chunkIndexes.length
}

/// A stream has messages in the order of writing, in which the sequence of each channel is 0, 1, 2 and so on.
function readAsStream(bytes, channels, messages) {
  const reader = new McapStreamReader({ validateCrcs: true })
  const found = [], channelsById = new Map(), schemasById = new Map(), sequences = channels.map(() => 0)
  for (let at = 0; at < bytes.length; at += 1000) {
    reader.append(new Uint8Array(bytes.subarray(at, at + 1000)))
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type === 'Schema') schemasById.set(record.id, record)
      if (record.type === 'Channel') channelsById.set(record.id, record)
      if (record.type !== 'Message') continue
      strictEqual(record.sequence, sequences[record.channelId]++)
      found.push(messageOf(record))
    }
  }
  strictEqual(reader.done(), true)
  const byTime = (a, b) => (BigInt(a.logTime) < BigInt(b.logTime) ? -1 : Number(BigInt(a.logTime) > BigInt(b.logTime)))
  deepStrictEqual(found.sort(byTime), messages)
  strictEqual(channelsById.size, channels.length)
  channels.forEach((channel, id) => {
    const one = channelsById.get(id)
    deepStrictEqual(channelOf(one, schemasById.get(one.schemaId), sequences[id]), channel)
  })
}

async function compare(name) {
  const bytes = readFileSync(join(folder, name))
  const [first, ...rest] = readFileSync(join(folder, `${name}l`), 'utf8').trim().split('\n').map((line) => JSON.parse(line))
  const channels = first.map(withoutSchema), messages = rest.map(({ scan, ...message }) => message)
  const chunks = await readByIndex(bytes, channels, messages)
  readAsStream(bytes, channels, messages)
  let scans = 0, points = 0
  for (const { scan, ...message } of rest.filter((one) => one.scan !== null)) {
    const definition = Buffer.from(channels[message.channelId].schema, 'hex').toString()
    points += compareScan(message, new MessageReader(parse(definition, { ros2: true })), scan)
    ++scans
  }
  if (name.startsWith('scans')) strictEqual(scans > 3 && points > 1000, true, `${scans} scans, ${points} points`)
  console.log(`${name}: ${messages.length} messages in ${chunks} chunks, ${scans} scans of ${points} points`)
}

try {
  execFileSync(program, [folder], { stdio: 'inherit' })
  const names = readdirSync(folder).filter((name) => name.endsWith('.mcap')).sort()
  strictEqual(names.length, 7)
  for (const name of names)
    await compare(name).catch((error) => {
      throw new Error(`${name}: ${error.message}`)
    })
} catch (error) {
  console.error(error instanceof Error ? error.message : error)
  process.exitCode = 1
} finally {
  rmSync(folder, { recursive: true })
}
