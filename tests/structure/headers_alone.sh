#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Compiles each of a target's headers by itself, as far as it matters: in chains, each header after some of those that it includes, directly
# or through others. All that stands before a header is then what it would include anyhow, so that a name that it fails to include is
# missing as in a file of its own. Headers end without their definitions, as for users of pulsecast::compiled.
# Usage: headers_alone.sh INCLUDE "HEADER..." COMPILER [OPTION...], with headers as in an #include.
set -u
export LC_ALL=C
cd "$1" || exit 2
headers=$2
shift 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

# The chains, one a line: from the header that includes most, down to the one that includes least; printed the other way round.
# shellcheck disable=SC2046
awk -v headers="$headers" '
  function visit(header, top,    n, k, names) {  # all that `top` includes
    if ((top, header) in reached) return
    reached[top, header] = 1
    ++size[top]
    n = split(includes[header], names, " ")
    for (k = 1; k <= n; ++k) visit(names[k], top)
  }
  function largest(above,    k, best) {  # of those in no chain, the one that includes most, and is included by `above`
    for (k = 1; k <= count; ++k)
      if (!(list[k] in done) && (above == "" || (above, list[k]) in reached) && (best == "" || size[list[k]] > size[best])) best = list[k]
    return best
  }
  /^#if PULSECAST_DEFINES/, /^#endif/ { next }
  /^#include <pulsecast\// { gsub(/[<>]/, "", $2); includes[FILENAME] = includes[FILENAME] " " $2 }
  END {
    count = split(headers, list, " ")
    for (i = 1; i <= count; ++i) visit(list[i], list[i])
    while ((top = largest("")) != "") {
      chain = ""
      for (; top != ""; top = largest(top)) {
        done[top] = 1
        chain = top " " chain
      }
      print chain
    }
  }' $(find pulsecast -name '*.hpp') > "$work/chains"

number=0
failed=0
while read -r chain; do
  number=$((number + 1))
  for header in $chain; do echo "#include <$header>"; done > "$work/$number.cpp"
  "$@" -DPULSECAST_COMPILED -fsyntax-only "$work/$number.cpp" || { echo "not by itself: $chain"; failed=1; }
done < "$work/chains"
echo "$(echo "$headers" | wc -w) headers in $number chains"
[ "$number" -gt 0 ] && exit $failed
