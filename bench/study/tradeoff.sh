#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Takes the figures of docs/tables/tradeoff.md anew by bench_tradeoff of a build, and draws docs/pictures/tradeoff.svg with
# gnuplot (Debian package: gnuplot-nox). Takes some seven minutes; nothing else should run. Only times depend on the machine.
# Usage: tradeoff.sh [BUILD [OPTION]...]; build/release if not told. Options go to bench_tradeoff, as `--only facade`, to
# try something out: then the tables are printed, and page and picture stay as they are.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
page=docs/tables/tradeoff.md
program=$build/bench/bench_tradeoff
[ -x "$program" ] || { echo "tradeoff.sh: there is no $program; build it first" >&2; exit 1; }
[ $# -le 1 ] || exec "$program" --markdown --rounds 9 --seconds 0.01 "${@:2}"
command -v gnuplot > /dev/null || { echo "tradeoff.sh: gnuplot is not there (Debian package: gnuplot-nox)" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sed '/^`tradeoff`/Q' "$page" > "$work/page"
"$program" --markdown --rounds 9 --seconds 0.01 "$work/scores.csv" >> "$work/page"
gnuplot -e "csv='$work/scores.csv'; picture='docs/pictures/tradeoff.svg'" bench/study/tradeoff.gp
cat "$work/page" > "$page"
