#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Figures of the Python module: its time against C++'s for the same survey, turn by turn, in user mode; the memory of 10 million points, as
# rows and by column; the memory of many surveys in a loop. Usage: python.sh [BUILD [SURVEY.xml [ASSETS]...]], as in
#   bench/python.sh build/release benchmark/surveys/als_hills.xml .
# ROUNDS, THREADS and SURVEYS say how many of each (5, 2, 200).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "${1:-$here/../build/release}" && pwd)
export PYTHONPATH=$build/examples/python PYTHONDONTWRITEBYTECODE=1
python=$(sed -n 's/^_*Python_EXECUTABLE:[A-Z]*=//p' "$build/CMakeCache.txt" | head -n 1)
python=${python:-/usr/bin/python3}
cmake --build "$build" --target pulsecast_program python_rows python_core own_scanner > /dev/null
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$python" "$here/python_figures.py" survey "$folder/survey.xml" "${@:2}"
assets=("${@:3}")
[ $# -ge 2 ] || assets=("$here/../tests/examples/pulsecast")
"$python" "$here/python_figures.py" time "$build/examples/pulsecast" "$build/examples/python/python_rows" \
  "$folder/survey.xml" "${THREADS:-2}" "${ROUNDS:-5}" "$folder/output" "${assets[@]}"
"$python" "$here/python_figures.py" memory 10000000
"$python" "$here/python_figures.py" memory 10000000 columns
"$python" "$here/python_figures.py" loop "${SURVEYS:-200}" "$here/../tests/examples/pulsecast"
