// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// ----------------------------------------------------------------------------------------------------------- the panel

const element = (tag, className, text) => {
  const made = document.createElement(tag)
  if (className) made.className = className
  if (text !== undefined) made.textContent = text
  return made
}
const rgb = colour => colour.match(/[\da-f]{2}/gi).map(v => parseInt(v, 16) / 255)
const theme = {}

const state = { view: null, selected: -1, measured: null, extent: null, playing: false, live: survey.live, touched: false, chosen: false, begin: 0,
                end: 1 }
const colouring = new Colouring()
let view

/// Colours of the style sheet, light or dark.
function takeTheme() {
  const style = getComputedStyle(document.documentElement)
  for (const name of ['paper', 'ink', 'quiet', 'accent', 'sky', 'ground', 'way', 'fresh'])
    theme[name] = style.getPropertyValue('--' + name).trim()
  view.sky = [rgb(theme.sky), rgb(theme.ground)]
  view.wayColour = rgb(theme.way)
  view.freshColour = rgb(theme.fresh)
  view.redraw()
  showHistogram()
}

function showTitle() {
  document.title = survey.name ? `${survey.name} – pulsecast` : 'pulsecast'
  byId('name').textContent = survey.name || 'Point cloud'
  byId('device').textContent = [survey.scanner, survey.platform].filter(Boolean).join(' · ')
  const all = points.count === survey.echoes
  byId('amount').textContent = `${whole(points.count)} ${all ? '' : `of ${whole(survey.echoes)} `}point${survey.echoes === 1 ? '' : 's'}`
  byId('amount').title = `Positions to ${points.steps.x ?? '–'} m, times to 0.1 µs`
}

function choose(name) {
  colouring.take(name)
  for (const button of byId('attributes').children) showChosen(button)
  recolour()
}

/// The chosen one of the attributes is the only one that Tab reaches.
function showChosen(button) {
  const chosen = button.dataset.name === colouring.name
  button.setAttribute('aria-checked', String(chosen))
  button.tabIndex = chosen ? 0 : -1
}

/// Arrow keys, Home and End choose an attribute. Source: WAI-ARIA Authoring Practices, radio group.
function takeChoice() {
  const list = byId('attributes')
  list.onkeydown = event => {
    const buttons = [...list.children], at = buttons.indexOf(document.activeElement), last = buttons.length - 1
    const next = { ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: last }[event.key]
    if (next === undefined || event.altKey || event.ctrlKey || event.metaKey) return
    event.preventDefault()
    const button = buttons[(next + buttons.length) % buttons.length]
    button.focus()
    button.click()
  }
}

function recolour() {
  view.recolour()
  showHistogram()
}

/// Buttons of the attributes that differ among points.
function showAttributes() {
  const old = new Set([...byId('attributes').children].map(b => b.dataset.name))
  for (const [name, { label, main }] of Object.entries(attributes)) {
    const values = points.arrays[name]
    let varies = main
    for (let i = 1; !varies && i < points.count && values; ++i) varies = values[i] !== values[0]
    if (!varies || !values || old.has(name)) continue
    const button = element('button', '', label)
    button.dataset.name = name
    button.setAttribute('role', 'radio')
    showChosen(button)
    button.onclick = () => { state.chosen = true, choose(name) }
    byId('attributes').append(button)
  }
}

function showHistogram() {
  const { attribute } = colouring, list = byId('kinds'), amounts = byId('amounts')
  list.hidden = !attribute.list
  amounts.hidden = !!attribute.list || !!attribute.direct
  if (attribute.direct) return
  if (!attribute.list) {
    colouring.draw(byId('histogram'), theme.ink)
    const ends = (colouring.shown ?? colouring.ends).map(v => brief(colouring.name, colouring.unplotted(v)))
    byId('least').textContent = ends[0]
    byId('most').textContent = ends[1]
    byId('all').hidden = !colouring.shown
    return
  }
  list.replaceChildren()
  const most = colouring.kinds[0]?.[1] ?? 1, shown = 40
  for (const [value, count] of colouring.kinds.slice(0, shown)) {
    const row = element('label', 'kind'), box = element('input'), swatch = element('i')
    box.type = 'checkbox'
    box.checked = !colouring.hidden.has(value)
    box.onchange = () => {
      colouring.hidden[box.checked ? 'delete' : 'add'](value)
      view.recolour()
    }
    const colour = `rgb(${attribute.colour(value)})`
    swatch.style.background = colour
    const bar = element('b')
    bar.style.width = `${100 * count / most}%`
    bar.style.background = colour
    row.append(box, swatch, element('span', '', attribute.name(value)), element('em', '', whole(count)), bar)
    list.append(row)
  }
  if (colouring.kinds.length > shown) list.append(element('p', 'quiet', `and ${whole(colouring.kinds.length - shown)} more`))
}

