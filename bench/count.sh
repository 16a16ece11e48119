#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of the functions PREFIX_NAME of a benchmark, with all that they call, and prints lines "NAME COUNT", by the pulse if
# their number is told. Needs g++ and valgrind. Usage: count.sh BENCHMARK PREFIX [PULSES], as in `count.sh scene_update update`
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${CXX:-g++}" -std=c++20 -O2 -DNDEBUG -Iinclude "bench/$1.cpp" -o "$folder/$1" -pthread
valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect="$2_*" "$folder/$1" > "$folder/said" 2>&1 ||
  { cat "$folder/said" >&2; exit 1; }
callgrind_annotate --inclusive=yes --threshold=100 "$folder/out" | sed -nE "s/^ *([0-9,]+) .*:$2_([a-z_]+)( .*|\$)/\\2 \\1/p" | tr -d , |
  awk -v pulses="${3:-1}" '{ printf "%s %.*f\n", $1, (pulses > 1), $2 / pulses; ++found } END { if (!found) { print "nothing was counted"; exit 1 } }'
