// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// -------------------------------------------------------------------------------------------------------- two painters

const pointsVertex = `@points.vert.glsl@`

const pointsFragment = `@points.frag.glsl@`

const lineVertex = `@line.vert.glsl@`

const screenVertex = `@screen.vert.glsl@`

// Pixels behind their surroundings are darker. Source: Boucheny 2009, eye-dome lighting; amounts by eye.
const screenFragment = `@screen.frag.glsl@`

/// Painter with WebGL 2.
class GlPainter {
  /// Null without WebGL 2, or without a graphics card.
  static on(canvas) {
    const wanted = new URLSearchParams(location.search).get('painter')  // gl or plain, for comparisons
    if (wanted === 'plain') return null
    const probe = document.createElement('canvas').getContext('webgl2')
    const name = probe?.getExtension('WEBGL_debug_renderer_info') && probe.getParameter(0x9246)
    probe?.getExtension('WEBGL_lose_context')?.loseContext()
    if (!probe || (wanted !== 'gl' && /swiftshader|llvmpipe|software|basic render/i.test(name ?? ''))) return null
    const gl = canvas.getContext('webgl2', { antialias: false, depth: false, alpha: false, powerPreference: 'high-performance' })
    return gl && new GlPainter(canvas, gl)
  }

  constructor(canvas, gl) {
    this.canvas = canvas
    this.gl = gl
    this.lines = []
    this.pointProgram = this.program(pointsVertex, pointsFragment)
    this.lineProgram = this.program(lineVertex, pointsFragment)
    this.screenProgram = this.program(screenVertex, screenFragment)
  }

