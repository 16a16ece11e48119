#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Takes the figures of docs/tables/tradeoff.md anew: runs bench_tradeoff of a build, draws docs/pictures/tradeoff_*.svg with gnuplot (Debian package:
# gnuplot-nox), and writes the page. Takes some five minutes; nothing else should run. Errors and their
# intervals do not depend on the machine; `--rounds 1 --seconds 0` takes them without times worth looking at.
# Usage: tradeoff.sh [BUILD [OPTION]...]; build/release if not told. Options go to bench_tradeoff, as `--only facade`, to try something out: then
# the pictures are left in BUILD and the tables printed, and the page stays as it is.
# Leaves BUILD/tradeoff.csv and BUILD/tradeoff_edges.csv.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
page=docs/tables/tradeoff.md pictures=docs/pictures
[ $# -le 1 ] || page="" pictures=$build
command -v gnuplot > /dev/null || { echo "tradeoff.sh: gnuplot is not there (Debian package: gnuplot-nox)" >&2; exit 1; }
[ -x "$build/bench/bench_tradeoff" ] || { echo "tradeoff.sh: there is no $build/bench/bench_tradeoff; build it first" >&2; exit 1; }
csv=$build/tradeoff.csv edges=$build/tradeoff_edges.csv
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$build/bench/bench_tradeoff" --markdown --rounds 7 --seconds 0.04 "${@:2}" "$csv" "$edges" > "$work/rows"
echo "drawing" >&2
gnuplot -e "csv='$csv'; edges='$edges'; pictures='$pictures'" bench/study/tradeoff.gp 2> "$work/warnings" || { cat "$work/warnings" >&2; exit 1; }

has() { grep -q "^$1," "$csv"; }

# The rows of a scenario that the page shows, as a table; figures to three digits.
table() {
  awk -F, -v scenario="$1" '
    function interval(x, low, high) { return rounded(x) (rounded(low) == "" ? "" : " [" rounded(low) ", " rounded(high) "]") }
    function rounded(x) {
      if (x == "nan" || x == "-nan") return ""
      size = x < 0 ? -x : x
      if (size < 0.0005) x = size = 0
      return sprintf(size >= 100 || size == 0 ? "%.0f" : size >= 10 ? "%.1f" : size >= 1 ? "%.2f" : "%.3f", x)
    }
    NR == 1 || $1 != scenario { next }
    $2 == "default" { standard = $4 " " $5; plants = $23 != "nan" && $23 != "-nan" }
    $2 == "subrays" && $3 == standard { next }
    $2 == "both" || ($2 == "subrays" && $4 != "rings" && $5 !~ /^(1|4|7|9|19|37|279)$/) { next }
    $2 == "subrays" && $4 == "rings" && $5 !~ /^(1|7|19|37|279)$/ { next }
    $2 == "subrays" && $5 == 1 && $4 != "lattice" { next }
    !headed++ {
      print "| knob | setting | ns a pulse | MiB | range: bias, mm | root mean square, mm | 95 % within, mm | echoes missed, % | invented, % | both, % |" \
            " intensity, % | width, ps | echoes, % |" (plants ? " gap fraction, % | height at 95 %, m |" : "")
      print "|---|---|---|---|---|---|---|---|---|---|---|---|---|" (plants ? "---|---|" : "")
    }
    {
      line = "| " ($2 == last ? "" : $2) " | " $3 " |"
      last = $2
      split("8 10 11 13 14 15 16 17 19 21 22 23 25", columns, " ")
      low[13] = 30; low[17] = 32; low[19] = 34  # columns of intervals
      for (i = 1; i <= (plants ? 13 : 11); ++i) {
        column = columns[i]
        line = line " " (column in low ? interval($column, $low[column], $(low[column] + 1)) : rounded($column)) " |"
      }
      print line
    }' "$csv"
}

# Rings beside lattices of at most half as many subrays, on edges and wires.
halves() {
  awk -F, '
    function with_interval(k) { return sprintf("%.2f [%.2f, %.2f]", $k, $(k == 13 ? 30 : k == 17 ? 32 : 34), $(k == 13 ? 31 : k == 17 ? 33 : 35)) }
    $1 == "facade" && $2 == "subrays" {
      range[$3] = with_interval(13); within[$3] = $14; wrong[$3] = with_interval(17); intensity[$3] = with_interval(19); time[$3] = $8
    }
    function row(name) {
      printf "| %s | %.0f | %s | %.2f | %s | %s |\n", name, time[name], range[name], within[name], wrong[name], intensity[name]
    }
    END {
      print "| footprint | ns a pulse | range: root mean square, mm | 95 % within, mm | echoes missed or invented, % | intensity, % |"
      print "|---|---|---|---|---|---|"
      split("rings 7,lattice 3,lattice 4,rings 19,lattice 9,rings 37,lattice 18,rings 62,lattice 31,rings 279,lattice 19", names, ",")
      for (i = 1; i in names; ++i) row(names[i])
    }' "$csv"
}

{
  head -n 1 "$work/rows"
  if has facade; then
    printf '\n## Rings and lattices on the facade\n\n'
    halves
  fi
  printf '\n## Rankings\n\nErrors of a setting by those of another: intervals of 95 %%. One with 1 inside is no ranking.\n\n'
  grep -m 1 -A 1 '^| | range, from' "$work/rows" || true
  grep '^| `[a-z_]*: ' "$work/rows" || true
  awk '/^float against double/ { print "\n## Float against double\n"; inside = 1 } inside' "$work/rows"
  for scenario in terrain wood_tripod wood_drone street facade step; do
    has "$scenario" || continue
    printf '\n## `%s`\n\n' "$scenario"
    table "$scenario"
  done
} > "$work/tables"
if [ -z "$page" ]; then
  cat "$work/tables"
  exit
fi
{ sed '/^`tradeoff`/Q' "$page"; cat "$work/tables"; } > "$work/page"
cat "$work/page" > "$page"
echo "done: $page, docs/pictures/tradeoff_*.svg, $csv" >&2
