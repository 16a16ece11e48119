// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Looks at pages in Chromium as people do: what is drawn, what is told of points, colours, histogram, timeline; and a page that is live.
// Usage: node check.mjs CHROMIUM PROGRAM, where PROGRAM is pages.cpp. Needs nothing but Node.js. With the folder node_modules behind it that
// has axe-core, it looks for barriers, too. With `speed` behind it, it measures how fast two million points turn instead. With `picture FILE.png`
// behind it, PROGRAM is a page, of which it takes a picture when all points are drawn.

import { execFileSync, spawn } from 'node:child_process'
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'

const [chromium, program, what, picture] = process.argv.slice(2)
const folder = mkdtempSync(join(tmpdir(), 'pulsecast_page_'))
const pause = milliseconds => new Promise(resolve => setTimeout(resolve, milliseconds))

function expect(condition, what) {
  if (!condition) throw new Error(what)
}

const near = (found, expected, error, what) => expect(Math.abs(found - expected) <= error, `${what} is ${found}, not ${expected}`)

// Chromium, told what to do by the messages of its DevTools protocol, each ended by a zero byte.
const browser = spawn(chromium, ['--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run',
  '--mute-audio', '--disable-background-networking', '--disable-extensions', '--hide-scrollbars',
  `--user-data-dir=${join(folder, 'profile')}`, '--remote-debugging-pipe', 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] })
let over = false
for (const event of ['error', 'exit'])
  browser.on(event, how => {
    if (over) return
    console.error(`Chromium has ended: ${how}`)
    rmSync(folder, { recursive: true, force: true })
    process.exit(1)
  })
