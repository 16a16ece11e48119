// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// ------------------------------------------------------------------------------------------------------ the attributes

const survey = JSON.parse(byId('survey').textContent)
const points = new Points()

const classNames = { 0: 'Never classified', 1: 'Unassigned', 2: 'Ground', 3: 'Low vegetation', 4: 'Medium vegetation', 5: 'High vegetation',
                     6: 'Building', 7: 'Low noise', 9: 'Water', 10: 'Rail', 11: 'Road surface', 13: 'Wire, guard', 14: 'Wire, conductor',
                     15: 'Transmission tower', 17: 'Bridge deck', 18: 'High noise' }  // source: ASPRS LAS 1.4 R15, table 17

const kindNames = ['Direct', 'Through glass', 'From water', 'By a mirror', 'From the air', 'Scattered repeatedly']

const hexOf = v => `#${v.toString(16).padStart(6, '0')}`

/// Attributes of a point, in display order. Those with a `list` are categorical, one that is `direct` is a colour, the others numeric.
const attributes = {
  z: { label: 'Height', unit: 'm', main: true },
  amplitude: { label: 'Intensity', unit: 'W', logarithmic: true, main: true, scale: 'greys' },
  object: { label: 'Object', list: true, main: true, name: v => survey.objects[v] ?? String(v),
            colour: v => survey.colours.hues[Math.round(256 * ((0.3 + v * 0.6180339887) % 1)) % 256] },  // golden ratio, as in pictures
  colour: { label: 'Colour', direct: true, name: hexOf, colour: v => Number.isFinite(v) ? [v >> 16, v >> 8 & 255, v & 255] : [128, 128, 128] },
  class: { label: 'Class', list: true, main: true, colour: v => survey.colours.classes[v < 64 ? v : 64 + (v - 64) % 6],
           name: v => v in classNames ? `${v} ${classNames[v]}` : String(v) },
  return_number: { label: 'Return', list: true, main: true },
  returns: { label: 'Returns', list: true },
  reflectance: { label: 'Reflectance', unit: '' },
  range: { label: 'Range', unit: 'm' },
  incidence: { label: 'Incidence', unit: '°' },
  scan_angle: { label: 'Scan angle', unit: '°' },
  width: { label: 'Echo width', unit: 'ns' },
  time: { label: 'Time', unit: 's' },
  leg: { get label() { return survey.legs.length > 1 && survey.legs.every(leg => leg.places?.length === 1) ? 'Set-up' : 'Leg' }, list: true,
         name: v => survey.legs[v]?.name ?? String(v) },
  channel: { label: 'Channel', list: true },
  kind: { label: 'Light', list: true, colour: v => survey.colours.light[v], name: v => kindNames[v] ?? String(v) },
}
for (const attribute of Object.values(attributes)) {
  if (attribute.list) attribute.colour ??= v => survey.colours.kinds[(v + survey.colours.kinds.length - 1) % survey.colours.kinds.length]
  attribute.name ??= v => String(v)
}

const whole = n => Math.round(n).toLocaleString('en-US').replaceAll(',', '\u202f')

/// Power with unit, to three significant digits.
function power(value) {
  const [size, unit] = [[1, 'W'], [1e-3, 'mW'], [1e-6, 'µW'], [1e-9, 'nW']].find(([size]) => value >= 0.9995 * size) ?? [1e-12, 'pW']
  return `${Number((value / size).toPrecision(3))} ${unit}`
}

/// Value in its attribute's unit, with the decimals of its step.
function written(name, value) {
  const attribute = attributes[name] ?? {}
  if (!Number.isFinite(value)) return '–'
  if (attribute.list || attribute.direct) return attribute.name(value)
  if (attribute.unit === 'W') return power(value)
  const decimals = Math.max(0, Math.min(7, Math.ceil(-Math.log10(points.steps[name] ?? 1) - 1e-9)))
  return `${value.toFixed(decimals)}${attribute.unit === '°' ? '' : attribute.unit ? ' ' : ''}${attribute.unit ?? ''}`
}

/// Shorter text, for the ends of a scale.
function brief(name, value) {
  const { unit } = attributes[name]
  if (unit === 'W') return power(value)
  return `${Math.abs(value) >= 1e6 ? value.toPrecision(2) : Number(value.toPrecision(4))}${unit === '°' ? '' : ' '}${unit}`
}

/// All attributes of a point, as [label, text].
function description(i) {
  const value = name => points.arrays[name]?.[i]
  const rows = [['East', written('x', value('x')) + ' m'], ['North', written('y', value('y')) + ' m'], ['Height', written('z', value('z'))]]
  for (const name of ['range', 'amplitude', 'reflectance']) rows.push([attributes[name].label, written(name, value(name))])
  rows.push(['Return', `${value('return_number')} of ${value('returns')}`])
  rows.push(['Object', written('object', value('object'))], ['Class', written('class', value('class'))])
  if (points.arrays.colour) rows.push(['Colour', written('colour', value('colour'))])
  if (points.arrays.kind) rows.push(['Light', written('kind', value('kind'))])
  rows.push(['Time', written('time', value('time'))], ['Pulse', whole(value('pulse'))])
  for (const name of ['incidence', 'scan_angle', 'leg', 'channel']) rows.push([attributes[name].label, written(name, value(name))])
  if (points.arrays.width) rows.push(['Echo width', written('width', value('width'))])
  for (const [name, { label, further }] of Object.entries(attributes)) if (further) rows.push([label, written(name, value(name))])
  return rows
}

