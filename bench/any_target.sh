#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Counts the instructions of a pulse in the surveys of any_target.cpp, of a scene alone and as one of several types of maps. Needs g++ and
# valgrind. Usage: any_target.sh
set -euo pipefail
cd "$(dirname "$0")/.."
bash bench/count.sh any_target target |
  awk '{ count[$1] = $2 / 2000; ++found }
       END {
         if (found != 4) { print "nothing was counted"; exit 1 }
         for (k = split("single bundle", beams, " "); k > 0; --k) {
           alone = count["single_part_" beams[k]]
           any = count["any_" beams[k]]
           printf "instructions a pulse, %s: alone %.1f, one of several %.1f; %.1f more\n", beams[k], alone, any, any - alone
         }
       }'
