#version 300 es
// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
layout(location = 0) in vec3 place;
layout(location = 1) in float time;
layout(location = 2) in vec4 colour;
uniform mat4 camera;
uniform vec3 size;   // px at a depth of 1 m, least, most
uniform vec2 now;    // what is later is not there yet, and what is as much earlier is no longer new [s]
uniform vec3 fresh;  // colour of what is new
uniform vec4 plane;  // middle of the slice: normal, distance from the origin [m]
uniform float reach; // half of its thickness [m]
flat out vec3 tint;
flat out float wide;
void main() {
  gl_Position = camera * vec4(place, 1.0);
  if (time > now.x || colour.a == 0.0 || abs(dot(plane.xyz, place) - plane.w) > reach) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // out of sight
  gl_PointSize = wide = clamp(size.x / gl_Position.w, size.y, size.z);
  tint = mix(colour.rgb, fresh, now.y > 0.0 ? 0.85 * clamp(1.0 - (now.x - time) / now.y, 0.0, 1.0) : 0.0);
}
