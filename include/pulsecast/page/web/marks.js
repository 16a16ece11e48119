// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// ----------------------------------------------------------------------------------------------- the marks in the view

/// Position of a leg's instrument at a time.
function placeAt(way, time) {
  const { times, places } = way
  let k = 0
  while (k + 2 < times.length && times[k + 1] <= time) ++k
  if (places.length === 1) return places[0]
  const t = Math.max(0, Math.min(1, (time - times[k]) / Math.max(times[k + 1] - times[k], 1e-12)))
  return places[k].map((v, j) => v + t * (places[k + 1][j] - v))
}

function drawMarks() {
  const { camera, ratio } = view, marks = byId('marks')
  const c = view.painter.context ?? marks.getContext('2d')  // canvas of the painter without WebGL, else a canvas on top
  if (c.canvas === marks) {
    if (marks.width !== camera.width || marks.height !== camera.height) marks.width = camera.width, marks.height = camera.height
    c.clearRect(0, 0, marks.width, marks.height)
  }
  if (!view.origin) return
  c.font = `${12 * ratio}px system-ui, sans-serif`
  c.lineJoin = 'round'
  const { ink, paper } = theme
  const label = (text, x, y) => {
    c.lineWidth = 3 * ratio
    c.strokeStyle = paper
    c.strokeText(text, x, y)
    c.fillStyle = ink
    c.fillText(text, x, y)
  }
  if (view.now < Infinity) drawInstrument(c)
  if (state.selected >= 0) drawSelected(c)
  drawScaleBar(c, label, ink)
  const taken = [[0, camera.height - 90 * ratio, 180 * ratio, 90 * ratio], ...drawMeasured(c, label)]  // scale bar and distance
  drawSetUps(c, label, taken)
}

/// Position in the picture and depth of a place in the world.
const inPicture = place => view.camera.project(view.relative(place))

/// Places in the picture of an even sample of the points, `each` of a chunk [px].
function sampled(each = Math.max(64, Math.ceil(2000 / points.chunks.length))) {
  const { x, y, z, time } = points.arrays, places = []
  for (const { first, count } of points.chunks)
    for (const k of points.pack.subarray(0, each)) {
      const i = first + k
      if (!(k < count && time[i] <= view.start + view.now) || view.hides(i)) continue
      const place = [x[i], y[i], z[i]]
      if (view.inSlab(place)) places.push(inPicture(place))
    }
  return places
}

/// Box of a text beside a mark: at its right, left, top or bottom. [left, top, width, height]
function boxBeside(x, y, width, side) {
  const { ratio } = view, gap = 9 * ratio, height = 16 * ratio
  const left = [x + gap, x - gap - width, x - width / 2, x - width / 2][side]
  return [left, y + [-height / 2, -height / 2, -gap - height, gap][side], width, height]
}

const overlap = ([x, y, w, h], [left, top, width, height]) => x < left + width && left < x + w && y < top + height && top < y + h

/// The set-ups until now, each in its colour. Names stand where they cover no other mark or name and least points; while the view moves, they
/// stay at their side. A name without a place is left out.
function drawSetUps(c, label, taken) {
  const { camera, ratio } = view, until = view.start + view.now, s = 6 * ratio
  const marks = []
  view.ways.forEach((way, leg) => {
    if (way.places.length > 1 || way.times[0] > until) return
    const [x, y, depth] = inPicture(way.places[0])
    if (depth < camera.near) return
    marks.push({ way, x, y })
    taken.push([x - s, y - s, 2 * s, 2 * s])
    c.beginPath()
    c.moveTo(x, y - s), c.lineTo(x + s, y), c.lineTo(x, y + s), c.lineTo(x - s, y), c.closePath()
    c.fillStyle = colouring.name === 'leg' ? `rgb(${attributes.leg.colour(leg)})` : theme.accent
    c.fill()
    c.lineWidth = 1.5 * ratio
    c.strokeStyle = theme.paper
    c.stroke()
  })
  if (marks.length > 60) return
  const places = view.wasMoving ? [] : sampled()
  for (const { way, x, y } of marks) {
    const boxes = [0, 1, 2, 3].map(side => boxBeside(x, y, c.measureText(way.name).width, side))
    const free = box => box[0] >= 0 && box[1] >= 0 && box[0] + box[2] <= camera.width && box[1] + box[3] <= camera.height &&
      !taken.some(other => overlap(box, other))
    const cost = (box, side) => places.filter(([px, py]) => overlap(box, [px, py, 0, 0])).length - (side === way.side ? 3 : 0)
    if (!view.wasMoving || way.side === undefined) {
      const [best] = boxes.map((box, side) => ({ side, free: free(box), cost: cost(box, side) })).filter(b => b.free).sort((a, b) => a.cost - b.cost)
      way.side = best?.side ?? -1
    }
    if (way.side < 0 || !free(boxes[way.side])) continue
    const [left, top, , height] = boxes[way.side]
    taken.push(boxes[way.side])
    label(way.name, left, top + 0.75 * height)
  }
}

