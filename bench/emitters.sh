#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of a pulse in the surveys of emitters.cpp, and compares the device of two alternating divergences with the mean of
# those of one. Needs g++ and valgrind. Usage: emitters.sh
set -euo pipefail
cd "$(dirname "$0")/.."
bash bench/count.sh emitters emitters |
  awk '{ count[$1] = $2 / 2000 }
       END {
         mean = (count["narrow"] + count["wide"]) / 2
         if (!(mean > 0 && count["both"] > 0)) { print "nothing was counted"; exit 1 }
         printf "instructions a pulse: narrow %.1f, wide %.1f, alternating %.1f; ratio to their mean %.4f\n", count["narrow"],
                count["wide"], count["both"], count["both"] / mean
       }'
