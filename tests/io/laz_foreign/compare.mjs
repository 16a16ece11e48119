// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Has a program write LAS and LAZ files in pairs, reads every .laz file with laz-perf and with copc, and compares all of it with the .las
// file beside it: headers, extra bytes, and every byte of every point; the latter with laz-rs, too, if @loaders.gl/las brings it. Usage: node compare.mjs NODE_MODULES PROGRAM, where NODE_MODULES is the folder with the modules, and
// `PROGRAM FOLDER` writes the files. With PULSECAST_LAZ_POINTS=10000000 it does so for a large file.

import { execFileSync } from 'node:child_process'
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'
import { pathToFileURL } from 'node:url'

const [modules, program] = process.argv.slice(2)
const require = createRequire(join(resolve(modules), 'any.js'))
const { createLazPerf } = require('laz-perf')
const { Las } = require('copc')
const LazPerf = await createLazPerf()
const lazRs = join(resolve(modules), '@loaders.gl/las/dist/libs/laz-rs-wasm/laz_rs_wasm.js')
const { default: start, WasmLasZipDecompressor } = existsSync(lazRs) ? await import(pathToFileURL(lazRs)) : {}
if (start) await start({ module_or_path: readFileSync(lazRs.replace(/\.js$/, '_bg.wasm')) })
const folder = mkdtempSync(join(tmpdir(), 'pulsecast_laz_'))

function expect(condition, what) {
  if (!condition) throw new Error(what)
}

function expectSamePoints(found, expected, record, what) {
  expect(found.length === expected.length, `${what}: ${found.length / record} points, not ${expected.length / record}`)
  if (Buffer.compare(found, expected) === 0) return
  let at = 0
  while (found[at] === expected[at]) ++at
  expect(false, `${what}: point ${Math.floor(at / record)}, byte ${at % record} is ${found[at]}, not ${expected[at]}`)
}

/// What point formats 6, 7 and 8 have behind time: nothing, a colour, a colour and the near infrared.
const format = (laz) => laz[104] & 63
const layersOfColour = (laz) => format(laz) - 6
const bytesWithoutExtras = (laz) => [30, 36, 38][format(laz) - 6]

/// The chunks of the file, one after another: what a chunk holds says how long it is.
function* chunksOf(laz, header) {
  const layers = 9 + layersOfColour(laz) + header.pointDataRecordLength - bytesWithoutExtras(laz)
  const table = Number(laz.readBigInt64LE(header.pointDataOffset))
  let at = header.pointDataOffset + 8
  for (; at < table; ) {
    const sizes = at + header.pointDataRecordLength + 4
    let end = sizes + 4 * layers
    for (let i = 0; i < layers; ++i) end += laz.readUInt32LE(sizes + 4 * i)
    yield { points: laz.readUInt32LE(sizes - 4), bytes: laz.subarray(at, end) }
    at = end
  }
  expect(at === table, 'chunks end before or behind the chunk table')
}

/// Decodes a chunk with laz-perf into `points`, from byte `to` on.
function decode({ points, bytes }, header, into, to) {
  const from = LazPerf._malloc(bytes.length), point = LazPerf._malloc(header.pointDataRecordLength)
  LazPerf.HEAPU8.set(bytes, from)
  const decoder = new LazPerf.ChunkDecoder()
  decoder.open(header.pointDataRecordFormat, header.pointDataRecordLength, from)
  for (let i = 0; i < points; ++i, to += header.pointDataRecordLength) {
    decoder.getPoint(point)
    into.set(LazPerf.HEAPU8.subarray(point, point + header.pointDataRecordLength), to)
  }
  decoder.delete()
  LazPerf._free(point)
  LazPerf._free(from)
  return to
}

/// Decodes a file with laz-rs.
function decodedByLazRs(laz, count, record) {
  const decoder = new WasmLasZipDecompressor(laz), points = Buffer.alloc(count * record), point = new Uint8Array(record)
  for (let i = 0; i < count; ++i) {
    decoder.decompress_many(point)
    points.set(point, i * record)
  }
  decoder.free()
  return points
}

async function compare(name) {
  try {
    await comparePair(name)
  } catch (error) {
    throw new Error(`${name} (${statSync(join(folder, name)).size} bytes): ${error.message ?? error}`)
  }
}