/// The instrument at this moment.
function drawInstrument(c) {
  const { camera, ratio } = view, until = view.start + view.now
  const way = view.ways.findLast(w => w.times[0] <= until)
  if (!way || way.places.length < 2) return
  const [x, y, depth] = inPicture(placeAt(way, until))
  if (depth <= camera.near) return
  c.beginPath(), c.arc(x, y, 6 * ratio, 0, 7), c.fillStyle = theme.accent, c.fill()
  c.lineWidth = 2 * ratio, c.strokeStyle = theme.paper, c.stroke()
}

/// The selected point and its beam.
function drawSelected(c) {
  const { camera, ratio } = view
  const { x, y, z, to_x, to_y, to_z } = points.arrays, i = state.selected
  const [px, py, depth] = inPicture([x[i], y[i], z[i]]), [ix, iy, away] = inPicture([x[i] + to_x[i], y[i] + to_y[i], z[i] + to_z[i]])
  if (depth <= camera.near) return
  c.strokeStyle = theme.accent
  if (away > camera.near) {
    c.lineWidth = 1.5 * ratio, c.globalAlpha = 0.7
    c.beginPath(), c.moveTo(ix, iy), c.lineTo(px, py), c.stroke()
    c.globalAlpha = 1
  }
  for (const [colour, width] of [[theme.paper, 5], [theme.accent, 2.5]]) {
    c.lineWidth = width * ratio, c.strokeStyle = colour
    c.beginPath(), c.arc(px, py, 9 * ratio, 0, 7), c.stroke()
  }
}

/// The line between the places that are measured, with its length. Returns the boxes that it takes.
function drawMeasured(c, label) {
  const { camera, ratio } = view, ends = (state.measured ?? []).map(inPicture)
  if (ends.some(([, , depth]) => depth <= camera.near)) return []
  const boxes = ends.map(([x, y]) => [x - 6 * ratio, y - 6 * ratio, 12 * ratio, 12 * ratio])
  for (const [colour, width] of [[theme.paper, 4], [theme.fresh, 2]]) {
    c.lineWidth = width * ratio, c.strokeStyle = colour
    c.beginPath()
    ends.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y))
    c.stroke()
    for (const [x, y] of ends) c.beginPath(), c.arc(x, y, 5 * ratio, 0, 7), c.stroke()
  }
  if (ends.length < 2) return boxes
  const text = written('range', distances().length), width = c.measureText(text).width
  const [x, y] = [0, 1].map(k => (ends[0][k] + ends[1][k]) / 2)
  const flat = Math.abs(ends[1][0] - ends[0][0]) > 2 * Math.abs(ends[1][1] - ends[0][1]), box = boxBeside(x, y, width, flat ? 2 : 0)
  label(text, box[0], box[1] + 0.75 * box[3])
  return [...boxes, box]
}

/// Scale bar for the target's depth, and north arrow.
function drawScaleBar(c, label, ink) {
  const { camera, ratio } = view, metre = camera.scale / camera.distance, room = 140 * ratio / metre
  const power = 10 ** Math.floor(Math.log10(room)), length = [5, 2, 1].find(n => n * power <= room) * power
  const left = 20 * ratio, y = camera.height - 20 * ratio, width = length * metre
  c.strokeStyle = c.fillStyle = ink
  c.lineWidth = 1.5 * ratio
  c.beginPath(), c.moveTo(left, y - 5 * ratio), c.lineTo(left, y)
  c.lineTo(left + width, y), c.lineTo(left + width, y - 5 * ratio), c.stroke()
  label(length >= 1000 ? `${length / 1000} km` : length >= 1 ? `${length} m` : length >= 0.01 ? `${Math.round(length * 100)} cm`
        : `${+(length * 1000).toPrecision(1)} mm`, left + 6 * ratio, y - 7 * ratio)
  const [r, u, f] = camera.axes(), x0 = left + 24 * ratio, y0 = y - 48 * ratio, s = 17 * ratio
  const [nx, ny] = [r[1] * s, -u[1] * s]
  c.lineWidth = 2 * ratio
  c.strokeStyle = theme.accent
  c.beginPath(), c.moveTo(x0 - nx * 0.6, y0 - ny * 0.6), c.lineTo(x0 + nx, y0 + ny), c.stroke()
  label('N', x0 + nx * 1.45 - 4 * ratio, y0 + ny * 1.45 + 4 * ratio)
}
