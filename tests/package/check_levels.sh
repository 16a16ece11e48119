#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Builds the program for x86-64 levels 1 and 3 and installs it. The loader must choose level 3, where the processor has it, and level 1 where
# it is told to; both must write the same bytes. Usage: check_levels.sh SOURCE FOLDER COMPILER
set -eu
source=$1 folder=$2 compiler=$3
rm -rf "$folder/prefix" "$folder/out"
mkdir -p "$folder"
cmake -S "$source" -B "$folder/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS=-O0 -DBUILD_TESTING=OFF "-DPULSECAST_LEVELS=1;3" > "$folder.log"
cmake --build "$folder/build" --target pulsecast_program >> "$folder.log"
for component in bin/pulsecast lib/pulsecast/libpulsecast.so lib/pulsecast/glibc-hwcaps/x86-64-v3/libpulsecast.so; do
  mkdir -p "$folder/prefix/$(dirname "$component")"
  cp "$folder/build/$(echo "$component" | sed 's|^bin|examples|')" "$folder/prefix/$component"
done

loader=$(ldd "$folder/prefix/bin/pulsecast" | sed -nE 's/^[[:space:]]*(\/[^ ]*ld-linux[^ ]*) .*/\1/p')
program() {  # program MASK ARGUMENT...: with the levels of the mask
  mask=$1
  shift
  "$loader" --glibc-hwcaps-mask "$mask" "$folder/prefix/bin/pulsecast" "$@"
}
says() {
  program "$1" --version | grep -q "instructions: $2$" || { echo "level '$1' is not $2: $(program "$1" --version)"; exit 1; }
}
says none baseline
if ! "$loader" --help | grep -q 'x86-64-v3 (supported'; then
  echo "this processor has no level 3: only level 1 was tried"
  exit 0
fi
says x86-64-v3 avx2
survey=$source/tests/examples/pulsecast/survey.xml
for level in none x86-64-v3; do
  program $level "$survey" --assets "$source/tests/examples/pulsecast" --output "$folder/out/$level" --seed 7 --gps-start-time 0 --write-waveform --calc-echowidth --quiet
done
[ -n "$(find "$folder/out/none" -type f -size +10k)" ]
diff -r "$folder"/out/none/*/* "$folder"/out/x86-64-v3/*/*  # below SURVEY/TIME, as the two runs may not start within one second
echo "levels 1 and 3 write the same bytes"
