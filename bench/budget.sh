#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of every part of the programs below, which do not depend on what else the machine does, and fails if there are
# more than budget.txt allows. Each part is counted at the x86-64 baseline and with AVX2. Usage: budget.sh [--update], which writes
# budget.txt anew and keeps its limit. Needs g++ and valgrind. Counts of different compilers cannot be compared: with another than the one
# on record, nothing is checked.
set -euo pipefail
cd "$(dirname "$0")/.."
compiler=${CXX:-g++}
budget=bench/budget.txt
name="$("$compiler" --version | head -n 1)"
if [ "${1:-}" != --update ] && ! grep -qxF "# $name" "$budget"; then
  echo "nothing to compare: $budget is of $(sed -n 's/^# //p' "$budget" | head -n 1), this is $name"
  exit 0
fi
levels=baseline
if grep -qw avx2 /proc/cpuinfo; then
  levels="baseline AVX2"
elif [ "${1:-}" = --update ]; then
  echo "this processor has no AVX2, for which $budget has a column" >&2
  exit 1
else
  echo "AVX2 is not counted: this processor has none"
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

programs='instructions call_instructions'

# count LEVEL: writes lines "PART COUNT". The mathematical functions of the C library differ by processor. The baseline is counted with
# those that every processor has; for AVX2, valgrind shows the same processor wherever there is AVX2, and the C library chooses for it.
count() {
  local flags='' tunables=glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-AVX512VL,-AVX512BW,-ERMS,-SSE4_1,-SSE4_2
  if [ "$1" = AVX2 ]; then
    flags='-mavx2 -mfma' tunables=''
  fi
  local of
  for program in $programs; do
    of=$folder/$program.$1
    # shellcheck disable=SC2086
    "$compiler" -std=c++20 -O2 -DNDEBUG $flags -Iinclude "bench/$program.cpp" -o "$of" -pthread
    GLIBC_TUNABLES=$tunables LD_BIND_NOW=1 valgrind --tool=callgrind --callgrind-out-file="$of.out" --toggle-collect='budget_*' \
      "$of" > "$of.said" 2>&1 || { cat "$of.said" >&2; return 1; }
    callgrind_annotate --inclusive=yes --threshold=100 "$of.out" |
      sed -nE 's/^ *([0-9,]+) .*:budget_([a-z_]+)( .*|$)/\2 \1/p' | tr -d , >> "$folder/$1.counts"
  done
}
count baseline & baseline=$!
case $levels in *AVX2) count AVX2 ;; esac
wait $baseline

# One line a part: its name, and its count at each level.
# shellcheck disable=SC2046,SC2086
parts=$(sed -nE 's/.*\bbudget_([a-z_]+)\(const.*/\1/p' $(printf 'bench/%s.cpp ' $programs))
for part in $parts; do
  line=$part
  for level in $levels; do
    line="$line $(awk -v part="$part" '$1 == part { print $2 }' "$folder/$level.counts")"
  done
  echo "$line"
done > "$folder/counts"

if [ "${1:-}" = --update ]; then
  {
    echo "# $name"
    sed -n '/^# [a-z ]*%/p; /^limit /p' "$budget"
    echo '# part, millions of instructions: baseline, AVX2'
    awk '{ printf "%-15s %11.6f %11.6f\n", $1, $2 / 1e6, $3 / 1e6 }' "$folder/counts"
  } > "$folder/budget.txt"
  cp "$folder/budget.txt" "$budget" && cat "$budget"
  exit 0
fi

# Every part that is on record is counted, and every part that is counted is on record.
awk -v levels="$levels" '
  BEGIN { split(levels, level, " ") }
  FNR == NR && $1 == "limit" { limit = $2; limits++; next }
  FNR == NR && /^#/ { next }
  FNR == NR { record[$1] = $0; next }
  { counted[$1] = $0 }
  {
    if (!($1 in record)) { print $1 ": not on record"; above = 1; next }
    split(record[$1], recorded, " ")
    delete record[$1]
    for (i = 1; i in level; ++i) {
      more = recorded[i + 1] > 0 && $(i + 1) > 0 ? 100 * ($(i + 1) / (1e6 * recorded[i + 1]) - 1) : 100
      verdict = more > limit ? ", above the limit" : ""
      if (verdict) above = 1
      printf "%-15s %-8s %10.4f million instructions, %10.4f on record: %+.3f %%%s\n", $1, level[i], $(i + 1) / 1e6, recorded[i + 1], more, verdict
    }
  }
  END {
    split(counted["glossy_surfaces"], glossy, " ")
    split(counted["matt_surfaces"], matt, " ")
    for (i = 1; i in level; ++i)
      if (matt[i + 1] > 0) printf "glossy over matt %-8s %.3f\n", level[i], glossy[i + 1] / matt[i + 1]
    for (part in record) { print part ": on record, but not counted"; above = 1 }
    if (limits != 1) { print "bench/budget.txt has no limit"; above = 1 }
    exit above
  }' "$budget" "$folder/counts" || {
  echo "more than $(awk '$1 == "limit" { print $2 }' "$budget") % above the record; if that is worth it: bash bench/budget.sh --update"
  exit 1
}
