#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# What the library costs its users in compile time: processor seconds, the least of five runs; the ratio to what a plain set of standard
# headers takes, which hardly depends on the machine; and the most memory. Usage: include_cost.sh [COMPILER...]. Needs GNU time (Debian
# package: time).
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
printf '#include <%s>\n' algorithm array cmath cstdint functional memory optional span string thread vector > "$folder/standard.cpp"
echo '#include <pulsecast/concepts.hpp>' > "$folder/contract.cpp"
echo '#include <pulsecast/pulsecast.hpp>' > "$folder/pulsecast.cpp"
find include/pulsecast -name '*.hpp' -regextype posix-extended ! -regex '.*/(io|helios|mpi|page|python)/.*' | sort | sed 's|^include/\(.*\)|#include <\1>|' > "$folder/core.cpp"

# row WHAT FLAGS...: compiles with FLAGS five times. What the first row takes is the unit of the ratios.
row() {
  for _ in 1 2 3 4 5; do
    /usr/bin/time -f '%U %M' -o "$folder/cost" "$compiler" -std=c++20 -Iinclude "${@:2}"
    cat "$folder/cost"
  done | sort -n | awk -v unit="$unit" -v row="| $compiler | $1 |" '
    NR == 1 { printf "%s %.2f | %.1f | %.0f |\n", row, $1, unit ? $1 / unit : 1, $2 / 1024 }'
}

echo '| compiler | what | seconds | ratio | MB |'
echo '|---|---|---|---|---|'
for compiler in "${@:-g++}"; do
  unit=
  row 'include the standard headers' -fsyntax-only "$folder/standard.cpp" | tee "$folder/unit"
  unit=$(awk -F '|' '{ print $4 }' "$folder/unit")
  row 'include concepts.hpp' -fsyntax-only "$folder/contract.cpp"
  row 'include pulsecast.hpp' -fsyntax-only "$folder/pulsecast.cpp"
  row 'include every header of the core' -fsyntax-only "$folder/core.cpp"
  for library in '' -DPULSECAST_COMPILED; do
    with=${library:+, pulsecast::compiled}
    row "compile examples/embed.cpp with -O2$with" -O2 $library -c examples/embed.cpp -o "$folder/embed.o"
    row "compile bench/obj_to_las.cpp with -O2$with" -O2 -DTINYOBJLOADER_USE_DOUBLE $library -c bench/obj_to_las.cpp -o "$folder/obj_to_las.o"
    row "compile examples/survey.cpp with -O2$with" -O2 -DTINYOBJLOADER_USE_DOUBLE -I/usr/include/eigen3 $library -c examples/survey.cpp \
      -o "$folder/survey.o"
  done
done
