// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Reads the bag of examples/drive.cpp by @mcap/core, decodes it by the schemas in it, and writes what odometry needs for odometry.cpp:
// scans.bin, numbers of 64 bits: of each scan its stamp [s], number of points, and of each x, y, z [m], time since the stamp [s];
// imu.txt: time [s], angular rate [rad/s]; truth.txt: time [s], position [m], attitude x y z w of the lidar. Times are from the first clock.
// Usage: node unbag.mjs NODE_MODULES BAG FOLDER

import { readFileSync, writeFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { join, resolve } from 'node:path'

const [modules, bag, folder] = process.argv.slice(2)
const require = createRequire(join(resolve(modules), 'any.js'))
const { McapStreamReader } = require('@mcap/core')
const { parse } = require('@foxglove/rosmsg')
const { MessageReader } = require('@foxglove/rosmsg2-serialization')

const topics = new Map()
const messages = { '/points': [], '/imu/data': [], '/ground_truth/odom': [], '/tf_static': [] }
const schemas = new Map()
const stream = new McapStreamReader()
stream.append(readFileSync(bag))
for (let record; (record = stream.nextRecord()); ) {
  if (record.type === 'Schema') schemas.set(record.id, new TextDecoder().decode(record.data))
  if (record.type === 'Channel' && messages[record.topic])
    topics.set(record.id, { topic: record.topic, reader: new MessageReader(parse(schemas.get(record.schemaId), { ros2: true })) })
  if (record.type === 'Message' && topics.has(record.channelId)) {
    const { topic, reader } = topics.get(record.channelId)
    messages[topic].push(reader.readMessage(record.data))
  }
}

const first = messages['/ground_truth/odom'][0].header.stamp
const secondsOf = ({ sec, nanosec }) => sec - first.sec + ((nanosec - first.nanosec) / 1e9)
const lines = (rows) => rows.map((row) => row.join(' ') + '\n').join('')

writeFileSync(join(folder, 'imu.txt'), lines(messages['/imu/data'].map(({ header, angular_velocity: w }) =>
  [secondsOf(header.stamp), w.x, w.y, w.z])))

// the lidar's pose in the map: that of the robot, and the fixed frame on it
const { x, y, z } = messages['/tf_static'].at(-1).transforms.find(({ child_frame_id }) => child_frame_id === 'lidar').transform.translation
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
writeFileSync(join(folder, 'truth.txt'), lines(messages['/ground_truth/odom'].map(({ header, pose: { pose } }) => {
  const { position: p, orientation: q } = pose
  const swept = cross([q.x, q.y, q.z], [x, y, z]).map((part, k) => part + q.w * [x, y, z][k])
  const turned = cross([q.x, q.y, q.z], swept).map((part, k) => 2 * part + [x, y, z][k])
  return [secondsOf(header.stamp), p.x + turned[0], p.y + turned[1], p.z + turned[2], q.x, q.y, q.z, q.w]
})))

const numbers = []
for (const cloud of messages['/points']) {
  const at = Object.fromEntries(cloud.fields.map(({ name, offset }) => [name, offset]))
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength)
  numbers.push(secondsOf(cloud.header.stamp), cloud.width * cloud.height)
  for (let from = 0; from < cloud.data.length; from += cloud.point_step)
    for (const name of ['x', 'y', 'z', 'time']) numbers.push(view.getFloat32(from + at[name], true))
}
writeFileSync(join(folder, 'scans.bin'), new Uint8Array(Float64Array.from(numbers).buffer))