async function comparePair(name) {
  const path = join(folder, name), las = readFileSync(path.replace(/z$/, 's')), laz = readFileSync(path)
  const header = Las.Header.parse(las), other = Las.Header.parse(laz), record = header.pointDataRecordLength
  const expectedFormat = name.startsWith('colours') ? 7 : name.startsWith('near_infrared') || name.includes('colours') ? 8 : 6
  expect(laz[104] === (expectedFormat | 128) && las[104] === expectedFormat, 'point format')
  for (const key of Object.keys(header))
    if (key !== 'vlrCount' && key !== 'pointDataOffset')
      expect(JSON.stringify(header[key]) === JSON.stringify(other[key]), `${key} is ${other[key]}, not ${header[key]}`)

  const vlrs = await Las.Vlr.walk(path, other), expectedVlrs = await Las.Vlr.walk(path.replace(/z$/, 's'), header)
  expect(vlrs.length === expectedVlrs.length + 1 && Las.Vlr.find(vlrs, 'laszip encoded', 22204), 'records of variable length')
  const extras = Las.ExtraBytes.parse(await Las.Vlr.fetch(path, Las.Vlr.at(vlrs, 'LASF_Spec', 4)))
  const attributes = name === 'survey_colours.laz' ? 2 : 0
  expect(extras.length === 6 + attributes && extras.reduce((sum, extra) => sum + extra.length, bytesWithoutExtras(laz)) === record,
         'extra bytes')

  const points = las.subarray(header.pointDataOffset)
  const decoded = Buffer.alloc(points.length)
  let to = 0
  const counts = []
  for (const chunk of chunksOf(laz, other)) {
    counts.push(chunk.points)
    const decodedByCopc = await Las.PointData.decompressChunk(chunk.bytes, { ...other, pointCount: chunk.points }, LazPerf)
    expectSamePoints(Buffer.from(decodedByCopc), points.subarray(to, to + chunk.points * record), record, 'copc')
    to = decode(chunk, other, decoded, to)
  }
  expect(to === points.length, 'number of points')
  expect(counts.slice(0, -1).every((count) => count === 50000), 'all chunks but the last have 50,000 points')
  expectSamePoints(decoded, points, record, 'laz-perf, chunk by chunk')

  if (laz.length < 1e8) {  // a file as a whole is read by its chunk table; the reader's memory is limited
    const whole = Buffer.from(await Las.PointData.decompressFile(laz, LazPerf))
    expectSamePoints(whole, points, record, 'copc, the file as a whole')
    const view = Las.View.create(whole, other, extras), expectedView = Las.View.create(points, header, extras)
    // which decodes extra bytes of several scanner channels otherwise than LASzip's item version 3
    const channels = new Set(Array.from({ length: view.pointCount }, (_, i) => points[i * record + 15] & 48))
    if (start && channels.size === 1)
      expectSamePoints(decodedByLazRs(laz, view.pointCount, record), points, record, 'laz-rs')
    const names = Object.keys(view.dimensions)
    expect(names.includes('Reflectance') && names.includes('ScannerChannel') && names.length >= 20, `dimensions: ${names}`)
    if (name.startsWith('survey'))
      for (const dimension of names) {
        const get = view.getter(dimension), getExpected = expectedView.getter(dimension)
        for (let i = 0; i < view.pointCount; ++i)
          expect(Object.is(get(i), getExpected(i)), `copc: point ${i}, ${dimension} is ${get(i)}, not ${getExpected(i)}`)
      }
  }
  const size = (laz.length / Math.max(header.pointCount, 1)).toFixed(2)
  console.log(`${name}: ${header.pointCount} points in ${counts.length} chunks, ${size} bytes a point`)
}

try {
  execFileSync(program, [folder], { stdio: 'inherit' })
  const names = readdirSync(folder).filter((name) => name.endsWith('.laz')).sort()
  expect(names.length > 0, 'there is no file to compare')
  for (const name of names) await compare(name)
} catch (error) {
  console.error(error instanceof Error ? error.message : error)
  process.exitCode = 1
} finally {
  rmSync(folder, { recursive: true })
}