  program(vertex, fragment) {
    const { gl } = this, program = gl.createProgram()
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type)
      gl.shaderSource(shader, source)
      gl.compileShader(shader)
      gl.attachShader(program, shader)
    }
    gl.linkProgram(program)
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || 'a shader does not compile')
    const places = {}
    for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; --i) {
      const { name } = gl.getActiveUniform(program, i)
      places[name] = gl.getUniformLocation(program, name)
    }
    return { program, places }
  }

  /// True while the previous frame is being drawn.
  busy() {
    if (!this.sync || this.gl.getSyncParameter(this.sync, this.gl.SYNC_STATUS) !== this.gl.SIGNALED) return !!this.sync
    this.gl.deleteSync(this.sync)
    this.sync = null
    return false
  }

  resize(width, height) {
    const { gl } = this
    for (const texture of [this.colours, this.depths]) if (texture) gl.deleteTexture(texture)
    this.frame ??= gl.createFramebuffer()
    const texture = (inside, format, type) => {
      const made = gl.createTexture()
      gl.bindTexture(gl.TEXTURE_2D, made)
      gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, height, 0, format, type, null)
      for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST)
      for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE)
      return made
    }
    this.colours = texture(gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE)
    this.depths = texture(gl.DEPTH_COMPONENT24, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT)
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame)
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.colours, 0)
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depths, 0)
  }

  clear() {
    const { gl, canvas } = this
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame)
    gl.viewport(0, 0, canvas.width, canvas.height)
    gl.clearColor(0, 0, 0, 1)
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT)
  }

  /// Vertex array: four floats per vertex.
  vertices(target) {
    const { gl } = this
    target.array = gl.createVertexArray()
    target.places = gl.createBuffer()
    gl.bindVertexArray(target.array)
    gl.bindBuffer(gl.ARRAY_BUFFER, target.places)
    gl.enableVertexAttribArray(0), gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 16, 0)
    gl.enableVertexAttribArray(1), gl.vertexAttribPointer(1, 1, gl.FLOAT, false, 16, 12)
    target.free = () => { gl.deleteVertexArray(target.array), gl.deleteBuffer(target.places), gl.deleteBuffer(target.colours ?? null) }
    return target
  }

  takePlaces(chunk, places) {
    const { gl } = this
    if (!chunk.array) {
      this.vertices(chunk)
      chunk.colours = gl.createBuffer()
      gl.bindBuffer(gl.ARRAY_BUFFER, chunk.colours)
      gl.enableVertexAttribArray(2), gl.vertexAttribPointer(2, 4, gl.UNSIGNED_BYTE, true, 4, 0)
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, chunk.places)
    gl.bufferData(gl.ARRAY_BUFFER, places, gl.STATIC_DRAW)
  }

  takeColours(chunk, colours) {
    const { gl } = this
    gl.bindBuffer(gl.ARRAY_BUFFER, chunk.colours)
    gl.bufferData(gl.ARRAY_BUFFER, colours, gl.STATIC_DRAW)
  }

  draw(chunk, first, end, { matrix, size, least, most, now, trail, fresh, slab }) {
    const { gl } = this, { program, places } = this.pointProgram
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame)
    gl.enable(gl.DEPTH_TEST)
    gl.useProgram(program)
    gl.uniformMatrix4fv(places.camera, false, matrix)
    gl.uniform3f(places.size, size, least, most)
    gl.uniform2f(places.now, Math.min(now, 3e38), trail)
    gl.uniform3fv(places.fresh, fresh)
    gl.uniform4fv(places.plane, slab.plane)
    gl.uniform1f(places.reach, slab.reach)
    gl.bindVertexArray(chunk.array)
    gl.drawArrays(gl.POINTS, first, end - first)
  }

  drawWays(view, { matrix, now }, colour) {
    const { gl } = this, { program, places } = this.lineProgram
    if (this.waysAreOld) {
      for (const line of this.lines) line.free()
      this.lines = view.ways.map(way => {
        const line = this.vertices({ times: way.times })
        const places = way.places.flatMap((place, i) => [...view.relative(place), way.times[i] - view.start])
        gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(places), gl.STATIC_DRAW)
        return line
      })
      this.waysAreOld = false
    }
    gl.enable(gl.DEPTH_TEST)
    gl.useProgram(program)
    gl.uniformMatrix4fv(places.camera, false, matrix)
    gl.uniform3fv(places.line, colour)
    for (const { array, times } of this.lines) {
      const later = times.findIndex(time => time > view.start + now)
      gl.bindVertexArray(array)
      gl.drawArrays(gl.LINE_STRIP, 0, later < 0 ? times.length : later)
    }
  }

  show({ near, far, shading, sky, ratio }) {
    const { gl, canvas } = this, { program, places } = this.screenProgram
    gl.bindFramebuffer(gl.FRAMEBUFFER, null)
    gl.viewport(0, 0, canvas.width, canvas.height)
    gl.disable(gl.DEPTH_TEST)
    gl.useProgram(program)
    gl.activeTexture(gl.TEXTURE1), gl.bindTexture(gl.TEXTURE_2D, this.depths), gl.uniform1i(places.depths, 1)
    gl.activeTexture(gl.TEXTURE0), gl.bindTexture(gl.TEXTURE_2D, this.colours), gl.uniform1i(places.colours, 0)
    gl.uniform4f(places.lens, near, far, Math.max(1, Math.round(ratio)), shading ? 12 : 0)
    gl.uniform3fv(places.above, sky[0])
    gl.uniform3fv(places.below, sky[1])
    gl.uniform1f(places.height, canvas.height)
    gl.bindVertexArray(null)
    gl.drawArrays(gl.TRIANGLES, 0, 3)
    this.sync ??= gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0)
    gl.flush()
  }
}

/// Painter without WebGL: a depth and a colour per pixel. If there are many points, they are drawn `growth` pixels smaller than they are, most of
/// them as one pixel; `grown` makes up for it, for all at once.
class PlainPainter {
  constructor(canvas) {
    this.canvas = canvas
    this.context = canvas.getContext('2d', { alpha: false, willReadFrequently: true })
    this.shades = Uint32Array.from({ length: 256 }, (_, i) => Math.round(256 * Math.exp(-12 * 0.08 * i / 255)))
    this.growth = 0
    this.discs = []
  }

  busy() { return false }

