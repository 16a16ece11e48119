#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Fails unless recipes.awk takes recipes up to the limit of their page, and refuses longer ones. Usage: limits.sh AWK
set -u
failed=0

# page TITLE LINES: one recipe of so many lines.
page() {
  printf '# %s\n\n```cpp\nint shared;\n```\n\n### A recipe\n\n```cpp\n#include <vector>\n' "$1"
  seq "$2" | sed 's/.*/++shared;/'
  printf '```\n'
}

taken() {
  page "$1" "$2" | "$awk" -f cookbook/recipes.awk > /dev/null 2>&1
}

awk=$1
for page in 'Extensions 12' 'Cookbook 15'; do
  limit=${page#* }
  taken "${page% *}" "$limit" || { echo "refused: $limit lines in ${page% *}"; failed=1; }
  ! taken "${page% *}" $((limit + 1)) || { echo "taken: $((limit + 1)) lines in ${page% *}"; failed=1; }
done
exit $failed
