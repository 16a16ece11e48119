#version 300 es
// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
precision mediump float;
flat in vec3 tint;
flat in float wide;  // size of the point [px]
out vec4 colour;
void main() {
  if (wide > 3.5 && distance(gl_PointCoord, vec2(0.5)) > 0.5) discard;
  colour = vec4(tint, 1.0);
}
