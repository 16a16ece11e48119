// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// ------------------------------------------------------------------------------------------------------------ the view

const vectorDot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

/// Camera at a distance from its target. Azimuth 0 looks north, elevation 0 along the ground. [m, rad]
class Camera {
  constructor() {
    Object.assign(this, { target: [0, 0, 0], azimuth: 0.5, elevation: 0.6, distance: 100, extent: 100, field: 0.7, width: 1, height: 1 })
  }

  /// Axes of the view: right, up and forward.
  axes() {
    const [s, c] = [Math.sin(this.azimuth), Math.cos(this.azimuth)], [e, f] = [Math.sin(this.elevation), Math.cos(this.elevation)]
    return [[c, -s, 0], [s * e, c * e, f], [s * f, c * f, -e]]
  }

  eye() {
    const forward = this.axes()[2]
    return this.target.map((t, k) => t - this.distance * forward[k])
  }

  get near() { return Math.max(this.distance / 200, this.extent * 1e-5) }
  get far() { return this.distance + 4 * this.extent }

  /// Size of one metre at a depth of one metre [px].
  get scale() { return this.height / 2 / Math.tan(this.field / 2) }

  /// Matrix from positions to clip space, by columns.
  matrix() {
    const [r, u, f] = this.axes(), eye = this.eye(), { near, far } = this
    const y = 1 / Math.tan(this.field / 2), x = y * this.height / this.width
    const a = (far + near) / (far - near), b = -2 * far * near / (far - near)
    const er = -vectorDot(r, eye), eu = -vectorDot(u, eye), ef = -vectorDot(f, eye)
    return new Float32Array([x * r[0], y * u[0], a * f[0], f[0], x * r[1], y * u[1], a * f[1], f[1],
                             x * r[2], y * u[2], a * f[2], f[2], x * er, y * eu, a * ef + b, ef])
  }

  /// Position of a point on the screen [px], and its depth along the view [m].
  project(p) {
    const [r, u, f] = this.axes(), eye = this.eye(), d = [p[0] - eye[0], p[1] - eye[1], p[2] - eye[2]]
    const depth = vectorDot(f, d), s = this.scale / depth
    return [this.width / 2 + s * vectorDot(r, d), this.height / 2 - s * vectorDot(u, d), depth]
  }

  turn(right, up) {
    this.azimuth -= right
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + up))
  }

  /// Moves the target parallel to the screen, by pixels at its depth.
  pan(right, up) {
    const [r, u] = this.axes(), metre = this.distance / this.scale
    this.target = this.target.map((t, k) => t - (right * r[k] + up * u[k]) * metre)
  }

  /// Zooms by a factor, towards the point at a pixel.
  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const before = this.distance
    this.distance = Math.min(20 * this.extent, Math.max(this.extent * 1e-4, before / factor))
    const moved = 1 - this.distance / before
    this.pan((this.width / 2 - x) * before / this.distance * moved, (y - this.height / 2) * before / this.distance * moved)
  }

  fit(least, most) {
    this.target = least.map((l, k) => (l + most[k]) / 2)
    const radius = Math.max(0.5 * Math.hypot(...least.map((l, k) => most[k] - l)), 1e-3)
    this.extent = 2 * radius
    this.distance = 0.92 * radius / Math.sin(this.field / 2) * Math.max(1, 0.8 * this.height / this.width)
  }
}

/// Draws the points and the trajectories. While the view moves, the number of points is limited so that `rate` frames a second are drawn.
/// At rest, the others follow until all are drawn.
class View {
  constructor(canvas, points) {
    this.points = points
    this.camera = new Camera()
    this.now = Infinity
    this.trail = 0
    this.pointSize = 1
    this.spacing = 0.1  // distance between points [m]
    this.shading = true
    this.adaptive = true
    this.rate = 45
    this.budget = 500000  // points per frame
    this.done = 0         // share of the points drawn
    this.drawn = 0        // number of points drawn
    this.start = 0        // start of the survey's time [s]
    this.origin = null    // origin of the drawn coordinates, in the world [m]
    this.ways = []
    this.slab = { plane: [0, 0, 0, 0], reach: 1 }  // what is drawn: normal and distance from `origin` of its middle, half thickness; this is all [m]
    this.afterFrame = () => {}
    this.colourOf = (chunk, order, out) => out.fill(255)
    this.lastFrame = 0
    this.movedAt = -Infinity
    this.waiting = false
    this.painter = GlPainter.on(canvas) ?? new PlainPainter(canvas)
    this.canvas = this.painter.canvas
    new ResizeObserver(() => this.resize()).observe(this.canvas)
    this.resize()
  }

