#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of a pulse in the surveys of emitters.cpp, and compares the device of two alternating divergences with the mean of
# those of one. Needs g++ and valgrind. Usage: emitters.sh
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${CXX:-g++}" -std=c++20 -O2 -DNDEBUG -Iinclude bench/emitters.cpp -o "$folder/emitters" -pthread
valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect='emitters_*' "$folder/emitters" > "$folder/said" 2>&1 ||
  { cat "$folder/said" >&2; exit 1; }
callgrind_annotate --inclusive=yes --threshold=100 "$folder/out" |
  sed -nE 's/^ *([0-9,]+) .*:emitters_([a-z]+)( .*|$)/\2 \1/p' | tr -d , |
  awk '{ count[$1] = $2 / 2000 }
       END {
         mean = (count["narrow"] + count["wide"]) / 2
         if (!(mean > 0 && count["both"] > 0)) { print "nothing was counted"; exit 1 }
         printf "instructions a pulse: narrow %.1f, wide %.1f, alternating %.1f; ratio to their mean %.4f\n", count["narrow"],
                count["wide"], count["both"], count["both"] / mean
       }'
