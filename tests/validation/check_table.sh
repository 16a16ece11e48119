#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Compares the table of a page with the rows that a test program prints. Usage: check_table.sh [--update] PROGRAM PAGE; with --update, the
# page ends with the rows that are printed.
#
# Compilers and processors round differently, so that figures are compared as numbers: expected and simulated ones may differ by a tenth of
# the tolerance, which is the last cell; the error before it, which has two digits, by a fifth. All else must be the same, and no error on
# the page may be above its tolerance.
set -u
export LC_ALL=C
update=
if [ "${1:-}" = --update ]; then
  update=yes
  shift
fi
[ $# -eq 2 ] || { echo "usage: check_table.sh [--update] PROGRAM PAGE" >&2; exit 2; }
program=$1 page=$2
name=$(basename "$program")
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

if ! "$program" > "$work/said"; then
  cat "$work/said"
  echo "$name: the tests fail"
  exit 1
fi
grep '^|' "$work/said" > "$work/printed"
grep '^|' "$page" > "$work/table"
case $(sed -n 2p "$work/table") in
  '|-'* | '| -'*) ;;
  *) echo "the table of $page has no head"; exit 1 ;;
esac

if [ -n "$update" ]; then
  { sed '/^|-/q; /^| -/q' "$page"; cat "$work/printed"; } > "$work/page" && cat "$work/page" > "$page"
  exit
fi

sed 1,2d "$work/table" | awk -F ' *[|] *' -v page="$page" -v name="$name" '
  function number(text) { return text ~ /^-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?$/ }
  function apart(a, b) { return a > b ? a - b : b - a }
  # Whether the cells of two rows say the same.
  function alike(a, b,    n, k, tolerance, share) {
    if (a == b) return 1
    n = split(a, left)
    if (split(b, right) != n || n < 6 || left[n - 1] != right[n - 1] || !number(left[n - 1])) return 0
    tolerance = left[n - 1] + 0
    for (k = 1; k <= n; ++k) {
      if (left[k] == right[k]) continue
      share = k == n - 2 ? 0.2 : k >= n - 4 ? 0.1 : 0
      if (share == 0 || !number(left[k]) || !number(right[k])) return 0
      if (apart(left[k] + 0, right[k] + 0) > share * tolerance * (1 + 1e-6)) return 0
    }
    return 1
  }
  NR == FNR { printed[++rows] = $0; next }
  {
    ++stand
    if (number($(NF - 1)) && number($(NF - 2)) && $(NF - 2) + 0 > 1.05 * $(NF - 1)) {
      print page " has an error above its tolerance:\n  " $0
      bad = 1
    }
    if (stand > rows || alike($0, printed[stand])) next
    print page " says:\n  " $0 "\n" name " prints:\n  " printed[stand]
    bad = 1
  }
  END {
    if (stand != rows) { print page " has " stand " rows, " name " prints " rows; bad = 1 }
    if (bad) print "check_table.sh --update writes the table anew"
    exit bad
  }' "$work/printed" -
