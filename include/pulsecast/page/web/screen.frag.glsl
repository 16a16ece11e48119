#version 300 es
// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
precision highp float;
uniform sampler2D colours;
uniform highp sampler2D depths;
uniform vec4 lens;  // near, far, reach [px], strength
uniform vec3 above, below;
uniform float height;
out vec4 colour;
float depth(ivec2 at) {
  float d = texelFetch(depths, clamp(at, ivec2(0), textureSize(depths, 0) - 1), 0).r;
  return d == 1.0 ? 1e3 : log2(lens.x * lens.y / (lens.y - d * (lens.y - lens.x)));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float here = depth(at);
  if (here == 1e3) {
    colour = vec4(mix(below, above, gl_FragCoord.y / height), 1.0);
    return;
  }
  int r = int(lens.z);
  float behind = 0.0;
  behind += clamp(here - depth(at + ivec2(r, 0)), 0.0, 0.02);
  behind += clamp(here - depth(at - ivec2(r, 0)), 0.0, 0.02);
  behind += clamp(here - depth(at + ivec2(0, r)), 0.0, 0.02);
  behind += clamp(here - depth(at - ivec2(0, r)), 0.0, 0.02);
  colour = vec4(texelFetch(colours, at, 0).rgb * exp(-lens.w * behind), 1.0);
}