  resize(width, height) {
    this.width = width, this.height = height
    for (const layer of ['drawn', 'wide']) this[layer] = { depths: new Float32Array(width * height), colours: new Uint32Array(width * height) }
    this.image = this.context.createImageData(width, height)
    this.pixels = new Uint32Array(this.image.data.buffer)
  }

  clear() { this.drawn.depths.fill(Infinity) }

  takePlaces(chunk, places) { chunk.places = places }
  takeColours(chunk, colours) { chunk.colours = new Uint32Array(colours.buffer) }

  /// Pixels left out at either end of each row of a point of a size: none of a small one, the corners of a large one.
  disc(size) {
    const inset = row => size < 4 ? 0 : Math.round((size - Math.sqrt(size ** 2 - (2 * row + 1 - size) ** 2)) / 2)
    return this.discs[size] ??= Uint8Array.from({ length: size }, (_, row) => inset(row))
  }

  draw(chunk, first, end, { matrix, near, size, least, most, now, trail, fresh, slab, many }) {
    const { width, height } = this, { depths, colours } = this.drawn, { places, colours: tints } = chunk
    const growth = this.growth = many ? Math.max(0, Math.round(least) - 1) : 0
    const small = least < growth + 1.5 ? size / (growth + 1.5) : Infinity  // points that are deeper are one pixel
    const [a0, a1, , a3, b0, b1, , b3, c0, c1, , c3, d0, d1, , d3] = matrix
    const across = [a0 + a3, b0 + b3, c0 + c3, d0 + d3].map(v => v * width / 2), down = [a3 - a1, b3 - b1, c3 - c1, d3 - d1].map(v => v * height / 2)
    const [ax, bx, cx, dx] = across, [ay, by, cy, dy] = down, shift = growth / 2
    const newest = fresh.map(v => 255 * v), { plane: [nx, ny, nz, middle], reach } = slab, sliced = slab.plane.some(Boolean)
    for (let i = first, o = 4 * first; i < end; ++i, o += 4) {
      const x = places[o], y = places[o + 1], z = places[o + 2], time = places[o + 3]
      const depth = a3 * x + b3 * y + c3 * z + d3
      if (depth < near || time > now || (sliced && Math.abs(nx * x + ny * y + nz * z - middle) > reach)) continue
      const per = 1 / depth, sx = per * (ax * x + bx * y + cx * z + dx), sy = per * (ay * x + by * y + cy * z + dy)
      const column = (sx + 1 | 0) - 1, row = (sy + 1 | 0) - 1
      if (column >>> 0 >= width || row >>> 0 >= height) continue
      if (depth > small) {
        const at = growth === 0 ? row * width + column : Math.max(0, sy - shift | 0) * width + Math.max(0, sx - shift | 0)
        if (!(depth < depths[at])) continue
        let tint = tints[i]
        if (tint >>> 24 === 0) continue
        if (trail > 0 && now - time < trail) tint = mixed(tint, newest, 0.85 * (1 - (now - time) / trail))
        depths[at] = depth, colours[at] = tint
        continue
      }
      let tint = tints[i]
      if (tint >>> 24 === 0) continue
      if (trail > 0 && now - time < trail) tint = mixed(tint, newest, 0.85 * (1 - (now - time) / trail))
      const full = Math.round(Math.min(Math.max(size * per, least), most)), square = full - growth, disc = this.disc(square)
      const left = Math.max(0, sx - full / 2 + 0.5 | 0), right = Math.min(width, left + square)
      const top = Math.max(0, sy - full / 2 + 0.5 | 0), bottom = Math.min(height, top + square)
      for (let row = top; row < bottom; ++row) {
        const inset = disc[row - top]
        for (let at = row * width + left + inset, stop = row * width + right - inset; at < stop; ++at)
          if (depth < depths[at]) depths[at] = depth, colours[at] = tint
      }
    }
  }

