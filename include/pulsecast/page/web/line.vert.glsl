#version 300 es
// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
layout(location = 0) in vec3 place;
uniform mat4 camera;
uniform vec3 line;
flat out vec3 tint;
flat out float wide;
void main() {
  gl_Position = camera * vec4(place, 1.0);
  tint = line;
  wide = 0.0;
}
