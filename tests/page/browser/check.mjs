// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Looks at pages in Chromium as people do: what is drawn, what is told of points, colours, histogram, timeline; and a page that is live.
// Usage: node check.mjs CHROMIUM PROGRAM, where PROGRAM is pages.cpp. Needs nothing but Node.js. With `speed` behind it, it measures
// how fast two million points turn instead.

import { execFileSync, spawn } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'

const [chromium, program, what] = process.argv.slice(2)
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
  await tell('Emulation.setDeviceMetricsOverride', { width: 1100, height: 700, deviceScaleFactor: 1, mobile: false })
  await tell('Emulation.setEmulatedMedia', { features: [] })

  // by WebGL, it is the same picture, but for the edges of points
  await open(`file://${folder}/page.html?painter=gl`)
  if (await page('pulsecast.view.painter.constructor.name') === 'GlPainter') {
    await rest()
    near((await seen()).share, all.share, 0.15 * all.share + 0.02, 'the share of the picture by WebGL')
  }
  expect(requests.every(url => /^(file|data|blob):/.test(url)), `nobody is asked: ${requests}`)
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

/// Turns a cloud of two million points for some seconds: all of them in every frame, and as many as keep the pace; by hand and by WebGL.
async function measureSpeed() {
  execFileSync(program, [folder, '1600000'])
  for (const painter of ['plain', 'gl']) {
    await open(`file://${folder}/page.html?painter=${painter}`)
    await rest()
    for (const adaptive of [false, true]) {
      const { count, frames, seconds, drawn } = await page(`(async () => {
        const { view, points } = pulsecast, frame = () => new Promise(requestAnimationFrame), draw = view.drawFrame
        let frames = 0, drawn = 0
        view.adaptive = ${adaptive}
        view.drawFrame = function (time) { draw.call(this, time), ++frames, drawn += this.drawn }
        const turn = async milliseconds => {
          for (const end = performance.now() + milliseconds; performance.now() < end; await frame())
            view.camera.turn(0.02, 0), view.redraw(true)
        }
        await turn(6000)  // until it keeps its pace
        frames = drawn = 0
        const begin = performance.now()
        await turn(4000)
        view.drawFrame = draw
        return { count: points.count, frames, drawn: drawn / frames, seconds: (performance.now() - begin) / 1000 }
      })()`)
      console.log(`${painter}, ${adaptive ? 'as many as keep the pace' : 'all'}: ${(frames / seconds).toFixed(1)} frames/s of ` +
        `${Math.round(drawn)} of ${count} points`)
    }
  }
}

let status = 0
try {
  const { targetInfos } = await tell('Target.getTargets')
  session = (await tell('Target.attachToTarget', { targetId: targetInfos.find(t => t.type === 'page').targetId, flatten: true })).sessionId
  for (const domain of ['Runtime', 'Log', 'Page', 'Network']) await tell(`${domain}.enable`)
  await tell('Emulation.setDeviceMetricsOverride', { width: 1100, height: 700, deviceScaleFactor: 1, mobile: false })
  if (what === 'speed') {
    await measureSpeed()
  } else {
    await checkFile()
    await checkEmpty()
    await checkLive(8000, false)
    await checkLive(1000000, true)
    expect(problems.length === 0, `nothing goes wrong: ${problems}`)
    console.log('The pages are as they should be.')
  }
} catch (error) {
  console.error(error.stack)
  if (process.env.PULSECAST_PAGE_PICTURE) {
    const { data } = await tell('Page.captureScreenshot', { format: 'png' })
    writeFileSync(process.env.PULSECAST_PAGE_PICTURE, Buffer.from(data, 'base64'))
  }
  status = 1
}
over = true
browser.kill()
await pause(200)
rmSync(folder, { recursive: true, force: true, maxRetries: 5 })
process.exit(status)
