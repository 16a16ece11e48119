#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Fails unless recipes.awk takes recipes up to the limit of their chapter, and refuses longer ones. Usage: limits.sh AWK
set -u
failed=0

# page CHAPTER LINES: one recipe of so many lines.
page() {
  printf '# Cookbook\n\n```cpp\nint shared;\n```\n\n## %s\n\n### A recipe\n\n```cpp\n#include <vector>\n' "$1"
  seq "$2" | sed 's/.*/++shared;/'
  printf '```\n'
}

taken() {
  page "$1" "$2" | "$awk" -f cookbook/recipes.awk > /dev/null 2>&1
}

awk=$1
for chapter in 'Extensions 12' 'Scenes 15' 'Runs 15'; do
  limit=${chapter#* }
  taken "${chapter% *}" "$limit" || { echo "refused: $limit lines in $chapter"; failed=1; }
  ! taken "${chapter% *}" $((limit + 1)) || { echo "taken: $((limit + 1)) lines in $chapter"; failed=1; }
done
exit $failed
