# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# For scripts that disturb runs: what a run leaves that is let alone, and how long it takes. Sourced where `program`, `survey`, `fail` and
# `sums` are set, in an empty folder; sets `options`, `run`, `expected` by format, and `duration` [ms].
options=("$survey" --gpsStartTime 1577836800 --threads 2 --quiet)
run() { "$program" "${options[@]}" --output "$1" --format "$2" "${@:3}"; } # run OUTPUT FORMAT [OPTION...]

declare -A expected
for format in las xyz; do
  run whole_$format $format || fail "the run that is let alone failed"
  expected[$format]=$(sums whole_$format)
  [ "$(wc -l <<< "${expected[$format]}")" = 16 ] || fail "16 files were expected, not ${expected[$format]}"
done
begin=$(date +%s%N)
run measured las || fail "a run failed"
duration=$((($(date +%s%N) - begin) / 1000000))
