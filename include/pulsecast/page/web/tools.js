// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// ---------------------------------------------------------------------------------- distances, slices and pictures

/// Lengths between the two places that are measured [m]; the height is of the second above the first.
function distances() {
  const [dx, dy, dz] = state.measured[1].map((v, k) => v - state.measured[0][k])
  return { length: Math.hypot(dx, dy, dz), level: Math.hypot(dx, dy), height: dz }
}

/// Begins or ends measuring.
function measure(on = !state.measured) {
  state.measured = on ? [] : null
  byId('measure').setAttribute('aria-pressed', String(on))
  byId('distance').hidden = !on
  byId('hint').hidden = on || state.selected >= 0
  showDistance()
}

function showDistance() {
  const count = state.measured?.length
  byId('next').textContent = ['Click the first point.', 'Click the second point.', 'A click begins anew.'][count] ?? ''
  byId('lengths').replaceChildren()
  if (count === 2) {
    const { length, level, height } = distances()
    for (const [name, value] of [['Distance', length], ['Level', level], ['Height', height]])
      byId('lengths').append(element('dt', '', name), element('dd', '', written('range', value)))
  }
  view.redraw()
}

/// Reads the point at a pixel, or measures from or to it.
function clickAt(x, y) {
  const i = view.pick(x, y)
  if (!state.measured) return select(i)
  if (i < 0) return
  if (state.measured.length === 2) state.measured = []
  state.measured.push(['x', 'y', 'z'].map(name => points.arrays[name][i]))
  showDistance()
}

/// Unit normal of the slice: up, or level towards its azimuth.
function normalOfSlice() {
  const azimuth = Number(byId('azimuth').value) * Math.PI / 180
  return byId('cut').value === 'level' ? [0, 0, 1] : [Math.sin(azimuth), Math.cos(azimuth), 0]
}

/// Applies what the controls say of the slice. Its position goes through all but outliers, its thickness from a thousandth of that to all.
function takeSlice() {
  const kind = byId('cut').value, normal = normalOfSlice()
  byId('slab').hidden = kind === 'none'
  byId('turned').hidden = kind === 'level'
  view.slab = { plane: [0, 0, 0, 0], reach: 1 }
  if (kind !== 'none' && view.origin) {
    const { extent } = state, middle = extent.map(([least, most], k) => (least + most) / 2 - view.origin[k])
    const half = Math.max(vectorDot(normal.map(Math.abs), extent.map(([least, most]) => (most - least) / 2)), 1e-3)
    const along = (Number(byId('place').value) / 500 - 1) * half, reach = half * 10 ** (Number(byId('thickness').value) * 0.003 - 3)
    view.slab = { plane: [...normal, vectorDot(normal, middle) + along], reach }
    byId('place_text').textContent = brief('z', kind === 'level' ? view.slab.plane[3] + view.origin[2] : along)
    byId('thickness_text').textContent = brief('z', 2 * reach)
    byId('azimuth_text').textContent = `${byId('azimuth').value}°`
  }
  view.redraw(true)
}

/// Begins a slice: upright, it faces the viewer.
function beginSlice() {
  state.extent = ['x', 'y', 'z'].map(name => points.usual(name, 0.001))
  byId('azimuth').value = String((Math.round(view.camera.azimuth * 180 / Math.PI) % 180 + 180) % 180)
  takeSlice()
}

/// Looks along the normal of the slice.
function faceSlice() {
  if (byId('cut').value === 'level') seenFromAbove()
  else Object.assign(view.camera, { azimuth: Number(byId('azimuth').value) * Math.PI / 180, elevation: 0 })
  touch()
}

/// Draws the legend of the colours at the top left of a saved picture.
function drawLegend(c, ratio) {
  const { attribute } = colouring, left = 16 * ratio, step = 18 * ratio
  const text = (words, x, y) => { c.strokeText(words, x, y), c.fillText(words, x, y) }
  let y = 24 * ratio
  Object.assign(c, { font: `${12 * ratio}px system-ui, sans-serif`, lineJoin: 'round', lineWidth: 3 * ratio, strokeStyle: theme.paper })
  c.fillStyle = theme.ink
  text(attribute.label, left, y)
  if (attribute.direct) return
  if (attribute.list) {
    for (const [value] of colouring.kinds.filter(([value]) => !colouring.hidden.has(value)).slice(0, 16)) {
      y += step
      c.fillStyle = `rgb(${attribute.colour(value)})`
      c.fillRect(left, y - 10 * ratio, 10 * ratio, 10 * ratio)
      c.fillStyle = theme.ink
      text(attribute.name(value), left + 16 * ratio, y)
    }
    return
  }
  const scale = survey.colours[attribute.scale ?? 'viridis'], wide = 160 * ratio
  scale.forEach((colour, i) => {
    c.fillStyle = `rgb(${colour})`
    c.fillRect(left + i * wide / 256, y + 7 * ratio, wide / 256 + 1, 8 * ratio)
  })
  c.fillStyle = theme.ink
  const [low, high] = (colouring.shown ?? colouring.ends).map(v => brief(colouring.name, colouring.unplotted(v)))
  text(low, left, y + 30 * ratio)
  text(high, left + wide - c.measureText(high).width, y + 30 * ratio)
}

/// Saves the picture with its marks and legend, at a multiple of the resolution of the screen.
function savePicture(scale) {
  const sheet = document.createElement('canvas'), c = sheet.getContext('2d')
  view.picture(scale, () => {
    sheet.width = view.canvas.width, sheet.height = view.canvas.height
    c.drawImage(view.canvas, 0, 0)
    if (!view.painter.context) c.drawImage(byId('marks'), 0, 0)
    drawLegend(c, view.ratio)
  })
  sheet.toBlob(file => {
    const link = element('a')
    link.href = URL.createObjectURL(file)
    link.download = `${survey.name.replace(/[^\p{L}\p{N}]+/gu, '_') || 'points'}.png`
    link.click()
    setTimeout(() => URL.revokeObjectURL(link.href), 10000)
  })
}

function takeTools() {
  byId('measure').onclick = () => measure()
  byId('done').onclick = () => measure(false)
  byId('cut').onchange = beginSlice
  for (const name of ['place', 'thickness', 'azimuth']) byId(name).oninput = takeSlice
  byId('face').onclick = faceSlice
  byId('screen').onclick = () => savePicture(1)
  byId('double').onclick = () => savePicture(2)
}
