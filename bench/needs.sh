#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# What a program pays for what it holds: size of its code, and time of a pulse, of programs that do the same work and hold more or less
# besides; medians of rounds in which they take turns. Usage: needs.sh [BUILD], the folder of a build; prints a table.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
everything="$build/bench/bench_needs_everything"

code() { size "$1" | awk 'NR == 2 { print $1 }'; }  # with constants [byte]
none=$(code "$build/bench/bench_needs_nothing")

for task in first_hit full_waveform; do
  for _ in 1 2 3 4 5 6 7 8 9; do
    "$build/bench/bench_needs_$task" >> "$work/$task"
    "$everything" "$task" >> "$work/$task.everything"
  done
  [ "$(cut -d' ' -f2 "$work/$task" "$work/$task.everything" | sort -u | wc -l)" = 1 ] || { echo "$task: not the same work"; exit 1; }
done

median() { sort -n | sed -n 5p; }

# row WHAT BYTES FILE OTHER: the median of FILE's rounds, and that of their ratios to OTHER's.
row() {
  local time ratio
  time=$(cut -d' ' -f1 "$3" | median)
  ratio=$(paste -d' ' "$3" "$4" | awk '{ print $1 / $3 }' | median)
  printf '| %s | %d | %.0f | %.2f |\n' "$1" $((($2 - none) / 1024)) "$time" "$ratio"
}

echo '| program and task | code, KiB | ns a pulse | time, against the program made for the task |'
echo '|---|---|---|---|'
row 'one mesh, first hits: `needs_first_hit`' "$(code "$build/bench/bench_needs_first_hit")" "$work/first_hit" "$work/first_hit"
row 'one mesh, full waveforms of 19 subrays: `needs_full_waveform`' "$(code "$build/bench/bench_needs_full_waveform")" \
    "$work/full_waveform" "$work/full_waveform"
row 'everything, asked for first hits: `needs_everything`' "$(code "$everything")" "$work/first_hit.everything" "$work/first_hit"
row 'everything, asked for full waveforms: `needs_everything`' "$(code "$everything")" "$work/full_waveform.everything" \
    "$work/full_waveform"
program="$build/examples/pulsecast"
[ ! -x "$program" ] || printf '| the survey program, with XML, files and all: `pulsecast` | %d | | |\n' $((($(code "$program") - none) / 1024))
