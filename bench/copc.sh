#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# What COPC costs beside LAZ: the same points as both, in turns, by bench_copc; times, bytes and memory of each, and how many times longer
# COPC takes. Points take 62 bytes each of the disk meanwhile, and the file some 25. Usage: copc.sh [POINTS [THREADS [ROUNDS [BUILD]]]];
# 10000000, 2, 3 and build/release if not told.
set -euo pipefail
export LC_ALL=C
points=${1:-10000000} threads=${2:-2} rounds=${3:-3}
program=$(realpath "${4:-$(dirname "$0")/../build/release}")/bench/bench_copc
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for ((round = 0; round < rounds; ++round)); do
  for format in laz copc; do
    "$program" "$format" "$points" "$threads" "$folder/points.laz"
    rm "$folder/points.laz"
  done | tee "$folder/told"
  awk '{ time[$1] = $4; processors[$1] = $12 }
       END { printf "copc takes %.2f times the time of laz, and %.2f times that of processors\n",
                    time["copc"] / time["laz"], processors["copc"] / processors["laz"] }' "$folder/told"
done
