#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# The drive of a seed is the same bag, to the byte, on any number of threads; that of another is not. Usage: sh drive_bytes.sh DRIVE FOLDER
set -eu
drive=$1 folder=$2
for threads in 1 2 3; do "$drive" --duration 0.5 --seed 5 --threads "$threads" --output "$folder/$threads" > /dev/null; done
"$drive" --duration 0.5 --seed 6 --output "$folder/other" > /dev/null
for file in drive.mcap truth.tum; do
  cmp "$folder/1/$file" "$folder/2/$file"
  cmp "$folder/1/$file" "$folder/3/$file"
  if cmp -s "$folder/1/$file" "$folder/other/$file"; then echo "$file is the same of another seed"; exit 1; fi
done
