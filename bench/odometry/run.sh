#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Odometry by PCL on the bags of examples/drive.cpp: drifts [%] as scanned, with the distortion undone, and without distortion, of the seeds
# from 1 on, and their means; of several seeds with intervals of 95 % by 10,000 bootstrap draws of paired differences. Fails if the path
# with the distortion undone drifts by more than 2 %. Usage: sh run.sh DRIVE ODOMETRY NODE_MODULES SEEDS
set -eu
drive=$1 odometry=$2 modules=$3 seeds=$4
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

for seed in $(seq "$seeds"); do
  row=$seed
  for ways in "scanned undone" "undistorted"; do
    distortion=
    [ "$ways" = undistorted ] && distortion=--undistorted
    "$drive" --seed "$seed" $distortion --output "$folder" > /dev/null
    node "$here/unbag.mjs" "$modules" "$folder/drive.mcap" "$folder"
    for way in $ways; do row="$row $("$odometry" "$folder" "$way")"; done
  done
  echo "$row" | tee -a "$folder/drifts"
done
python3 - "$folder/drifts" << 'END'
import random
import sys

drifts = [[float(number) for number in line.split()[1:]] for line in open(sys.argv[1])]
mean = lambda numbers: sum(numbers) / len(numbers)
scanned, undone, undistorted = (mean([row[k] for row in drifts]) for k in range(3))
print(f'mean drift: as scanned {scanned:.3f} %, undone {undone:.3f} %, without distortion {undistorted:.3f} %')
draws = random.Random(1)
for name, k in (('undone', 1), ('as scanned', 0)):
    differences = [row[k] - row[2] for row in drifts]
    means = sorted(mean(draws.choices(differences, k=len(differences))) for _ in range(10000))
    print(f'{name} less without distortion: {mean(differences):.3f} % ({means[249]:.3f} to {means[9749]:.3f}), '
          f'{100 * means[9749] / undistorted:.0f} % of the latter at the upper end')
sys.exit(not all(row[1] <= 2 for row in drifts))
END
