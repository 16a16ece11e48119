#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of a pulse in the surveys of light.cpp: of a street with matt and with specular windows. Needs g++ and
# valgrind. Usage: light.sh
set -euo pipefail
cd "$(dirname "$0")/.."
bash bench/count.sh light light |
  awk '{ count[$1] = $2 / 3000; ++found }
       END {
         if (found != 6) { print "nothing was counted"; exit 1 }
         printf "instructions a pulse of 19 subrays: %.0f, as light paths %.0f\n", count["direct"], count["paths"]
         for (k = split("panes mirrors bodies twice", kinds, " "); k > 0; --k)
           printf "%s: %.0f, %.2f times those of light paths without\n", kinds[k], count[kinds[k]], count[kinds[k]] / count["paths"]
       }'