  drawWays(view, { matrix, near, now }, colour) {
    const { width, height } = this, { depths, colours } = this.drawn, tint = packed(colour), until = view.start + now
    const m = matrix
    const project = place => {
      const [x, y, z] = view.relative(place), [px, py, , depth] = [0, 1, 2, 3].map(k => m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k])
      return [width / 2 * (1 + px / depth), height / 2 * (1 - py / depth), depth]
    }
    for (const { places, times } of view.ways) {
      let before = null
      for (let k = 0; k < places.length && times[k] <= until; ++k) {
        const here = project(places[k])
        if (before && before[2] > near && here[2] > near) {
          const steps = Math.min(1e4, Math.ceil(Math.max(Math.abs(here[0] - before[0]), Math.abs(here[1] - before[1]), 1)))
          for (let s = 0; s <= steps; ++s) {
            const [x, y, depth] = before.map((v, j) => v + (here[j] - v) * s / steps)
            if (!(x >= 0 && x < width && y >= 0 && y < height)) continue
            const at = (y | 0) * width + (x | 0)
            if (depth < depths[at]) depths[at] = depth, colours[at] = tint
          }
        }
        before = here
      }
    }
  }

  /// What is drawn, with each pixel that many pixels wider and taller: nearer ones cover others.
  grown() {
    let from = this.drawn
    for (let size = 1, step; size <= this.growth; size += step) {
      step = Math.min(size, this.growth + 1 - size)
      for (const [shift, line] of [[step, this.width], [step * this.width, from.depths.length]]) {
        spread(from, this.wide, shift, line)
        from = this.wide
      }
    }
    return from
  }

  /// Same shading as `screenFragment` of the WebGL painter.
  show({ shading, sky }) {
    const { width, height, pixels, shades } = this, { depths, colours } = this.grown()
    for (let y = 0, at = 0; y < height; ++y) {
      const far = packed(sky[0].map((v, k) => v + (sky[1][k] - v) * y / height))
      const up = y > 0 ? width : 0, down = y + 1 < height ? width : 0
      for (let x = 0; x < width; ++x, ++at) {
        const here = depths[at]
        if (here === Infinity) {
          pixels[at] = far
          continue
        }
        const tint = colours[at]
        if (!shading) {
          pixels[at] = tint
          continue
        }
        const most = 0.0139 * here  // 0.02 octaves
        let behind = here - depths[at - up], sum = behind > 0 ? behind < most ? behind : most : 0
        behind = here - depths[at + down], sum += behind > 0 ? behind < most ? behind : most : 0
        behind = here - depths[x > 0 ? at - 1 : at], sum += behind > 0 ? behind < most ? behind : most : 0
        behind = here - depths[x + 1 < width ? at + 1 : at], sum += behind > 0 ? behind < most ? behind : most : 0
        if (sum === 0) {
          pixels[at] = tint
          continue
        }
        const shade = shades[sum / most * 63.75 | 0]
        pixels[at] = 0xff000000 | (tint >>> 16 & 255) * shade >> 8 << 16 | (tint >>> 8 & 255) * shade >> 8 << 8 | (tint & 255) * shade >> 8
      }
    }
    this.context.putImageData(this.image, 0, 0)
  }
}

/// Puts in each place what is `shift` places before it in its line, if that is nearer. From the last place on, so that it may be in itself.
function spread(from, to, shift, line) {
  const { depths, colours } = from, { depths: farther, colours: tints } = to
  for (let begin = 0; begin < depths.length; begin += line)
    for (let at = begin + line - 1; at >= begin; --at) {
      const source = at - shift >= begin && depths[at - shift] < depths[at] ? at - shift : at
      farther[at] = depths[source], tints[at] = colours[source]
    }
}

/// Red, green and blue, from 0 to 1, as one word of an image. Source: HTML Standard, ImageData, on little-endian machines.
const packed = ([r, g, b]) => (0xff000000 | Math.round(255 * b) << 16 | Math.round(255 * g) << 8 | Math.round(255 * r)) >>> 0

const mixed = (tint, [r, g, b], share) => {
  const mix = (from, to) => from + (to - from) * share & 255
  return (0xff000000 | mix(tint >>> 16 & 255, b) << 16 | mix(tint >>> 8 & 255, g) << 8 | mix(tint & 255, r)) >>> 0
}
