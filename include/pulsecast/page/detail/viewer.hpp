// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <pulsecast/page/detail/attributes.hpp>
#include <pulsecast/page/detail/painters.hpp>
#include <pulsecast/page/detail/panel.hpp>
#include <pulsecast/page/detail/script.hpp>

namespace pulsecast::page {

/// What a page is made of, but for the survey and its points: up to its style, and from there to where the survey's texts stand.
inline constexpr std::string_view page_head = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline';
  connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>pulsecast</title>
<style>
:root {
  --paper: #ffffff; --ink: #1d252c; --quiet: #66727d; --line: #dde2e7; --press: #eef2f5;
  --accent: #0d7c86; --accent-ink: #ffffff; --sky: #e9eef2; --ground: #f8fafb; --way: #c2571a; --fresh: #d8430b;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #161b20; --ink: #e3e8ec; --quiet: #8b98a4; --line: #2a323a; --press: #212931;
    --accent: #4fc3c8; --accent-ink: #0d1518; --sky: #0b0e11; --ground: #1a2128; --way: #f2a65a; --fresh: #ffffff;
  }
}
* { box-sizing: border-box }
[hidden] { display: none !important }
html, body { height: 100%; margin: 0 }
body {
  display: grid; grid-template: minmax(0, 1fr) auto / minmax(0, 1fr) 292px; grid-template-areas: "stage panel" "timeline panel";
  background: var(--paper); color: var(--ink); font: 13px/1.45 system-ui, "Segoe UI", Roboto, "Noto Sans", sans-serif;
  font-variant-numeric: tabular-nums; -webkit-text-size-adjust: 100%;
}
#stage { grid-area: stage; position: relative; overflow: hidden; background: var(--ground) }
#stage canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block }
#view { touch-action: none; cursor: grab; outline: none }
#view:active { cursor: grabbing }
#view:focus-visible { box-shadow: inset 0 0 0 2px var(--accent) }
#marks { pointer-events: none }
#wait { position: absolute; inset: 0; display: grid; place-items: center; padding: 2em; text-align: center; color: var(--quiet) }
#tools { position: absolute; right: 12px; top: 12px; display: flex; gap: 6px }
button, select {
  font: inherit; color: inherit; background: var(--paper); border: 1px solid var(--line); border-radius: 6px;
  padding: 4px 10px; cursor: pointer;
}
button:hover, select:hover { background: var(--press) }
:is(button, select, input, summary):focus-visible { outline: 2px solid var(--accent); outline-offset: 1px }
#panel {
  grid-area: panel; border-left: 1px solid var(--line); overflow: hidden auto; padding: 18px 18px 12px; display: flex;
  flex-direction: column; gap: 18px;
}
h1 { font-size: 17px; font-weight: 600; line-height: 1.25; margin: 0 0 3px; overflow-wrap: anywhere }
h2 {
  font-size: 11px; font-weight: 600; letter-spacing: .07em; text-transform: uppercase; color: var(--quiet); margin: 0 0 8px;
  display: flex; justify-content: space-between; align-items: baseline;
}
h2 button { font-size: 11px; padding: 1px 8px; letter-spacing: 0; text-transform: none; font-weight: 400 }
p { margin: 0; overflow-wrap: anywhere }
.quiet { color: var(--quiet) }
#attributes { display: flex; flex-wrap: wrap; gap: 5px }
#attributes button { padding: 3px 9px; border-radius: 99px }
#attributes [aria-checked=true] { background: var(--accent); border-color: var(--accent); color: var(--accent-ink) }
#histogram { display: block; width: 100%; height: 84px; cursor: crosshair; touch-action: none; margin-top: 12px }
.ends { display: flex; justify-content: space-between; color: var(--quiet); margin-top: 3px }
#kinds { margin-top: 12px; max-height: 260px; overflow: hidden auto }
.kind {
  display: grid; grid-template-columns: auto 10px 1fr auto; align-items: center; column-gap: 7px; padding: 3px 0 1px; cursor: pointer;
}
.kind i { width: 10px; height: 10px; border-radius: 3px }
.kind span { overflow: hidden; text-overflow: ellipsis; white-space: nowrap }
.kind em { font-style: normal; color: var(--quiet) }
.kind b { grid-column: 3 / 5; height: 2px; border-radius: 1px; min-width: 1px }
input { accent-color: var(--accent); margin: 0 }
dl { display: grid; grid-template-columns: auto 1fr; margin: 0; gap: 2px 14px }
dt { color: var(--quiet) }
dd { margin: 0; text-align: right; overflow-wrap: anywhere }
.row { display: grid; grid-template-columns: 84px 1fr; align-items: center; gap: 10px; padding: 2px 0 }
.row input[type=checkbox] { justify-self: start }
footer { margin-top: auto; font-size: 11px; color: var(--quiet) }
summary { cursor: pointer }
kbd { font: inherit; border: 1px solid var(--line); border-radius: 4px; padding: 0 4px }
#keys { display: grid; grid-template-columns: auto 1fr; gap: 3px 10px; margin-top: 8px }
#timeline { grid-area: timeline; border-top: 1px solid var(--line); display: flex; align-items: center; gap: 14px; padding: 10px 16px }
#play {
  width: 36px; height: 36px; border-radius: 50%; padding: 0; display: grid; place-items: center; flex: none; background: var(--accent);
  border-color: var(--accent);
}
#play::before {
  content: ""; width: 11px; height: 12px; margin-left: 3px; background: var(--accent-ink); clip-path: polygon(0 0, 100% 50%, 0 100%);
}
#play[data-playing=true]::before { margin-left: 0; clip-path: polygon(0 0, 35% 0, 35% 100%, 65% 100%, 65% 0, 100% 0, 100% 100%, 0 100%) }
#track { position: relative; flex: 1; min-width: 60px; height: 36px }
#density { position: absolute; left: 0; right: 0; top: 0; width: 100%; height: 24px }
#slider {
  -webkit-appearance: none; appearance: none; position: absolute; left: -8px; bottom: 0; width: calc(100% + 16px); height: 20px;
  margin: 0; background: none; cursor: pointer; --share: 100%;
}
#slider::-webkit-slider-runnable-track {
  height: 3px; border-radius: 2px; background: linear-gradient(90deg, var(--accent) var(--share), var(--line) var(--share));
}
#slider::-webkit-slider-thumb {
  -webkit-appearance: none; width: 16px; height: 16px; margin-top: -6.5px; border-radius: 50%; background: var(--accent);
  border: 3px solid var(--paper); box-shadow: 0 0 0 1px var(--accent);
}
#slider::-moz-range-track { height: 3px; border-radius: 2px; background: var(--line) }
#slider::-moz-range-progress { height: 3px; border-radius: 2px; background: var(--accent) }
.clock { white-space: nowrap; text-align: right }
.clock span { display: block }
#live { display: grid; gap: 8px }
#meter { height: 4px; border-radius: 2px; background: var(--line); overflow: hidden }
#bar { display: block; height: 100%; width: 0; background: var(--accent); transition: width .3s }
@media (max-width: 720px) {
  body { grid-template: minmax(0, 1fr) auto minmax(0, 38vh) / minmax(0, 1fr); grid-template-areas: "stage" "timeline" "panel" }
  #panel { border-left: 0; border-top: 1px solid var(--line); padding: 12px 16px; gap: 14px }
  #speed { display: none }
}
@media (max-height: 420px) { #panel { gap: 10px; padding-top: 10px } }
@media (prefers-reduced-motion: reduce) { #bar { transition: none } }
</style>
</head>
<body>
<main id="stage">
  <canvas id="view" tabindex="0"
    aria-label="The point cloud. Arrow keys turn it, plus and minus zoom, shift and arrow keys move it."></canvas>
  <canvas id="marks" aria-hidden="true"></canvas>
  <div id="tools"><button id="fit" title="Show everything (Home)">Fit</button><button id="top" title="From above (T)">Top</button></div>
  <p id="wait">Reading the points …</p>
</main>
<aside id="panel">
  <header>
    <h1 id="name"></h1>
    <p class="quiet" id="device"></p>
    <p class="quiet" id="amount"></p>
  </header>
  <section id="live" hidden>
    <div id="meter"><span id="bar"></span></div>
    <p id="progress" role="status">Waiting for the first pulses …</p>
    <button id="stop">Stop the run</button>
  </section>
  <section>
    <h2>Colour by</h2>
    <div id="attributes" role="radiogroup" aria-label="Colour by"></div>
    <div id="amounts">
      <canvas id="histogram" role="img" aria-label="Histogram of the attribute" title="Drag to show a part"></canvas>
      <div class="ends"><span id="least"></span><button id="all" hidden>Show all</button><span id="most"></span></div>
    </div>
    <div id="kinds" hidden></div>
  </section>
  <section id="pick" hidden>
    <h2>Point <button id="close">Close</button></h2>
    <dl id="point"></dl>
  </section>
  <p class="quiet" id="hint">Click a point to read its attributes.</p>
  <section>
    <h2>Drawing</h2>
    <label class="row">Point size <input id="size" type="range" min="0.5" max="6" step="0.1" value="1"></label>
    <label class="row">Shading <input id="shading" type="checkbox" checked></label>
  </section>
  <footer>
    <details><summary>Hands and keys</summary><div id="keys">
      <span>drag, <kbd>←</kbd><kbd>↑</kbd><kbd>→</kbd><kbd>↓</kbd></span><span>turn</span>
      <span>right drag, <kbd>Shift</kbd></span><span>move</span>
      <span>wheel, <kbd>+</kbd> <kbd>−</kbd></span><span>zoom</span>
      <span>click</span><span>read a point</span>
      <span>double click</span><span>go there</span>
      <span><kbd>Home</kbd> <kbd>T</kbd></span><span>show all, from above</span>
      <span><kbd>Space</kbd></span><span>play</span>
      <span><kbd>1</kbd> … <kbd>9</kbd></span><span>colour by</span>
      <span><kbd>[</kbd> <kbd>]</kbd> <kbd>E</kbd></span><span>point size, shading</span>
      <span><kbd>Esc</kbd></span><span>let go</span>
    </div></details>
  </footer>
</aside>
<nav id="timeline" aria-label="Time">
  <button id="play" aria-label="Play"></button>
  <div id="track">
    <canvas id="density" aria-hidden="true"></canvas>
    <input id="slider" type="range" min="0" max="10000" value="10000" aria-label="Time of the acquisition">
  </div>
  <div class="clock"><span id="time">0.00 s</span><span class="quiet" id="whole_time"></span></div>
  <select id="speed" aria-label="Speed">
    <option value="10">in 10 s</option><option value="20" selected>in 20 s</option>
    <option value="60">in 60 s</option><option value="real">real time</option>
  </select>
</nav>
<script type="application/json" id="survey">)html";

inline constexpr std::string_view page_before_points = "</script>\n<script type=\"application/octet-stream\" id=\"points\">";
inline constexpr std::string_view page_before_scripts = "</script>\n<script>";
inline constexpr std::string_view page_end = "</script>\n</body>\n</html>\n";

/// The scripts in the order in which they run.
inline constexpr std::string_view page_scripts[] = {page_points_script, page_painters_script, page_view_script, page_attributes_script,
                                                    page_panel_script};

}  // namespace pulsecast::page