// ----------------------------------------------------------------------------------------- colours and the histogram

/// Attribute that colours the points, its histogram, and the values shown.
class Colouring {
  constructor(name = 'z') {
    this.hidden = new Set()  // categories
    this.shown = null        // [least, greatest] of a numeric attribute, as plotted
    this.take(name)
  }

  get attribute() { return attributes[this.name] }
  plotted(value) { return this.attribute.logarithmic ? Math.log10(value) : value }
  unplotted(value) { return this.attribute.logarithmic ? 10 ** value : value }

  take(name) {
    this.name = name
    this.hidden.clear()
    this.shown = null
    this.count()
  }

  /// Counts the values of all points.
  count() {
    const values = points.arrays[this.name], n = values ? points.count : 0
    if (this.attribute.direct) return
    if (this.attribute.list) {
      const counts = new Map()
      for (let i = 0; i < n; ++i) counts.set(values[i], (counts.get(values[i]) ?? 0) + 1)
      this.kinds = [...counts].sort((a, b) => b[1] - a[1])
      return
    }
    const ends = n > 0 ? points.usual(this.name).map(v => this.plotted(v)) : [0, 1]
    if (!(ends[1] - ends[0] > 1e-9 * Math.max(1, Math.abs(ends[1])))) ends[0] -= 0.5, ends[1] += 0.5
    this.ends = ends
    this.bins = new Uint32Array(90)
    const per = this.bins.length / (ends[1] - ends[0])
    for (let i = 0; i < n; ++i) {
      const bin = Math.floor((this.plotted(values[i]) - ends[0]) * per)
      if (bin >= 0 && bin < this.bins.length) ++this.bins[bin]
    }
  }

  /// First choice: the class where it differs and more than half of the heights are in one bar, as on a tripod that mostly sees the ground.
  static first() {
    const { bins } = new Colouring('z'), { kinds } = new Colouring('class')
    return kinds.length > 1 && 2 * Math.max(...bins) > points.count ? 'class' : 'z'
  }

  hides(value) {
    if (this.attribute.list) return this.hidden.has(value)
    if (!this.shown) return false
    const v = this.plotted(value)
    return !(v >= this.shown[0] && v <= this.shown[1])
  }

  /// Bytes of the colours of a chunk's points; hidden points are transparent.
  fill(chunk, order, out) {
    const values = points.arrays[this.name]
    if (this.attribute.direct) {
      for (let i = 0; i < chunk.count; ++i) {
        out.set(this.attribute.colour(values[chunk.first + order[i]]), 4 * i)
        out[4 * i + 3] = 255
      }
      return
    }
    if (this.attribute.list) {
      const colours = new Map()
      for (let i = 0; i < chunk.count; ++i) {
        const value = values[chunk.first + order[i]]
        let colour = colours.get(value)
        if (!colour) colours.set(value, colour = [...this.attribute.colour(value), this.hides(value) ? 0 : 255])
        out.set(colour, 4 * i)
      }
      return
    }
    const scale = survey.colours[this.attribute.scale ?? 'viridis'], [low, high] = this.shown ?? this.ends
    const table = new Uint8Array(1024)
    scale.forEach((colour, i) => table.set([...colour, 255], 4 * i))
    const per = 255 / (high - low), logarithmic = this.attribute.logarithmic, all = !this.shown
    for (let i = 0; i < chunk.count; ++i) {
      const value = values[chunk.first + order[i]], v = logarithmic ? Math.log10(value) : value
      const place = (v - low) * per, k = 4 * (place > 0 ? place < 255 ? place | 0 : 255 : 0), o = 4 * i
      out[o] = table[k], out[o + 1] = table[k + 1], out[o + 2] = table[k + 2]
      out[o + 3] = all || (v >= low && v <= high) ? 255 : 0
    }
  }

  /// Draws the histogram of a numeric attribute.
  draw(canvas, ink) {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight
    canvas.width = width * ratio, canvas.height = height * ratio
    const c = canvas.getContext('2d')
    c.scale(ratio, ratio)
    const scale = survey.colours[this.attribute.scale ?? 'viridis'], [low, high] = this.shown ?? this.ends
    const most = Math.max(1, ...this.bins), each = width / this.bins.length
    this.bins.forEach((n, i) => {
      const v = this.ends[0] + (i + 0.5) / this.bins.length * (this.ends[1] - this.ends[0]), t = (v - low) / (high - low)
      c.globalAlpha = t < 0 || t > 1 ? 0.25 : 1
      c.fillStyle = `rgb(${scale[Math.max(0, Math.min(255, Math.round(255 * t)))]})`
      const tall = n > 0 ? Math.max(1, (height - 8) * n / most) : 0
      c.fillRect(i * each, height - 6 - tall, each - 0.5, tall)
      c.fillRect(i * each, height - 4, each + 0.5, 4)  // colour scale
    })
    c.globalAlpha = 1
    if (!this.shown) return
    c.fillStyle = ink
    for (const end of this.shown) c.fillRect(Math.round((end - this.ends[0]) / (this.ends[1] - this.ends[0]) * (width - 2)), 0, 2, height)
  }
}
