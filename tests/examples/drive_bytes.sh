#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# The drive of a seed is the same bag, to the byte, on any number of threads; that of another is not. Usage: sh drive_bytes.sh DRIVE FOLDER
set -eu
drive=$1 folder=$2
for threads in 1 2 3; do "$drive" --duration 0.5 --seed 5 --threads "$threads" --output "$folder/$threads" > /dev/null; done
"$drive" --duration 0.5 --seed 6 --output "$folder/other" > /dev/null
cmp "$folder/1/drive.mcap" "$folder/2/drive.mcap"
cmp "$folder/1/drive.mcap" "$folder/3/drive.mcap"
if cmp -s "$folder/1/drive.mcap" "$folder/other/drive.mcap"; then echo "The drive of another seed is the same."; exit 1; fi
