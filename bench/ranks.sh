#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# What many processes bring and cost: a survey by one process of one thread under mpirun, and by PROCESSES (2), alternately; time of the run
# as the program tells it, time of processors, messages and bytes per million pulses. Nothing else should run, and times mean something only
# where each process has a processor. Usage: ranks.sh SURVEY [ASSETS [BUILD [PAIRS [FORMAT...]]]]; the folder the survey is in,
# build/release, 5 pairs and las laz if not told.
# Each process has a session of its own, so that a system that shares processors among sessions gives each a share.
set -euo pipefail
export LC_ALL=C
survey=$(realpath "$1") assets=${2:-$(dirname "$1")} pairs=${4:-5}
program=$(realpath "${3:-$(dirname "$0")/../build/release}")/examples/pulsecast
formats=("${@:5}") processes=${PROCESSES:-2}
[ ${#formats[@]} -gt 0 ] || formats=(las laz)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
launch=(mpirun --oversubscribe --bind-to none)
[ "$(id -u)" = 0 ] && launch+=(--allow-run-as-root)

# once PROCESSES FORMAT: "run [s] all [s] processors [s] messages MiB pulses"; the program's own time is without start and scene.
once() {
  rm -rf "$folder/out"
  TIMEFORMAT='%R %U %S'
  { time "${launch[@]}" -n "$1" setsid -w "$program" "$survey" --assets "$assets" --seed 1 --threads 1 --format "$2" \
      --gpsStartTime 1577836800 --output "$folder/out" > "$folder/told" 2> /dev/null; } 2> "$folder/time"
  awk '$1 == "time" { run = $2 } $1 == "messages" { messages = $2; mib = $6 } $1 == "pulses" { pulses = $2 }
       FILENAME ~ /time$/ { all = $1; cpu = $2 + $3 } END { print run, all, cpu, messages, mib, pulses }' "$folder/told" "$folder/time"
  (cd "$folder/out" && find . -type f -exec md5sum {} + | sed 's| .*/| |' | sort | md5sum) > "$folder/sum_$1"
}

for format in "${formats[@]}"; do
  echo "$(basename "$survey"), $format"
  echo "  1 process: run, all, processors [s]    $processes processes: run, all, processors [s]   times faster: run, all" \
       "  messages  KiB per 10^6 pulses"
  for ((pair = 0; pair < pairs; ++pair)); do
    read -r run1 all1 cpu1 _ <<< "$(once 1 "$format")"
    read -r run2 all2 cpu2 messages mib pulses <<< "$(once "$processes" "$format")"
    cmp -s "$folder/sum_1" "$folder/sum_$processes" || { echo "the bytes differ"; exit 1; }
    awk -v a="$run1 $all1 $cpu1" -v b="$run2 $all2 $cpu2" -v m="$messages" -v k="$mib" -v p="$pulses" 'BEGIN {
      split(a, x); split(b, y)
      printf "  %10.2f %8.2f %8.2f %20.2f %8.2f %8.2f ", x[1], x[2], x[3], y[1], y[2], y[3]
      printf "%23.2f %6.2f %15.1f %8.1f\n", x[1] / y[1], x[2] / y[2], m / p * 1e6, k * 1024 / p * 1e6 }'
  done
done
