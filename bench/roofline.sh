#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Roofline of the surveys of roofline.cpp, as a table: operations and bytes a pulse, the time of a perfect program, and that measured. Operations
# are those on floating-point numbers, by lane, a fused one counted as two; bytes are those of the cache lines fetched into the first level, of
# 48 kB, and from beyond the second, of 1 MB, after a run that warms the caches. A perfect program does these operations at the measured peak of
# one thread, and meanwhile fetches these bytes at theirs: it takes the longer of the two. Needs g++, objdump, valgrind and a processor with AVX2.
# Usage: roofline.sh [OPTIONS of bench_roofline]
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
flags="-O3 -DNDEBUG -mavx2 -mfma"
"${CXX:-g++}" -std=c++20 $flags -static -no-pie -DPULSECAST_BENCH_FLAGS="\"$flags\"" -Iinclude bench/roofline.cpp -o "$folder/roofline" -pthread
objdump -d --no-show-raw-insn "$folder/roofline" > "$folder/code"
for survey in tree street hills; do
  valgrind --tool=callgrind --dump-instr=yes --compress-pos=no --cache-sim=yes --D1=49152,12,64 --LL=1048576,16,64 \
    --toggle-collect='roofline_counted*' --callgrind-out-file="$folder/$survey" "$folder/roofline" --once $survey > "$folder/said" 2>&1 ||
    { cat "$folder/said" >&2; exit 1; }
done
"$folder/roofline" "$@" > "$folder/times"
sed -n 's/^\(machine\|compiler\|flags\): */\1: /p' "$folder/times"
sed -n '/^peak/,/^surveys/ s/^  *\(.*[^ ]\) \+\([0-9.]\+\) *$/peak, \1 a ns: \2/p' "$folder/times"
printf '| survey | instructions | float operations | double operations | bytes into the first level | bytes from beyond the second | ns, perfect | ns, measured |\n'
printf '|---|---|---|---|---|---|---|---|\n'
for survey in tree street hills; do
  awk -v survey=$survey '
    FILENAME ~ /times$/ {
      if (/operations in float/) peak["s"] = $4
      if (/operations in double/) peak["d"] = $4
      if (/bytes of the second/) near = $6
      if (/bytes of memory/) far = $4
      if (/^surveys of/) pulses = $3
      if ($1 == survey) measured = $2
    }
    FILENAME ~ /code$/ && $2 ~ /^v?(add|sub|mul|div|min|max|sqrt|cmp[a-z_]*|round|rcp|fn?m(add|sub)[0-9]+)[ps][sd]$/ {
      type = substr($2, length($2))
      size = type == "s" ? 4 : 8
      lanes = $2 ~ /s.$/ && $2 !~ /p.$/ ? 1 : ($0 ~ /%ymm/ ? 32 : 16) / size
      address = "0x" substr($1, 1, length($1) - 1)
      of[address] = type
      operations[address] = lanes * ($2 ~ /^vfn?m/ ? 2 : 1)
    }
    FILENAME ~ survey "$" {
      if (/^calls=/) { called = 1; next }
      if (called) { called = 0; next }
      if ($1 !~ /^0x/) next
      instructions += $3
      into += $7 + $8
      from += $10 + $11
      if ($1 in of) sum[of[$1]] += $3 * operations[$1]
    }
    END {
      computing = sum["s"] / peak["s"] + sum["d"] / peak["d"]
      fetching = 64 * into / near
      if (64 * from / far > fetching) fetching = 64 * from / far
      perfect = computing > fetching ? computing : fetching
      printf "| %s | %.0f | %.0f | %.0f | %.0f | %.1f | %.0f | %.0f |\n", survey, instructions / pulses, sum["s"] / pulses, sum["d"] / pulses,
        64 * into / pulses, 64 * from / pulses, perfect / pulses, measured
    }' "$folder/times" "$folder/code" "$folder/$survey"
done