browser.stdio[3].on('error', () => {})  // its end tells more
const waiting = new Map(), problems = [], requests = []
let sent = 0, unread = ''
browser.stdio[4].on('data', data => {
  unread += data
  for (let end; (end = unread.indexOf('\0')) >= 0; unread = unread.slice(end + 1)) {
    const message = JSON.parse(unread.slice(0, end))
    if (message.id) waiting.get(message.id)(message)
    if (message.method === 'Runtime.exceptionThrown') problems.push(JSON.stringify(message.params.exceptionDetails))
    if (message.method === 'Log.entryAdded' && message.params.entry.level === 'error') problems.push(JSON.stringify(message.params.entry))
    if (message.method === 'Network.requestWillBeSent') requests.push(message.params.request.url)
  }
})
let session
async function tell(method, params = {}) {
  const id = ++sent, answer = new Promise(resolve => waiting.set(id, resolve))
  browser.stdio[3].write(JSON.stringify({ id, method, params, sessionId: session }) + '\0')
  const { result, error } = await answer
  expect(!error, `${method}: ${error?.message}`)
  return result
}
async function page(expression) {
  const { result, exceptionDetails } = await tell('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true })
  expect(!exceptionDetails, `${expression}: ${exceptionDetails?.exception?.description}`)
  return result.value
}
async function until(expression, what, seconds = 20) {
  for (const end = Date.now() + 1000 * seconds; Date.now() < end; await pause(25)) if (await page(expression)) return
  throw new Error(`${what}: not within ${seconds} s; ${await page(`document.getElementById('wait')?.textContent`)}; ${problems}`)
}
async function mouse(type, x, y, more = {}) {
  await tell('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons: type === 'mouseReleased' ? 0 : 1, clickCount: 1, ...more })
}
const key = async (key, code = key) => {
  for (const type of ['keyDown', 'keyUp']) await tell('Input.dispatchKeyEvent', { type, key, code })
}
const rest = () => until('pulsecast.view.done >= 1 && !pulsecast.view.waiting', 'all points are drawn')
const open = async url => {
  await tell('Page.navigate', { url })
  await until('!!window.pulsecast', 'the page is read')
}
const capture = async file => writeFileSync(file, Buffer.from((await tell('Page.captureScreenshot', { format: 'png' })).data, 'base64'))
const resize = (width, height) => tell('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false })
/// The pixels that are not the background, or, if colours are given, have one of these; their share, and how many colours they have.
const seen = known => page(`((known) => {
  pulsecast.view.drawFrame(performance.now())  // what WebGL has shown before is gone
  const { canvas } = pulsecast.view, copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d')
  copy.drawImage(canvas, 0, 0)
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height), colours = new Set()
  let n = 0
  for (let y = 0, i = 0; y < canvas.height; ++y) {
    const back = [data[i], data[i + 1], data[i + 2]]  // at the left edge
    for (let x = 0; x < canvas.width; ++x, i += 4)
      if (known ? known.has(data[i] << 16 | data[i + 1] << 8 | data[i + 2]) : back.reduce((sum, v, k) => sum + Math.abs(v - data[i + k]), 0) > 12)
        ++n, colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2])
  }
  return { share: n / canvas.width / canvas.height, colours: colours.size, colour: [...colours].join().slice(0, 4000) }
})(${known ? `new Set(${JSON.stringify(known)})` : 'null'})`)

async function checkFile() {
  execFileSync(program, [folder])
  const truth = JSON.parse(readFileSync(join(folder, 'points.json')))
  await open(`file://${folder}/page.html`)
  await rest()
  expect(await page('pulsecast.points.count') === truth.length, 'the page has all points')

  // what was written is read, attribute by attribute
  const names = ['x', 'y', 'z', 'time', 'pulse', 'amplitude', 'reflectance', 'width', 'incidence', 'scan_angle', 'object', 'class', 'leg',
                 'return_number', 'returns', 'channel', 'range', 'kind', 'colour']
  const errors = [0.00026, 0.00026, 0.00026, 0.6e-7, 0, null, 0.00101, 0.00051, 0.26, 0.026, 0, 0, 0, 0, 0, 0, 0.001, 0, 0]
  const { length } = truth, read = JSON.parse(await page(
    `JSON.stringify(${JSON.stringify(names)}.map(name => [...pulsecast.points.arrays[name].subarray(0, ${length})]))`))
  truth.forEach((point, i) => names.forEach((name, k) => {
    const value = point[name]
    if (value === null) expect(read[k][i] === null, `${name} of point ${i} is unknown`)  // JSON writes NaN as null
    else near(read[k][i], value, errors[k] ?? 0.0102 * value, `${name} of point ${i}`)
  }))

  // no word of the survey became more than a word
  expect(await page('window.hurt') === undefined && await page(`document.querySelectorAll('img').length`) === 0, 'texts are texts')
  expect((await page('document.title')).startsWith('</script><img'), 'the title is the name')
  expect((await page(`document.getElementById('name').textContent`)).endsWith('survey'), 'the name is shown')

  // it is drawn; less of it earlier
  const all = await seen()
  expect(all.share > 0.1 && all.colours > 100, `the cloud is seen: ${all.share}, ${all.colours}`)
  await page('pulsecast.goTo(0.5)')
  await rest()
  const early = await seen()
  expect(early.share > 0.02 && early.share < 0.6 * all.share, `a quarter after a quarter of the time: ${early.share} of ${all.share}`)
  expect((await page(`document.getElementById('time').textContent`)) === '0.50 s', 'the clock shows the time')
  expect(await page(`document.getElementById('slider').value`) === '2500', 'the slider shows the time')
  await page(`(s => { s.value = 5000; s.dispatchEvent(new Event('input')) })(document.getElementById('slider'))`)
  near(await page('pulsecast.view.now'), 1, 0.001, 'what the slider chooses')
  await page(`document.getElementById('play').click()`)
  await until('pulsecast.view.now > 1.05', 'the acquisition plays')
  await page(`document.getElementById('play').click()`)
  expect(await page('pulsecast.state.playing') === false, 'the second press pauses')
  await page('pulsecast.goTo(9)')
  await rest()
  const again = await seen()
  expect(again.share === all.share, `at the end all is there: ${again.share}, not ${all.share}`)

  // colours: each attribute has its own, and hides what is not wanted
  const pictures = new Set()
  for (const name of await page(`[...document.querySelectorAll('#attributes button')].map(b => b.dataset.name)`)) {
    await page(`document.querySelector('[data-name=${name}]').click()`)
    await rest()
    expect(await page(`document.querySelector('[aria-checked=true]').dataset.name`) === name, `${name} is chosen`)
    pictures.add((await seen()).colour)
  }
  expect(pictures.size >= 15, `${pictures.size} kinds of colours`)
  await page(`pulsecast.choose('colour'), pulsecast.view.shading = false, pulsecast.view.redraw()`)
  await rest()
  expect(await page(`document.getElementById('kinds').hidden && document.getElementById('amounts').hidden`), 'colours have no list and no histogram')
  const { share: own, colours } = await seen([...new Set(truth.map(p => p.colour))])
  expect(own > 0.8 * all.share && colours > 100, `points have their own colours: ${colours} on ${own} of the picture, of ${all.share}`)
  await page('pulsecast.view.shading = true')
  await page(`pulsecast.choose('object')`)
  await rest()
  expect((await page(`document.getElementById('kinds').textContent`)).includes('</script><img'), 'objects have their names')
  const before = await seen()
  await page(`document.querySelector('#kinds input').click()`)
  await rest()
  expect((await seen()).share < 0.95 * before.share, 'a kind can be hidden')

  // the histogram counts what is there
  await page(`pulsecast.choose('class')`)
  const kinds = await page('pulsecast.colouring.kinds')
  for (const [value, count] of kinds) expect(count === truth.filter(p => p.class === value).length, `class ${value} is counted`)
  await page(`pulsecast.choose('z')`)
  const [low, high] = await page('pulsecast.colouring.ends'), bins = await page('[...pulsecast.colouring.bins]')
  const inside = read[2].filter(z => z >= low && z < high).length
  near(bins.reduce((a, b) => a + b), inside, 2, 'all bars together')
  const box = await page(`document.getElementById('histogram').getBoundingClientRect().toJSON()`)
  const full = await seen()
  await mouse('mousePressed', box.x + box.width * 0.75, box.y + 20)
  await mouse('mouseMoved', box.x + box.width * 0.98, box.y + 20)
  await mouse('mouseReleased', box.x + box.width * 0.98, box.y + 20)
  await rest()
  expect((await seen()).share < 0.8 * full.share, 'a part of the histogram shows that part')
  await page(`document.getElementById('all').click()`)

  // a click reads a point: the one whose place is clicked
  await rest()
  const target = await page(`(() => {
    const { view, points } = pulsecast, { x, y, z } = points.arrays
    for (let i = 0; ; i += 97) {
      const [sx, sy] = view.camera.project(view.relative([x[i], y[i], z[i]]))
      if (view.pick(sx, sy) === i) return { i, x: sx / view.ratio, y: sy / view.ratio }
    }
  })()`)
  await mouse('mousePressed', target.x, target.y)
  await mouse('mouseReleased', target.x, target.y)
  const chosen = await page('pulsecast.state.selected')
  near(chosen, target.i, 0, 'the point that is clicked')
  const told = await page(`[...document.querySelectorAll('#point dt')].map(e => [e.textContent, e.nextSibling.textContent])`)
  const value = Object.fromEntries(told), point = truth[chosen]
  near(parseFloat(value.East), point.x, 0.00051, 'East'), near(parseFloat(value.Height), point.z, 0.00051, 'Height')
  near(parseFloat(value.Range), point.range, 0.0015, 'Range'), expect(/ [µn]W$/.test(value.Intensity), 'the unit of intensity')
  near(parseFloat(value.Intensity) * (value.Intensity.endsWith('µW') ? 1e-6 : 1e-9), point.amplitude, 0.016 * point.amplitude, 'Intensity')
  expect(value.Return === `${point.return_number} of ${point.returns}`, 'the return is told')
  expect(value.Pulse.replace(/\D/g, '') === String(point.pulse), 'the pulse is told')
  expect(value.Class.startsWith(`${point.class} `) && told.length === 18, `all attributes are told: ${JSON.stringify(value)}`)

  expect(value.Colour === (point.colour === null ? '–' : '#' + point.colour.toString(16).padStart(6, '0')), `the colour is told: ${value.Colour}`)

  // hands and keys move the view
  const azimuth = await page('pulsecast.view.camera.azimuth'), distance = await page('pulsecast.view.camera.distance')
  for (const [type, x] of [['Pressed', 200], ['Moved', 260], ['Moved', 320], ['Released', 320]])
    await mouse('mouse' + type, x, 200 + x / 10)
  expect(Math.abs(await page('pulsecast.view.camera.azimuth') - azimuth) > 0.1, 'dragging turns')
  await tell('Input.dispatchMouseEvent', { type: 'mouseWheel', x: 300, y: 300, deltaX: 0, deltaY: -200 })
  await until(`pulsecast.view.camera.distance < ${0.9 * distance}`, 'the wheel zooms')
  await key('t')
  near(await page('pulsecast.view.camera.elevation'), Math.PI / 2, 1e-9, 'T looks from above')
  await key('Escape')
  expect(await page('pulsecast.state.selected') === -1, 'Escape lets go')
  await key('Home')
  await page(`document.querySelector('[data-name=returns]').remove()`)  // as where all pulses have as many
  for (const [k, name] of [[7, 'reflectance'], [1, 'z']]) {
    await key(String(k), `Digit${k}`)
    expect(await page('pulsecast.colouring.name') === name, `${k} colours by ${name}, as the ${k}th button does`)
  }
  const taken = more => page(`(event => (document.body.dispatchEvent(event), event.defaultPrevented))(
    new KeyboardEvent('keydown', { key: 'f', cancelable: true, bubbles: true, ...${JSON.stringify(more)} }))`)
  expect(await taken({}) && !await taken({ ctrlKey: true }) && !await taken({ metaKey: true }), "the browser's keys stay its own")

  // small windows and dark ones
  await tell('Emulation.setDeviceMetricsOverride', { width: 380, height: 600, deviceScaleFactor: 2, mobile: false })
  await tell('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: 'dark' }] })
  await until('pulsecast.view.canvas.width === 760', 'the view fits a small window')
  await rest()
  expect((await seen()).share > 0.05, 'the cloud is seen in a small window')
  expect(await page('pulsecast.view.sky[0][0]') < 0.2, 'a dark page is dark')
  expect(await page('document.documentElement.scrollWidth') <= 380, 'nothing sticks out')
  await resize(1100, 700)
  await tell('Emulation.setEmulatedMedia', { features: [] })

  // by WebGL, it is the same picture, but for the edges of points
  await open(`file://${folder}/page.html?painter=gl`)
  if (await page('pulsecast.view.painter.constructor.name') === 'GlPainter') {
    await rest()
    near((await seen()).share, all.share, 0.15 * all.share + 0.02, 'the share of the picture by WebGL')
  }
  expect(requests.every(url => /^(file|data|blob):/.test(url)), `nobody is asked: ${requests}`)
}

/// Clicks a button, or what else has this id, where it is seen.
async function press(id) {
  const { x, y, width, height } = await page(`(e => {
    e.scrollIntoView({ block: 'center' })
    return e.getBoundingClientRect().toJSON()
  })(document.getElementById('${id}'))`)
  await mouse('mousePressed', x + width / 2, y + height / 2)
  await mouse('mouseReleased', x + width / 2, y + height / 2)
}
const texts = id => page(`[...document.querySelectorAll('#${id} dd')].map(e => e.textContent)`)
const set = (id, value) => page(`(e => {
  e.value = '${value}'
  e.dispatchEvent(new Event(e.matches('select') ? 'change' : 'input'))
})(document.getElementById('${id}'))`)

/// Two points that are picked where they are drawn, apart in the picture: { i, x, y, place }.
const twoPoints = () => page(`(() => {
  const { view, points } = pulsecast, { x, y, z } = points.arrays, found = []
  for (let i = 0; found.length < 2; i += 97) {
    const place = [x[i], y[i], z[i]], [sx, sy] = view.camera.project(view.relative(place)).map(v => v / view.ratio)
    if (view.pick(sx * view.ratio, sy * view.ratio) === i && !found.some(f => Math.hypot(f.x - sx, f.y - sy) < 100))
      found.push({ i, x: sx, y: sy, place })
  }
  return found
})()`)

/// Distances by clicks, and what ends them.
async function checkMeasuring() {
  await open(`file://${folder}/page.html`)
  await rest()
  const [a, b] = await twoPoints(), [dx, dy, dz] = b.place.map((v, k) => v - a.place[k])
  await press('measure')
  for (const { x, y } of [a, b]) await mouse('mousePressed', x, y), await mouse('mouseReleased', x, y)
  const found = (await texts('lengths')).map(parseFloat)
  for (const [k, expected] of [Math.hypot(dx, dy, dz), Math.hypot(dx, dy), dz].entries()) near(found[k], expected, 0.00051, 'a length')
  expect(await page('pulsecast.state.selected') === -1, 'a click that measures reads no point')
  await key('Escape')
  expect(await page(`document.getElementById('distance').hidden && pulsecast.state.measured === null`), 'Escape ends measuring')
  await page('document.activeElement.blur()')
  await key('m')
  await page(`pulsecast.view.camera.target = pulsecast.view.relative(${JSON.stringify(a.place)})`)  // in the middle
  await key('Enter')
  expect(await page('pulsecast.state.measured.length') === 1, 'Enter takes the point in the middle')
  await press('done')
  expect(await page(`document.getElementById('measure').getAttribute('aria-pressed')`) === 'false', 'the button is up again')
}

/// Slices hold the points within them, and look as they should.
async function checkSlices() {
  const inside = () => page(`(() => {
    const { view, points } = pulsecast, { x, y, z } = points.arrays
    return Array.from({ length: points.count }, (_, i) => view.inSlab([x[i], y[i], z[i]])).filter(Boolean).length
  })()`)
  await page('pulsecast.view.fit()')
  await rest()
  const all = await seen(), count = await inside()
  await set('cut', 'level')
  const thick = await inside()
  await rest()
  expect(thick > 0 && thick < 0.2 * count && (await seen()).share < 0.5 * all.share, `a level slice holds ${thick} of ${count}`)
  await set('place', 900)
  const height = await page(`parseFloat(document.getElementById('place_text').textContent)`)
  const heights = await page(`(() => {
    const { view, points } = pulsecast, { x, y, z } = points.arrays
    return Array.from({ length: points.count }, (_, i) => i).filter(i => view.inSlab([x[i], y[i], z[i]])).map(i => z[i])
  })()`)
  const reach = await page('pulsecast.view.slab.reach')
  expect(heights.length > 0 && heights.every(z => Math.abs(z - height) <= reach + 0.01), `heights are within ${reach} m of ${height} m`)
  await set('cut', 'upright')
  await set('azimuth', 90)
  await set('place', 500)
  await set('thickness', 300)
  expect(await page('pulsecast.view.slab.plane[0]') === 1, 'an upright slice has an azimuth')
  expect(await inside() > 0 && await inside() < 0.05 * count, 'an upright slice is thin')
  await press('face')
  near(await page('pulsecast.view.camera.elevation'), 0, 1e-9, 'the elevation of a look at it')
  await set('cut', 'none')
  expect(await inside() === count, 'all points are back')
}

/// Pictures are saved as PNG of the size of the view, or twice that, with the points on them.
async function checkPictures() {
  await tell('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: folder })
  await page(`pulsecast.survey.name = 'A wood / hut', pulsecast.view.fit(), 0`)
  const [width, height] = await page('[pulsecast.view.canvas.width, pulsecast.view.canvas.height]'), file = join(folder, 'A_wood_hut.png')
  for (const [id, scale] of [['screen', 1], ['double', 2]]) {
    rmSync(file, { force: true })
    await press(id)
    for (const end = Date.now() + 20000; !existsSync(file) && Date.now() < end;) await pause(25)
    const bytes = readFileSync(file)
    expect(bytes.readUInt32BE(16) === scale * width && bytes.readUInt32BE(20) === scale * height, `${id}: the size of the picture`)
    expect(bytes.length > 20000, `${id}: the points are on it: ${bytes.length} bytes`)
  }
  expect(await page('pulsecast.view.canvas.width') === width, 'the view is as before')
}

/// One stop of Tab for all attributes; arrows choose. On a phone, the legend is seen without scrolling.
async function checkChoice() {
  await page(`document.querySelector('#attributes [tabindex="0"]').focus()`)
  expect(await page(`document.querySelectorAll('#attributes [tabindex="0"]').length`) === 1, 'one stop')
  const names = await page(`[...document.querySelectorAll('#attributes button')].map(b => b.dataset.name)`)
  const first = await page('pulsecast.colouring.name')
  for (const [press, name] of [['End', names.at(-1)], ['ArrowRight', names[0]], ['ArrowDown', names[1]], ['ArrowLeft', names[0]],
                               ['ArrowUp', names.at(-1)], ['Home', names[0]]]) {
    await key(press)
    expect(await page(`pulsecast.colouring.name`) === name && await page('document.activeElement.dataset.name') === name, `${press} chooses ${name}`)
  }
  await key('Tab')
  expect(await page(`document.activeElement.closest('#attributes') === null`), 'Tab leaves them')
  await page(`pulsecast.choose('${first}')`)
  await tell('Emulation.setDeviceMetricsOverride', { width: 390, height: 780, deviceScaleFactor: 2, mobile: true })
  for (const [name, id] of [['z', 'amounts'], ['class', 'kinds']]) {
    await page(`pulsecast.choose('${name}'), document.getElementById('panel').scrollTop = 0`)
    expect(await page(`document.getElementById('${id}').getBoundingClientRect().bottom`) <= 780, `${id} are above the fold of a phone`)
  }
}

/// No name covers a mark, another name, or the scale bar.
async function checkNames() {
  await resize(1100, 700)
  const boxes = await page(`(async () => {
    const { view } = pulsecast, written = [], { prototype } = CanvasRenderingContext2D, fillText = prototype.fillText
    view.setWays([[0, 0], [0.5, 0], [0.6, 0.1], [9, 9], [-9, 9]].map(([x, y], i) => ({ name: 'set-up ' + i, times: [0], places: [[x, y, 3]] })))
    view.redraw()
    while (view.waiting || view.done < 1) await new Promise(requestAnimationFrame)
    prototype.fillText = function (text, x, y) { written.push([text, x, y, this.measureText(text).width]); fillText.call(this, text, x, y) }
    view.drawFrame(performance.now())
    prototype.fillText = fillText
    const marks = view.ways.map(way => view.camera.project(view.relative(way.places[0])))
    return { names: written.filter(([text]) => text.startsWith('set-up')), marks }
  })()`)
  const { names, marks } = boxes
  expect(names.length >= 3, `${names.length} names are seen`)
  names.forEach(([, x, y, width], i) => {
    names.slice(0, i).forEach(([, x2, y2, width2]) => expect(Math.abs(y - y2) >= 11 || x + width <= x2 || x2 + width2 <= x, 'names are apart'))
    for (const [mx, my] of marks) expect(!(mx > x && mx < x + width && my > y - 10 && my < y), 'names cover no mark')
  })
}

/// axe-core finds no barrier on the page, light and dark, large and small, with each part open.
async function checkBarriers(modules) {
  const axe = readFileSync(join(modules, 'axe-core', 'axe.min.js'), 'utf8')
  for (const scheme of ['light', 'dark'])
    for (const [width, height] of [[1100, 700], [390, 780]]) {
      await resize(width, height)
      await tell('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }] })
      await open(`file://${folder}/page.html`)
      await page(`pulsecast.select(0), pulsecast.choose('class'), document.querySelector('details').open = true`)
      await press('measure')
      await set('cut', 'upright')
      await rest()
      await page(`${axe}; 0`)
      const found = await page(`axe.run().then(r => r.violations.map(v => v.id + ': ' + v.nodes.map(n => n.target).join(' ')))`)
      expect(found.length === 0, `${scheme}, ${width} px: ${found.join('; ')}`)
    }
}

/// A page without points can be handled like others.
async function checkEmpty() {
  execFileSync(program, [folder, '0'])
  await open(`file://${folder}/page.html`)
  expect((await page(`document.getElementById('amount').textContent`)) === '0 points', 'there are no points')
  for (const clickCount of [1, 2]) for (const type of ['mousePressed', 'mouseReleased']) await mouse(type, 300, 300, { clickCount })
  await key('Home')
  await page(`['fit', 'top', 'play'].forEach(id => document.getElementById(id).click())`)
  expect(await page('pulsecast.view.origin') === null, 'points that come may still say where they are')
}

async function checkLive(shots, stop) {
  const run = spawn(program, ['live', String(shots)], { stdio: ['ignore', 'pipe', 'inherit'] })
  let said = ''
  run.stdout.on('data', data => { said += data })
  const ended = new Promise(resolve => run.on('exit', resolve))
  while (!said.includes('\n')) await pause(10)
  await open(said.trim())
  await until('pulsecast.points.count > 0', 'the first points come')
  if (stop) {  // the other may be over by now
    const count = await page('pulsecast.points.count')
    await until(`pulsecast.points.count > ${count} && pulsecast.view.origin`, 'more points come')
    expect((await page(`document.getElementById('progress').textContent`)).includes('%'), 'the progress is told')
  }
  expect(await page(`document.querySelectorAll('img').length`) === 0, 'texts are texts')
  if (stop) await page(`document.getElementById('stop').click()`)
  await until(`document.getElementById('live').dataset.state === '${stop ? 'stopped' : 'complete'}'`, 'the end is told')
  if (!stop) expect(await page('pulsecast.points.count') === shots * 1.25, `all points have come: ${await page('pulsecast.points.count')}`)
  await rest()
  expect((await seen()).share > (stop ? 0.001 : 0.03), 'the cloud is seen')
  expect(await ended === 0 && said.trim().endsWith(stop ? 'stopped' : 'complete'), `the program says how it ended: ${said}`)
}

/// Processor time of the pages [s].
async function processorTime() {
  const its = session
  session = undefined
  const { processInfo } = await tell('SystemInfo.getProcessInfo')
  session = its
  return processInfo.filter(({ type }) => type === 'renderer').reduce((sum, { cpuTime }) => sum + cpuTime, 0)
}

/// Turns a cloud of two million points for some seconds: all of them in every frame, 700,000, and as many as keep the pace; by hand and by
/// WebGL.
async function measureSpeed() {
  execFileSync(program, [folder, '1600000'])
  for (const painter of ['plain', 'gl']) {
    await open(`file://${folder}/page.html?painter=${painter}`)
    await rest()
    for (const points of ['all', 700000, 'as many as keep the pace']) {
      await page(`pulsecast.view.adaptive = ${points !== 'all'}`)
      await page(`pulsecast.view.keepPace = ${points > 0} ? () => {} : Object.getPrototypeOf(pulsecast.view).keepPace`)
      if (points > 0) await page(`pulsecast.view.budget = ${points}`)
      const before = await processorTime()
      const { count, frames, seconds, drawn } = await page(`(async () => {
        const { view, points } = pulsecast, frame = () => new Promise(requestAnimationFrame), draw = view.drawFrame
        let frames = 0, drawn = 0
        view.drawFrame = function (time) { draw.call(this, time), ++frames, drawn += this.drawn }
        const turn = async milliseconds => {
          for (const end = performance.now() + milliseconds; performance.now() < end; await frame())
            view.camera.turn(0.02, 0), view.redraw(true)
        }
        if (${points === 'as many as keep the pace'}) await turn(6000)  // until it keeps its pace
        frames = drawn = 0
        const begin = performance.now()
        await turn(4000)
        view.drawFrame = draw
        return { count: points.count, frames, drawn: drawn / frames, seconds: (performance.now() - begin) / 1000 }
      })()`)
      const each = points === 'as many as keep the pace' ? '' : `, ${(1000 * (await processorTime() - before) / frames).toFixed(1)} ms of processor time each`
      console.log(`${painter}, ${points}: ${(frames / seconds).toFixed(1)} frames/s of ${Math.round(drawn)} of ${count} points${each}`)
    }
  }
}

let status = 0
try {
  const { targetInfos } = await tell('Target.getTargets')
  session = (await tell('Target.attachToTarget', { targetId: targetInfos.find(t => t.type === 'page').targetId, flatten: true })).sessionId
  for (const domain of ['Runtime', 'Log', 'Page', 'Network']) await tell(`${domain}.enable`)
  await resize(1100, 700)
  if (what === 'speed') {
    await measureSpeed()
  } else if (what === 'picture') {
    await resize(1600, 900)
    await open(`file://${resolve(program)}`)
    await rest()
    await capture(picture)
  } else {
    await checkFile()
    for (const check of [checkMeasuring, checkSlices, checkPictures, checkChoice, checkNames]) await check()
    if (what) await checkBarriers(what)
    await resize(1100, 700)
    await checkEmpty()
    await checkLive(8000, false)
    await checkLive(1000000, true)
    expect(problems.length === 0, `nothing goes wrong: ${problems}`)
    console.log('The pages are as they should be.')
  }
} catch (error) {
  console.error(error.stack)
  if (process.env.PULSECAST_PAGE_PICTURE) await capture(process.env.PULSECAST_PAGE_PICTURE)
  status = 1
}
over = true
browser.kill()
await pause(200)
rmSync(folder, { recursive: true, force: true, maxRetries: 5 })
process.exit(status)
