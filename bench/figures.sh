#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Writes docs/tables/performance.md anew from the benchmarks of a build. Takes some ten minutes; nothing else should run.
# Usage: figures.sh [BUILD [OBJ]]; build/release by default, and no OBJ file besides the scenes made by code.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
files=("${@:2}")
page=docs/tables/performance.md
tables=$(mktemp)
trap 'rm -f "$tables"' EXIT

# take NAME ARGUMENTS...: the tables of bench_NAME under a heading.
take() {
  echo "taking $1" >&2
  printf '\n## %s\n\n' "$1" >> "$tables"
  "$build/bench/bench_$1" --markdown "${@:2}" >> "$tables"
}
take trace --only '*/19/*' --only '*/incoherent/*' "${files[@]}"
take build "${files[@]}"
take pipeline --only '*/19/'
take detect --only '*/19/*' --only 'plane/1/*'
take write
take scale
take short_cuts
echo "taking needs" >&2
printf '\n## needs\n\n' >> "$tables"
bash bench/needs.sh "$build" >> "$tables"
{ sed '/^## /Q' "$page" | sed '$d'; cat "$tables"; } > "$page.new"
mv "$page.new" "$page"
