#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Writes docs/tables/performance.md and the table of docs/robotics.md anew from the programs of a build, in some eleven minutes on two cores;
# nothing else should run. The first lines of the page tell day, machine and load. Usage: figures.sh [BUILD]; build/release by default.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$(realpath "${1:-build/release}")
day=$(date +'%-d %B %Y')
load=$(cut -d' ' -f1 /proc/loadavg)  # before the first program
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tables=$folder/tables

# take NAME ARGUMENTS...: the tables of bench_NAME under a heading.
take() {
  echo "taking $1 ($SECONDS s)" >&2
  printf '\n## %s\n\n' "$1"
  "$build/bench/bench_$1" --markdown "${@:2}"
}

{
  take program "$build/examples/pulsecast"
  take trace --rounds 5 --only '*/Bvh<float>' --only '*/19/*' --only '*/incoherent/*'
  take build --rounds 5
  take pipeline
  take slots
  take detect --rounds 5 --only '*/19/*' --only 'plane/1/*'
  take whole_surveys --rounds 5
  take batch --rounds 5
  take robots
  take robot_kit
  take write --rounds 5
  take scale --rounds 5
  take short_cuts
  echo "taking needs ($SECONDS s)" >&2
  printf '\n## needs\n\n'
  bash bench/needs.sh "$build"
} > "$tables"

# of EXAMPLE PATTERN [OPTION...]: the number before a pattern in the output of an example, the median of three runs.
of() {
  for _ in 1 2 3; do
    "$build/examples/$1" --output "$folder" "${@:3}" | sed -nE "s/.* ([0-9.]+) $2.*/\1/p"
  done | sort -g | sed -n 2p
}
echo "taking robots ($SECONDS s)" >&2
scans=$(of robot 'scans per second' --scans 300) step=$(of robot_loop 'ms, the longest')
{
  printf '| what | measured on %s, load %s | command |\n|---|---|---|\n' "$day" "$load"
  sed -nE 's/^\| `(ten VLP-16[^`]*)` \| ([^ ]+) \| ([^ ]+) \| .*/| \1, 2.9 million pulses a second | \2 times real time, the slowest second \3 | `bench_robots` |/p' "$tables"
  sed -nE 's/^\| `kit, 2 threads` \| ([^ ]+) \| [^|]+ \| [^|]+ \| ([^ ]+) \| .*/| a VLP-16, prisms at 200 kHz, a flat scanner and an inertial sensor at 400 Hz, 12 moving cars, 100 steps a second, two threads | \1 times real time, \2 allocations a step | `bench_robot_kit` |/p' "$tables"
  printf '| whole turns of 32 x 1,024 pulses to point records, 300 along the street | %.0f scans/s | `robot` |\n' "$scans"
  printf '| a step of 20 cars and a sixth of a turn, 4,822 pulses | %.1f ms | `robot_loop` |\n' "$step"
  sed -nE 's/^\| `(street, [0-9]+ poses, [^`]*)` \| ([^ ]+) \| .*/| \1, as a batch | \2 scans\/s | `bench_batch` |/p' "$tables"
} > "$folder/robots"

page=docs/tables/performance.md
{
  sed '/^Measured on /Q' "$page"
  printf 'Measured on %s, on a load of %s.\n' "$day" "$load"
  cat "$tables"
} > "$folder/page"
# The first table below the heading of speed gives way to the new one.
awk -v rows="$folder/robots" '
  /^## / { below = /Speed$/ }
  below && /^\|/ { if (!done++) while ((getline line < rows) > 0) print line; next }
  { print }' docs/robotics.md > "$folder/robotics"
cp "$folder/page" "$page"
cp "$folder/robotics" docs/robotics.md
echo "written in $SECONDS s" >&2
