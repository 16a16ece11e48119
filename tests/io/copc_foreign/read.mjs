// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Has a program write LAS and COPC files in pairs, reads every level and every node of each .copc.laz file with copc, and compares all of
// it with the .las file beside it. Usage: node read.mjs NODE_MODULES PROGRAM, where NODE_MODULES is the folder with laz-perf and copc, and
// `PROGRAM FOLDER` writes the files.

import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'

const [modules, program] = process.argv.slice(2)
const require = createRequire(join(resolve(modules), 'any.js'))
const { createLazPerf } = require('laz-perf')
const { Copc, Key, Las } = require('copc')
const lazPerf = await createLazPerf()
const folder = mkdtempSync(join(tmpdir(), 'pulsecast_copc_'))

function expect(condition, what) {
  if (!condition) throw new Error(what)
}

/// The records of a buffer, in an order of their bytes.
function sorted(points, record) {
  const all = []
  for (let at = 0; at < points.length; at += record) all.push(points.subarray(at, at + record))
  return all.sort(Buffer.compare)
}

function expectSame(found, expected, record, what) {
  expect(found.length === expected.length, `${what}: ${found.length / record} points, not ${expected.length / record}`)
  const a = sorted(found, record), b = sorted(expected, record)
  a.forEach((point, i) => expect(point.equals(b[i]), `${what}: a point is not as in the LAS file`))
}

/// All nodes of all pages, by key.
async function nodesOf(path, page) {
  const { nodes, pages } = await Copc.loadHierarchyPage(path, page)
  let all = { ...nodes }, count = 1
  for (const below of Object.values(pages)) {
    const more = await nodesOf(path, below)
    all = { ...all, ...more.nodes }
    count += more.pages
  }
  return { nodes: all, pages: count }
}

function expectWithin(view, key, { cube }, what) {
  const [level, ...place] = Key.create(key)
  const side = (cube[3] - cube[0]) / 2 ** level
  ;['X', 'Y', 'Z'].forEach((name, axis) => {
    const get = view.getter(name), low = cube[axis] + place[axis] * side
    for (let i = 0; i < view.pointCount; ++i)
      expect(get(i) >= low && get(i) < low + side, `${what}: point ${i}, ${name} ${get(i)} is not from ${low} to ${low + side}`)
  })
}

async function compare(name) {
  const path = join(folder, name), lasPath = path.replace('.copc.laz', '.las')
  const las = readFileSync(lasPath), header = Las.Header.parse(las), record = header.pointDataRecordLength
  const points = las.subarray(header.pointDataOffset)
  const copc = await Copc.create(path)
  const own = ['pointDataOffset', 'vlrCount', 'evlrOffset', 'evlrCount']
  for (const key of Object.keys(header))
    if (!own.includes(key))
      expect(JSON.stringify(header[key]) === JSON.stringify(copc.header[key]), `${key} is ${copc.header[key]}, not ${header[key]}`)
  const vlrs = await Las.Vlr.walk(lasPath, header)
  const extras = Las.ExtraBytes.parse(await Las.Vlr.fetch(lasPath, Las.Vlr.at(vlrs, 'LASF_Spec', 4)))
  expect(JSON.stringify(copc.eb) === JSON.stringify(extras), 'extra bytes')
  expect(name.startsWith('usual') === (copc.wkt?.includes('ETRS89 / UTM zone 32N') ?? false), 'reference system')

  const { nodes, pages } = await nodesOf(path, copc.info.rootHierarchyPage)
  const found = [], levels = new Map()
  let first = Infinity, last = -Infinity, names = []
  for (const [key, node] of Object.entries(nodes)) {
    const level = Key.create(key)[0]
    levels.set(level, (levels.get(level) ?? 0) + node.pointCount)
    if (node.pointCount === 0) continue
    found.push(Buffer.from(await Copc.loadPointDataBuffer(path, copc.header, node, lazPerf)))
    const view = Las.View.create(found.at(-1), copc.header, copc.eb)
    names = Object.keys(view.dimensions)
    expect(view.pointCount === node.pointCount, `${key}: number of points`)
    expectWithin(view, key, copc.info, key)
    const time = view.getter('GpsTime')
    for (let i = 0; i < view.pointCount; ++i) {
      first = Math.min(first, time(i))
      last = Math.max(last, time(i))
    }
  }
  expectSame(Buffer.concat(found), points, record, 'all nodes')
  if (header.pointCount > 0) {
    expect(copc.info.gpsTimeRange[0] === first && copc.info.gpsTimeRange[1] === last, 'range of times')
    expectSame(Buffer.from(await Las.PointData.decompressFile(readFileSync(path), lazPerf)), points, record, 'the file as a whole')
  }
  if (name.startsWith('pages')) expect(pages > 5 && levels.size > 3, `${pages} pages, ${levels.size} levels`)
  const has = (name) => names.includes(name)
  if (name.startsWith('colours')) expect(has('Red') && !has('Infrared') && has('age'), `dimensions: ${names}`)
  if (name.startsWith('near')) expect(has('Blue') && has('Infrared') && has('age'), `dimensions: ${names}`)
  const byLevel = [...levels].sort(([a], [b]) => a - b).map(([, count]) => count)
  console.log(`${name}: ${header.pointCount} points in ${Object.keys(nodes).length} nodes, ${pages} pages, by level ${byLevel}`)
}

try {
  execFileSync(program, [folder], { stdio: 'inherit' })
  const names = readdirSync(folder).filter((name) => name.endsWith('.copc.laz')).sort()
  expect(names.length > 0, 'there is no file to compare')
  for (const name of names) {
    try {
      await compare(name)
    } catch (error) {
      throw new Error(`${name}: ${error.stack ?? error}`)
    }
  }
} catch (error) {
  console.error(error instanceof Error ? error.message : error)
  process.exitCode = 1
} finally {
  rmSync(folder, { recursive: true })
}