function select(i) {
  state.selected = i
  const list = byId('point')
  list.replaceChildren()
  byId('pick').hidden = i < 0
  byId('hint').hidden = i >= 0 || !!state.measured
  if (i >= 0) for (const [label, text] of description(i)) list.append(element('dt', '', label), element('dd', '', text))
  view.redraw()
}

// -------------------------------------------------------------------------------------------------------- the timeline

function showTime() {
  const until = Math.min(view.now, state.end - view.start)
  byId('time').textContent = `${until.toFixed(2)} s`
  byId('whole_time').textContent = `of ${(state.end - view.start).toFixed(2)} s`
  const slider = byId('slider'), share = view.now === Infinity ? 1 : until / Math.max(state.end - view.start, 1e-12)
  slider.value = String(Math.round(share * 10000))
  slider.style.setProperty('--share', `${100 * share}%`)
  byId('play').setAttribute('aria-label', state.playing ? 'Pause' : 'Play')
  byId('play').dataset.playing = String(state.playing)
}

/// Shows the points up to a time since the start; all of them at the end.
function goTo(seconds) {
  const length = state.end - view.start
  view.now = seconds >= length ? Infinity : Math.max(0, seconds)
  view.trail = state.playing ? length * 0.03 : 0
  view.redraw(state.playing)
  showTime()
}

function play(on = !state.playing) {
  state.playing = on
  goTo(on && view.now === Infinity ? 0 : view.now)
  let before = performance.now()
  const step = state.step = time => {
    if (!state.playing || state.step !== step) return  // superseded by a later call
    const speed = byId('speed').value, length = state.end - view.start
    goTo(view.now + Math.max(0, time - before) / 1000 * (speed === 'real' ? 1 : length / Number(speed)))
    before = time
    if (view.now === Infinity) state.playing = false, showTime()
    else requestAnimationFrame(step)
  }
  requestAnimationFrame(step)
  showTime()
}

/// Histogram of points over time, behind the slider.
function showDensity() {
  const canvas = byId('density'), ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight
  canvas.width = width * ratio, canvas.height = height * ratio
  const bins = new Uint32Array(Math.max(1, Math.floor(width / 2))), { time } = points.arrays, per = bins.length / (state.end - view.start)
  for (let i = 0; i < points.count; ++i) ++bins[Math.min(bins.length - 1, Math.floor((time[i] - view.start) * per))]
  const c = canvas.getContext('2d'), most = Math.max(1, ...bins)
  c.scale(ratio, ratio)
  c.fillStyle = theme.quiet
  c.globalAlpha = 0.45
  bins.forEach((n, i) => c.fillRect(2 * i, height - height * n / most, 1.5, height * n / most))
}

// ------------------------------------------------------------------------------------------------------ hands and keys

/// The user's own view: it stays when points arrive.
function touch() {
  state.touched = true
  view.redraw(true)
}

