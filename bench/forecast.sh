#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Holds what `pulsecast forecast` says against what runs come to, one after the other, in a table: points, memory and files with whether they
# are `in` the interval or `OUT` of it. Times are without loading, and those of runs are of the processors, by thread: they hardly depend on
# what else the machine does. Where writing takes longer than all else, as with waveforms, threads wait for the one that writes, and that
# figure says too little: ask for one thread.
# Usage: forecast.sh PROGRAM SURVEY.xml ... [-- OPTIONS], as in
#   bench/forecast.sh build/release/examples/pulsecast benchmark/surveys/*.xml -- --assets . --format las --seed 1 --threads 2
set -euo pipefail
program=$1
shift
surveys=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do surveys+=("$1"); shift; done
[ $# -eq 0 ] || shift
threads=2
previous=
for option in "$@"; do
  case $previous in -j | --threads) threads=$option ;; esac
  previous=$option
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

TIMEFORMAT='%R %U %S'
printf '%-12s %22s %34s %30s %30s %8s\n' survey 'simulating [s]' points 'memory [MB]' 'files [MB]' 'forecast [s]'
for survey in "${surveys[@]}"; do
  "$program" forecast "$survey" -v "$@" > "$folder/forecast" 2> "$folder/said" || { cat "$folder/said" >&2; exit 1; }
  { time "$program" info "$survey" "$@" > "$folder/info" 2> "$folder/said"; } 2> "$folder/time_to_load"
  rm -rf "$folder/output"
  { time "$program" "$survey" "$@" --output "$folder/output" > "$folder/run" 2> "$folder/said"; } 2> "$folder/time"
  bytes=$(find "$folder/output" -type f -printf '%s\n' | awk '{ sum += $1 } END { print sum + 0 }')
  awk -v survey="$(basename "$survey" .xml)" -v threads="$threads" -v bytes="$bytes" '
    function in_si(number, unit) {
      return number * (unit == "min" ? 60 : unit == "h" ? 3600 : unit == "kB" ? 1e3 : unit == "MB" ? 1e6 : unit == "GB" ? 1e9 : 1)
    }
    function against(forecast, actual, digits, low, high) {
      return sprintf("%." digits "f / %." digits "f (%+.1f %%%s)", forecast, actual, actual > 0 ? 100 * (forecast / actual - 1) : 0,
        high == "" ? "" : actual >= low && actual <= high ? ", in" : ", OUT")
    }
    # The ends of an interval, the last fields of a line as in `12.3 MB (11.0 to 13.5)`, in units of `size`.
    function interval(name, unit, size) {
      low[name] = in_si(substr($(NF - 2), 2), unit) / size
      high[name] = in_si(substr($NF, 1, length($NF) - 1), unit) / size
    }
    FILENAME ~ /forecast$/ && !seen[$1 $2]++ {
      if (/^  run time/) time = in_si($3, $4)
      if (/^  memory/) { memory = in_si($2, $3) / 1e6; interval("memory", $3, 1e6) }
      if (/^  points/) { points = $2; interval("points", "", 1) }
      if (/^  files/) { files = in_si($2, $3) / 1e6; interval("files", $3, 1e6) }
      if (/ s to load$/) loading = $(NF - 3)
      if (/^forecast in/) took = $3
    }
    FILENAME ~ /run$/ && $1 == "echoes" { echoes = $2 }
    FILENAME ~ /run$/ && $1 == "peak" { peak = $3 * 1.048576 }
    FILENAME ~ /load$/ { load = $2 + $3 }
    FILENAME ~ /time$/ { wall = $1; processor = $2 + $3 }
    END {
      printf "%-12s %22s %34s %30s %30s %8.2f   wall %.2f s\n", survey, against(time - loading, (processor - load) / threads, 2), against(points, echoes, 0, low["points"], high["points"]),
        against(memory, peak, 1, low["memory"], high["memory"]), against(files, bytes / 1e6, 1, low["files"], high["files"]), took, wall
    }' "$folder/forecast" "$folder/run" "$folder/time_to_load" "$folder/time"
done
