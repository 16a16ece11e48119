#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Resumes runs of the survey program after something has changed: results, inputs, options, or the log, which nobody needs to have believed.
# Usage: pulsecast_unfinished.sh PROGRAM SURVEY FOLDER, where FOLDER is emptied.
set -u
export LC_ALL=C
program=$1 survey=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder/own" || exit 2
cp "$(dirname "$survey")"/{long.xml,plane.obj,plane.mtl} "$folder/own" || exit 2
cd "$folder" || exit 2
export XDG_CACHE_HOME=$folder/cache

fail() {
  echo "$*"
  exit 1
}

start=(--gpsStartTime 1577836800)
run() { timeout 100 "$program" own/long.xml --threads 2 --format las --output "$@"; }
# Names and sums of all files below the runs of an output, hidden ones as well, without the time in their names.
sums() { (cd "$1" && find . -type f -printf '%f ' -exec md5sum {} ';' | sed 's| \./.*||' | sort); }

run whole "${start[@]}" --quiet || fail "the run that is let alone failed"
expected=$(sums whole)

# A run that exceeds the limit of a file's size says so, and can be resumed. All below goes on from what it left.
(ulimit -f 1200 && run limited "${start[@]}" --quiet) 2> messages
[ $? = 1 ] && grep -q 'strip00a_points.las: cannot be written: File too large' messages || fail "beyond the limit it said: $(cat messages)"
log=$(cd limited && find . -name unfinished.txt)
[ -n "$log" ] || fail "no run to resume"
results=$(dirname "$log")
grep -q "^file 872557 leg000_points.las$" "limited/$log" || fail "the log does not know what is whole: $(cat "limited/$log")"
[ -z "$(find limited -name '*.part' -o -name .lock)" ] || fail "it left $(find limited -name '*.part' -o -name .lock)"

again() { # begins anew from what was left
  rm -rf again
  cp -a limited again
}
resumes() { # resumes WHAT MESSAGE [OPTION...]
  run again "${@:3}" --resume > messages 2>&1 || fail "$1: cannot be resumed: $(cat messages)"
  grep -q -- "$2" messages || fail "$1: expected '$2', not $(cat messages)"
  [ "$(sums again)" = "$expected" ] || fail "$1: it is not as it should be: $(diff <(sums again) <(echo "$expected"))"
}
refuses() { # refuses WHAT MESSAGE [OPTION...]
  local before=$(sums again) status
  run again "${@:3}" --resume > messages 2>&1
  status=$?
  [ $status = 1 ] && grep -q -- "$2" messages || fail "$1: ended with $status; expected '$2', not $(cat messages)"
  [ "$(sums again)" = "$before" ] || fail "$1: something was touched"
}

# Results that are not as they were.
again
resumes "as it was left" "pulses" "${start[@]}"
for result in leg000_points.las leg002_points.las leg000_trajectory.txt; do
  again
  truncate -s -100 "again/$results/$result"
  resumes "$result is short" "note: .*$result is not as long as when it was completed"
done
again
rm "again/$results/leg002_points.las"
resumes "a result is gone" "note: .*leg002_points.las is not as long"
again
sed -i '/^file .*leg000/d' "again/$log"
echo "more" > "again/$results/leg000_points.las"
resumes "a result was not noted as whole" "pulses"

# A run that is resumed and fails again forgets what was not whole.
again
truncate -s -100 "again/$results/leg000_points.las"
(ulimit -f 800 && run again --quiet --resume) 2> messages && fail "the limit has no effect"
grep -q 'leg000_points.las$' "again/$log" && fail "a short result counts as whole: $(cat "again/$log")"
resumes "resumed twice" "pulses"

# The time of its start.
again
refuses "another start" "gpsStartTime of second 259218 .*gpsStartTime of second 259219 " --gpsStartTime 1577836801
refuses "a start that is none" "gpsStartTime 'yesterday'" --gpsStartTime yesterday
refuses "another seed" "seed 5.*seed 6" --seed 6
resumes "the same start" "pulses" --gpsStartTime '2020-01-01 00:00:00'