function takePointers() {
  const canvas = view.canvas, held = new Map()
  let moved = 0
  canvas.onpointerdown = event => {
    canvas.setPointerCapture(event.pointerId)
    held.set(event.pointerId, event)
    moved = held.size > 1 ? 99 : 0
    canvas.focus()
  }
  canvas.onpointermove = event => {
    const before = held.get(event.pointerId)
    if (!before) return
    held.set(event.pointerId, event)
    const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY, { ratio, camera } = view
    moved += Math.abs(dx) + Math.abs(dy)
    if (moved < 4) return
    if (held.size === 2) {
      const other = [...held.values()].find(e => e.pointerId !== event.pointerId)
      const apart = e => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY)
      camera.zoom(apart(event) / Math.max(apart(before), 1))
      camera.pan(dx * ratio / 2, -dy * ratio / 2)
    } else if (event.buttons & 6 || event.shiftKey || event.ctrlKey) {
      camera.pan(dx * ratio, -dy * ratio)
    } else {
      camera.turn(-dx * 0.006, dy * 0.006)
    }
    touch()
  }
  canvas.onpointerup = canvas.onpointercancel = event => {
    const was = held.delete(event.pointerId)
    if (was && moved < 4 && event.type === 'pointerup' && event.button === 0)
      clickAt(event.offsetX * view.ratio, event.offsetY * view.ratio)
  }
  canvas.oncontextmenu = event => event.preventDefault()
  canvas.ondblclick = event => {
    const i = view.pick(event.offsetX * view.ratio, event.offsetY * view.ratio)
    if (i < 0) return
    view.camera.target = view.relative(['x', 'y', 'z'].map(name => points.arrays[name][i]))
    view.camera.distance *= 0.5
    touch()
  }
  canvas.addEventListener('wheel', event => {
    event.preventDefault()
    const lines = event.deltaY * (event.deltaMode === 1 ? 30 : 1)
    view.camera.zoom(Math.exp(-Math.max(-200, Math.min(200, lines)) * 0.0016), event.offsetX * view.ratio, event.offsetY * view.ratio)
    touch()
  }, { passive: false })
}

const seenFromAbove = () => Object.assign(view.camera, { azimuth: 0, elevation: Math.PI / 2 })

function takeKeys() {
  const acts = {
    ArrowLeft: e => e.shiftKey ? view.camera.pan(40, 0) : view.camera.turn(0.06, 0),
    ArrowRight: e => e.shiftKey ? view.camera.pan(-40, 0) : view.camera.turn(-0.06, 0),
    ArrowUp: e => e.shiftKey ? view.camera.pan(0, -40) : view.camera.turn(0, 0.06),
    ArrowDown: e => e.shiftKey ? view.camera.pan(0, 40) : view.camera.turn(0, -0.06),
    '+': () => view.camera.zoom(1.15), '=': () => view.camera.zoom(1.15), '-': () => view.camera.zoom(1 / 1.15),
    Home: () => view.fit(), f: () => view.fit(),
    t: seenFromAbove,
  }
  const others = {
    ' ': () => play(),
    Escape: () => { state.measured ? measure(false) : select(-1), colouring.shown = null, recolour() },
    Enter: () => clickAt(view.camera.width / 2, view.camera.height / 2),
    m: () => measure(),
    e: () => { view.shading = !view.shading, view.redraw() },
    '[': () => { view.pointSize = Math.max(0.5, view.pointSize / 1.2), view.redraw() },
    ']': () => { view.pointSize = Math.min(6, view.pointSize * 1.2), view.redraw() },
  }
  for (let k = 0; k < 9; ++k) others[k + 1] = () => byId('attributes').children[k]?.click()
  window.onkeydown = event => {
    if (event.target.matches('input, select, button, summary') && event.key !== 'Escape') return
    if (event.altKey || event.metaKey || event.ctrlKey || !view.origin) return  // keys of the browser
    const act = acts[event.key] ?? others[event.key]
    if (!act) return
    event.preventDefault()
    act(event)
    if (acts[event.key]) touch()
  }
}

function takeHistogram() {
  const histogram = byId('histogram')
  const valueAt = event => {
    const [low, high] = colouring.ends
    return low + Math.max(0, Math.min(1, event.offsetX / histogram.clientWidth)) * (high - low)
  }
  let from = null
  histogram.onpointerdown = event => { from = valueAt(event), histogram.setPointerCapture(event.pointerId) }
  histogram.onpointermove = event => {
    if (from === null) return
    const to = valueAt(event), least = (colouring.ends[1] - colouring.ends[0]) / 100
    if (Math.abs(to - from) < least) return
    colouring.shown = [Math.min(from, to), Math.max(from, to)]
    recolour()
  }
  histogram.onpointerup = () => { from = null }
}

function takeButtons() {
  byId('all').onclick = () => { colouring.shown = null, recolour() }
  byId('close').onclick = () => select(-1)
  byId('play').onclick = () => play()
  byId('slider').oninput = event => {
    state.playing = false
    goTo(Number(event.target.value) / 10000 * (state.end - view.start))
  }
  byId('size').oninput = event => { view.pointSize = Number(event.target.value), view.redraw() }
  byId('shading').onchange = event => { view.shading = event.target.checked, view.redraw() }
  byId('fit').onclick = () => { view.fit() }
  byId('top').onclick = () => { seenFromAbove(), view.redraw() }
}