  resize() {
    const { canvas, camera } = this, ratio = Math.min(window.devicePixelRatio || 1, 2)
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio))
    if (camera.width !== width || camera.height !== height) this.resizeTo(width, height, ratio)
  }

  resizeTo(width, height, ratio) {
    const { canvas, camera } = this
    canvas.width = camera.width = width
    canvas.height = camera.height = height
    this.ratio = ratio
    this.painter.resize(width, height)
    this.redraw()
  }

  /// Draws all points at `scale` times the resolution of the screen, shows that to `take`, and returns to the screen.
  picture(scale, take) {
    const { camera: { width, height }, ratio, adaptive } = this
    this.resizeTo(width * scale, height * scale, ratio * scale)
    Object.assign(this, { adaptive: false, movedAt: -Infinity })
    this.drawFrame(performance.now())
    take()
    this.adaptive = adaptive
    this.resizeTo(width, height, ratio)
  }

  /// Frames all points but outliers, with trajectories near them. The first call sets the origin to their centre.
  fit() {
    const { points, camera } = this
    if (points.count === 0) return
    const ranges = ['x', 'y', 'z'].map(name => points.usual(name, 0.001)), middle = ranges.map(([least, most]) => (least + most) / 2)
    const [longest, across, least] = ranges.map(([a, b]) => b - a).sort((a, b) => b - a)
    const area = Math.max(longest * across, (longest || 1) ** 2 * 1e-4)
    this.spacing = Math.sqrt(area / Math.max(points.count, 1)) * (1 + least / Math.max(longest, 1e-9))
    for (const { places } of this.ways)
      for (const place of places)
        if (place.every((v, k) => Math.abs(v - middle[k]) < Math.max(longest, 1)))
          ranges.forEach((r, k) => { r[0] = Math.min(r[0], place[k]), r[1] = Math.max(r[1], place[k]) })
    this.origin ??= middle
    camera.fit(ranges.map((r, k) => r[0] - this.origin[k]), ranges.map((r, k) => r[1] - this.origin[k]))
    this.redraw()
  }

  relative(place) { return place.map((v, k) => v - this.origin[k]) }

  /// Sets the trajectories of the legs: [{ name, places, times }].
  setWays(ways) {
    this.ways = ways
    this.painter.waysAreOld = true
  }

  recolour() {
    for (const chunk of this.points.chunks) chunk.coloursAreOld = true
    this.redraw()
  }

  /// Redraws the view. With `moves`, it is in motion: the frame rate is kept and fewer points are drawn.
  redraw(moves = false) {
    this.done = 0
    if (moves) this.movedAt = performance.now()
    this.wake()
  }

  wake() {
    if (this.waiting) return
    this.waiting = true
    requestAnimationFrame(time => {
      this.waiting = false
      if (this.painter.busy()) this.wake()
      else this.drawFrame(time)
    })
  }

  /// Whether the slice holds a place in the world.
  inSlab([x, y, z]) {
    const { plane: [nx, ny, nz, middle], reach } = this.slab, [ox, oy, oz] = this.origin
    return Math.abs(nx * (x - ox) + ny * (y - oy) + nz * (z - oz) - middle) <= reach
  }

  /// Whether any of the box of a chunk is in the picture and the slice.
  inSight(chunk, matrix) {
    const { plane, reach } = this.slab, half = chunk.most.map((v, k) => (v - chunk.least[k]) / 2)
    const away = vectorDot(plane, chunk.least.map((v, k) => v + half[k] - this.origin[k])) - plane[3]
    if (Math.abs(away) > reach + vectorDot(plane.map(Math.abs), half)) return false
    const outside = [0, 0, 0, 0, 0, 0]
    for (let corner = 0; corner < 8; ++corner) {
      const p = [0, 1, 2].map(k => (corner >> k & 1 ? chunk.most : chunk.least)[k] - this.origin[k])
      const [x, y, z, w] = [0, 1, 2, 3].map(k => matrix[k] * p[0] + matrix[4 + k] * p[1] + matrix[8 + k] * p[2] + matrix[12 + k])
      for (const [side, out] of [x < -w, x > w, y < -w, y > w, z < -w, z > w].entries()) if (out) ++outside[side]
    }
    return !outside.includes(8)
  }

  /// Updates the vertex arrays of a chunk's positions and colours.
  prepare(chunk) {
    const { points, painter } = this
    if (!chunk.placesAreOld && !chunk.coloursAreOld) return
    const order = points.order(chunk)
    if (chunk.placesAreOld) {
      const { x, y, z, time } = points.arrays, [ox, oy, oz] = this.origin, places = new Float32Array(4 * chunk.count)
      for (let i = 0; i < chunk.count; ++i) {
        const p = chunk.first + order[i]
        places[4 * i] = x[p] - ox, places[4 * i + 1] = y[p] - oy, places[4 * i + 2] = z[p] - oz, places[4 * i + 3] = time[p] - this.start
      }
      painter.takePlaces(chunk, places)
      chunk.placesAreOld = false
    }
    if (chunk.coloursAreOld) {
      const colours = new Uint8Array(4 * chunk.count)
      this.colourOf(chunk, order, colours)
      painter.takeColours(chunk, colours)
      chunk.coloursAreOld = false
    }
  }

  /// Adapts the number of points per frame to the frame rate, from the last frame's duration [ms].
  keepPace(interval) {
    const wanted = 1000 / this.rate
    if (interval > 1.15 * wanted) this.budget = Math.max(20000, this.budget * Math.max(0.5, wanted / interval))
    else if (interval < 0.95 * wanted && this.done < 1) this.budget = Math.min(2e7, this.budget * Math.min(1.2, wanted / interval))
  }

  drawFrame(time) {
    const { camera, points, painter } = this, slow = 1.5 * (time - this.lastFrame)
    const moving = time - this.movedAt < Math.min(1000, Math.max(150, slow))
    if (moving && this.wasMoving && this.adaptive && this.lastDone === 0) this.keepPace(time - this.lastFrame)
    if (!moving && this.coarse) this.done = 0, this.coarse = false
    this.wasMoving = moving
    this.lastFrame = time
    this.lastDone = this.done
    if (this.done === 0) {
      painter.clear()
      this.drawn = 0
    }
    if (this.origin && points.count > 0 && this.done < 1) {
      const matrix = camera.matrix()
      const look = { matrix, near: camera.near, now: this.now, trail: this.now < Infinity ? this.trail : 0, ratio: this.ratio,
                     fresh: this.freshColour ?? [1, 1, 1], slab: this.slab }
      if (this.done === 0) painter.drawWays(this, look, this.wayColour ?? [1, 1, 1])
      const seen = points.chunks.filter(c => c.begin - this.start <= this.now && this.inSight(c, matrix))
      const total = seen.reduce((sum, c) => sum + c.count, 0)
      const wanted = moving ? this.budget : Math.max(this.budget, 250000)
      const next = !this.adaptive || total === 0 ? 1 : Math.min(1, this.done + wanted / total)
      const sparse = moving ? Math.min(1.6, 1 / Math.sqrt(next)) : 1  // fewer points, larger ones
      this.coarse ||= sparse > 1
      look.size = 1.1 * sparse * this.pointSize * this.spacing * camera.scale  // at a depth of a metre
      look.least = 1.5 * sparse * this.ratio * this.pointSize
      look.most = 10 * this.ratio * this.pointSize
      look.many = total * next > camera.width * camera.height / 4
      for (const chunk of seen) {
        const first = Math.floor(chunk.count * this.done), end = Math.floor(chunk.count * next)
        if (end <= first) continue
        this.prepare(chunk)
        painter.draw(chunk, first, end, look)
        this.drawn += end - first
      }
      this.done = next
    }
    painter.show({ near: camera.near, far: camera.far, shading: this.shading, sky: this.sky ?? [[0, 0, 0], [0, 0, 0]], ratio: this.ratio })
    this.afterFrame(time)
    if (moving || (this.done < 1 && points.count > 0 && this.origin)) this.wake()
  }

  /// Index of the point drawn at a pixel, of several within a few pixels the foremost; -1 without one.
  pick(x, y, reach = 7 * this.ratio) {
    if (!this.origin) return -1
    const { camera, points } = this, [r, u, f] = camera.axes(), eye = camera.eye().map((v, k) => v + this.origin[k])
    const { near, scale } = camera, { x: px, y: py, z: pz, time } = points.arrays, until = this.start + this.now
    const right = x - camera.width / 2, up = camera.height / 2 - y
    let best = -1, cost = Infinity
    const matrix = camera.matrix()
    for (const chunk of points.chunks) {
      if (!this.inSight(chunk, matrix)) continue
      for (let i = chunk.first, end = i + chunk.count; i < end; ++i) {
        const dx = px[i] - eye[0], dy = py[i] - eye[1], dz = pz[i] - eye[2]
        const depth = f[0] * dx + f[1] * dy + f[2] * dz
        if (!(depth > near)) continue
        const sx = (r[0] * dx + r[1] * dy) * scale / depth - right  // the right axis of the view is level
        if (sx > reach || sx < -reach) continue
        const sy = (u[0] * dx + u[1] * dy + u[2] * dz) * scale / depth - up
        const away = Math.hypot(sx, sy)
        if (away > reach || time[i] > until || this.hides?.(i) || !this.inSlab([px[i], py[i], pz[i]])) continue
        const c = depth * (1 + 0.004 * (away / this.ratio) ** 2)  // front to back, with a penalty for distance from the pixel
        if (c < cost) cost = c, best = i
      }
    }
    return best
  }
}
