#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Holds the time left that a run says after its first 5 s against the time that it takes, in a table with the median of the errors. The clock of
# a run is its processor time on one thread, so that other load does not count, slowed down so that each survey takes some 50 s by it.
# Usage: remaining.sh PROGRAM SURVEY.xml ... [-- OPTIONS], as in
#   bench/remaining.sh build/release/examples/pulsecast benchmark/surveys/*.xml -- --assets . --format las --seed 1
set -euo pipefail
program=$1
shift
surveys=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do surveys+=("$1"); shift; done
[ $# -eq 0 ] || shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cat > "$folder/clock.c" <<'END'
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_gettime(clockid_t id, struct timespec* t) {
  const int of_thread = id == CLOCK_THREAD_CPUTIME_ID;
  if (id != CLOCK_MONOTONIC && !of_thread) return (int)syscall(SYS_clock_gettime, id, t);
  const long status = syscall(SYS_clock_gettime, of_thread ? id : CLOCK_PROCESS_CPUTIME_ID, t);
  const double seconds = ((double)t->tv_sec + 1e-9 * (double)t->tv_nsec) * atof(getenv("SLOWED_BY"));
  t->tv_sec = (time_t)seconds;
  t->tv_nsec = (long)(1e9 * (seconds - (double)t->tv_sec));
  return (int)status;
}
END
cc -O2 -shared -fPIC -o "$folder/clock.so" "$folder/clock.c"

# take SURVEY SLOWED_BY OPTIONS...: runs it, and prints the time that it takes by its clock [s].
take() {
  rm -rf "$folder/output"
  LD_PRELOAD=$folder/clock.so SLOWED_BY=$2 "$program" "$1" "${@:3}" --threads 1 --output "$folder/output" > "$folder/run" 2> "$folder/said" ||
    { cat "$folder/said" >&2; exit 1; }
  awk '$1 == "time" { print $2 }' "$folder/run"
}

for survey in "${surveys[@]}"; do
  slowed=$(awk -v seconds="$(take "$survey" 1 "$@")" 'BEGIN { print 50 / seconds }')
  seconds=$(take "$survey" "$slowed" "$@")
  awk -v survey="$(basename "$survey" .xml)" -v slowed="$slowed" -v seconds="$seconds" '
    / s left/ && !said { said = 1; print survey, slowed, $1, $3, seconds - 5, 100 * ($3 / (seconds - 5) - 1) }' "$folder/said"
done > "$folder/rows"
printf '%-16s %10s %16s %14s %16s %12s\n' survey 'slowed by' 'said done [%]' 'said left [s]' 'actual left [s]' 'error [%]'
awk '{ printf "%-16s %10.1f %16d %14d %16.1f %+12.0f\n", $1, $2, $3, $4, $5, $6 }' "$folder/rows"
awk '{ print $6 < 0 ? -$6 : $6 }' "$folder/rows" | sort -g |
  awk '{ error[NR] = $1 } END { printf "median of the errors: %.0f %%\n", (error[int((NR + 1) / 2)] + error[int(NR / 2) + 1]) / 2 }'
