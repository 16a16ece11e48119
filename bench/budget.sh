#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of tracing and of whole surveys, which do not depend on what else the machine does, and fails if there are more
# than 3 % more than budget.txt says. Usage: budget.sh [--update], which writes budget.txt. Needs g++ and valgrind.
# Counts of different compilers cannot be compared: with another than the one on record, nothing is checked.
set -euo pipefail
cd "$(dirname "$0")/.."
compiler=${CXX:-g++}
budget=bench/budget.txt
name="$("$compiler" --version | head -n 1)"
if [ "${1:-}" != --update ] && ! grep -qxF "# $name" "$budget"; then
  echo "nothing to compare: $budget is of $(sed -n 's/^# //p' "$budget" | head -n 1), this is $name"
  exit 0
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$compiler" -std=c++20 -O2 -DNDEBUG -Iinclude bench/instructions.cpp -o "$folder/instructions" -pthread

# The mathematical functions of the C library differ by processor; here they are those that every processor has.
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-AVX512VL,-AVX512BW,-ERMS,-SSE4_1,-SSE4_2

count() {  # PART
  valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect="budget_$1" "$folder/instructions" "$1" \
    > "$folder/said" 2>&1 || { cat "$folder/said" >&2; exit 1; }
  awk '/^(summary|totals):/ { sum = $2 } END { print sum }' "$folder/out"
}

status=0
echo "# $name" > "$folder/budget.txt"
for part in trace pipeline; do
  counted=$(count "$part")
  echo "$part $counted" >> "$folder/budget.txt"
  [ "${1:-}" != --update ] || continue
  recorded=$(awk -v part="$part" '$1 == part { print $2 }' "$budget")
  awk -v part="$part" -v counted="$counted" -v recorded="$recorded" 'BEGIN {
    printf "%-9s %.4g million instructions, %.4g on record: %+.2f %%\n", part, counted / 1e6, recorded / 1e6, 100 * (counted / recorded - 1)
    exit counted > 1.03 * recorded
  }' || status=1
done
if [ "${1:-}" = --update ]; then
  cp "$folder/budget.txt" "$budget" && cat "$budget"
elif [ $status -ne 0 ]; then
  echo "more than 3 % above the budget; if that is worth it: bash bench/budget.sh --update"
fi
exit $status