# Inputs that have changed; with other times alone, they have not.
again
mkdir kept
cp own/plane.obj own/plane.mtl kept
touch own/plane.obj
echo "# a remark" >> own/plane.mtl
refuses "another MTL" "cannot be resumed: since its start, .*plane.mtl has changed$"
echo "v 1 2 3" >> own/plane.obj
refuses "another OBJ, too" "cannot be resumed: since its start, .*plane.mtl has changed, .*plane.obj has changed$"
cp kept/plane.obj kept/plane.mtl own
mkdir spectra
printf '0.5 0.1\n2.0 0.2\n' > spectra/grass.txt
refuses "a new spectrum" "since its start, .*spectra/grass.txt is new$"
rm -r spectra
rm own/plane.mtl
refuses "no MTL" "since its start, .*plane.mtl is gone$"
cp kept/plane.mtl own
resumes "the same inputs" "pulses"

# Trajectories.
cat > own/flown.xml << EOF
<document>
  <scanner id="mirror" optics="rotating" pulseFreqs_Hz="30000" scanAngleMax_deg="60" scanAngleEffectiveMax_deg="60" scanFreqMax_Hz="100"/>
  <scene id="plane"><part id="7"><filter type="objloader"><param type="string" key="filepath" value="plane.obj"/></filter></part></scene>
  <survey name="flown" scene="#plane" platform="interpolated" scanner="#mirror" seed="5">
    <leg><platformSettings trajectory="way.csv" tIndex="0" rollIndex="1" pitchIndex="2" yawIndex="3" xIndex="4" yIndex="5" zIndex="6" syncGPSTime="true"/>
      <scannerSettings scanFreq_hz="20"/></leg>
  </survey>
</document>
EOF
printf '100,0,0,0,0,0,1.5\n104,0,0,0,8,0,1.5\n' > own/way.csv
fly() { timeout 100 "$program" own/flown.xml --threads 2 --format las --output flown "$@" > messages 2>&1; }
(ulimit -f 100 && fly "${start[@]}") && fail "the limit has no effect"
[ -n "$(find flown -name unfinished.txt)" ] || fail "nothing of a flight can be resumed: $(cat messages)"
sed -i 's/,8,/,9,/' own/way.csv
fly --resume && fail "another trajectory was taken"
grep -q 'since its start, .*way.csv has changed$' messages || fail "of another trajectory it said: $(cat messages)"
sed -i 's/,9,/,8,/' own/way.csv
fly "${start[@]}" --resume || fail "a flight by the clock of its trajectory cannot be resumed: $(cat messages)"

# Logs that no run has left.
mkdir -p victim
echo precious > victim/unfinished.txt
hostile() { # hostile LINE SED
  again
  sed -i "$2" "again/$log"
  refuses "log: $2" "unfinished.txt, line $1: "
}
hostile 1 's/^seed .*/seed -1/'
hostile 1 's/^seed .*/seed 5 /'
hostile 1 '1d'
hostile 1 '1s/^/\x00\x1b[2J/'
hostile 2 's/^start_time .*/start_time nan/'
hostile 2 's/^start_time .*/start_time inf/'
hostile 2 's/^start_time .*/start_time 1e999/'
hostile 3 's/^run .*/run 1000000000/'
hostile 3 's/^run .*/run 2/'
hostile 3 's/^run .*/run -1/'
hostile 3 's/^run .*/run 99999999999/'
hostile 5 '4s/$/\nbefore ..\/..\/victim/'
hostile 5 '4s/$/\nbefore ../'
hostile 5 '4s/$/\nbefore 2026-01-01_00-00-00\/..\/..\/..\/victim/'
hostile 5 '4s/$/\ninput 00 plane.obj/'
hostile 5 '4s/$/\nhow else/'
hostile '[0-9]*' 's/^end$/before 2026-01-01_00-00-00\nbefore 2026-01-01_00-00-00\nend/'
hostile '[0-9]*' 's/^end$/end\nend/'
hostile '[0-9]*' 's/^file 872557 /file -1 /'
hostile '[0-9]*' 's/^file 872557 .*/file 872495 ..\/x/'
hostile '[0-9]*' 's/^file 872557 .*/file 872495/'
[ "$(cat victim/unfinished.txt)" = precious ] || fail "a log led to something being removed"
again
: > "again/$log"
refuses "an empty log" "unfinished.txt: is empty"
rm "again/$log"
mkfifo "again/$log"
refuses "a pipe as log" "unfinished.txt: is a directory or device"
again
ln -s "$folder/victim/unfinished.txt" "again/$results/.lock"
refuses "a link as lock" "cannot be locked"
[ "$(cat victim/unfinished.txt)" = precious ] || fail "something was written through a link"
rm "again/$results/.lock"
printf 'file 123 leg0' >> "again/$log" # a last line that was cut is no loss
resumes "a log that was cut" "pulses"
echo "all that has changed is told, and nothing else was touched"
