#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of a pulse in the surveys of any_target.cpp, of a scene alone and as one of several types of maps. Needs g++ and
# valgrind. Usage: any_target.sh
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${CXX:-g++}" -std=c++20 -O2 -DNDEBUG -Iinclude bench/any_target.cpp -o "$folder/any_target" -pthread
valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect='target_*' "$folder/any_target" > "$folder/said" 2>&1 ||
  { cat "$folder/said" >&2; exit 1; }
callgrind_annotate --inclusive=yes --threshold=100 "$folder/out" |
  sed -nE 's/^ *([0-9,]+) .*:target_([a-z]+)_([a-z]+)( .*|$)/\3 \2 \1/p' | tr -d , |
  awk '{ count[$1, $2] = $3 / 2000; ++found }
       END {
         if (found != 4) { print "nothing was counted"; exit 1 }
         for (k = split("single bundle", beams, " "); k > 0; --k) {
           alone = count[beams[k], "alone"]
           any = count[beams[k], "any"]
           printf "instructions a pulse, %s: alone %.1f, one of several %.1f; %.1f more\n", beams[k], alone, any, any - alone
         }
       }'