// ------------------------------------------------------------------------------------------------------- what happens

/// Updates the panel for further points.
function grown(first) {
  const { time } = points.arrays
  if (points.count > 0) {
    state.end = Math.max(time[points.count - 1], survey.legs.at(-1)?.times?.at(-1) ?? 0, view.start + 1e-9)
    if (!view.origin || (state.live && !state.touched)) view.fit()
  }
  const choice = state.chosen ? colouring.name : Colouring.first()
  if (colouring.name !== choice) colouring.take(choice), view.recolour()
  else colouring.count()
  if (state.live && !colouring.attribute.list) for (const chunk of points.chunks) chunk.coloursAreOld = true  // the scale has changed
  showTitle()
  showAttributes()
  for (const button of byId('attributes').children) showChosen(button)
  showHistogram()
  if (points.count > 0) showTime(), showDensity()
  view.redraw(first)
}

function takeWays() {
  view.setWays(survey.legs.map(leg => ({ name: leg.name, times: leg.times, places: leg.places })))
}

/// Polls the server for new points until the end of the run.
async function follow() {
  const live = byId('live'), pause = milliseconds => new Promise(resolve => setTimeout(resolve, milliseconds))
  live.hidden = false
  byId('stop').onclick = async () => {
    byId('stop').disabled = true
    await fetch('stop', { method: 'POST' }).catch(() => {})
  }
  let after = '', run = '', failures = 0
  for (;;) {
    let bytes
    try {
      const answer = await fetch(`points?run=${run}&after=${after}`, { cache: 'no-store' })
      if (!answer.ok) throw new Error(answer.statusText)
      bytes = new Uint8Array(await answer.arrayBuffer())
      failures = 0
    } catch {
      if (++failures < 5) {  // the server may be busy with other clients
        await pause(200)
        continue
      }
      byId('progress').textContent = 'The program has ended'
      break
    }
    const size = new DataView(bytes.buffer).getUint32(0, true)
    const status = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + size)))
    if (String(status.run) !== run) {
      points.clear()
      select(-1)
      measure(false)
      run = String(status.run)
    }
    survey.echoes = status.echoes
    survey.legs = status.legs ?? survey.legs
    if (status.legs) takeWays()
    const block = await readBlock(bytes.subarray(4 + size))
    points.append(block)
    const selected = points.thin(status.largest_key, state.selected)
    if (selected !== state.selected) select(selected)
    after = status.last
    if (block.count > 0 || status.legs) grown()
    const share = status.total > 0 ? status.done / status.total : 0
    byId('bar').style.width = `${100 * share}%`
    const seconds = share > 0 ? Math.ceil(status.seconds * (1 / share - 1)) : 0
    const left = seconds < 90 ? `${seconds} s` : `${Math.ceil(seconds / 60)} min`
    byId('progress').textContent = status.state === 'running'
      ? `${(100 * share).toFixed(1)} % · ${whole(status.echoes)} echoes · ${left} left`
      : status.state === 'complete' ? 'The run is complete' : 'The run was stopped; what is written is whole'
    live.dataset.state = status.state
    if (status.more) continue
    if (status.state !== 'running') break
    await pause(300)
  }
  byId('stop').hidden = true
  state.live = false
}

async function begin() {
  view = state.view = new View(byId('view'), points)
  view.colourOf = (chunk, order, out) => colouring.fill(chunk, order, out)
  view.hides = i => colouring.hides(points.arrays[colouring.name][i])
  view.afterFrame = drawMarks
  takeWays()
  takePointers()
  takeKeys()
  takeHistogram()
  takeButtons()
  takeChoice()
  takeTools()
  matchMedia('(prefers-color-scheme: dark)').onchange = takeTheme
  window.onresize = () => { showHistogram(), points.count > 0 && showDensity() }
  const text = byId('points').textContent
  if (text.length > 0) {
    points.append(await readBlock(bytesOfBase64(text)))
    byId('points').remove()
  }
  takeTheme()
  grown()
  if (view.painter.context) byId('marks').hidden = true
  byId('wait').hidden = true
  window.pulsecast = { survey, points, view, colouring, state, attributes, choose, select, goTo, play, description, savePicture }
  if (survey.live) await follow()
}

begin().catch(error => {
  byId('wait').hidden = false
  byId('wait').textContent = String(error.message ?? error)
})
