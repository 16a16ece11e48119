#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# What the library costs its users in compile time: processor seconds, the median of five runs. Usage: include_cost.sh [COMPILER...]
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo '#include <pulsecast/pulsecast.hpp>' > "$folder/everything.cpp"
echo '#include <pulsecast/concepts.hpp>' > "$folder/contract.cpp"
TIMEFORMAT='%U %S'

# row WHAT FLAGS...: compiles with FLAGS five times.
row() {
  seconds=$(for _ in 1 2 3 4 5; do { time "$compiler" -std=c++20 -Iinclude "${@:2}"; } 2>&1; done |
            awk '{ printf "%.2f\n", $1 + $2 }' | sort -n | sed -n 3p)
  echo "| $compiler | $1 | $seconds |"
}

echo '| compiler | what | seconds |'
echo '|---|---|---|'
for compiler in "${@:-g++}"; do
  row 'include concepts.hpp' -fsyntax-only "$folder/contract.cpp"
  row 'include pulsecast.hpp' -fsyntax-only "$folder/everything.cpp"
  row 'compile examples/embed.cpp with -O2' -O2 -c examples/embed.cpp -o "$folder/embed.o"
done
