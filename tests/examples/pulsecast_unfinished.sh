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

# Options whose numbers differ in the last digit.
scaled() { timeout 100 "$program" own/long.xml --threads 2 --format las --output scaled --missesAt "$1" --lasScale "${@:2}" > messages 2>&1; }
(ulimit -f 1200 && scaled 50.0000001 0.0001234567) && fail "the limit has no effect"
scaled 50.0000001 0.0001234568 --resume && fail "another scale was taken"
grep -q 'scale=0.0001234567.*scale=0.0001234568' messages || fail "of another scale it said: $(cat messages)"
scaled 50.0000002 0.0001234567 --resume && fail "another range was taken"
scaled 50.0000001 0.0001234567 --resume || fail "with the same options it cannot be resumed: $(cat messages)"
rm -rf scaled

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
refuses "a new spectrum" "since its start, .*spectra is new$"
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

# Buffers and pictures of glTF files, by whatever name: neither is an earlier scene taken from the cache, nor are two worlds mixed in one run.
cp "$(dirname "$survey")/survey.xml" own/lids.xml
sed -i 's| onGround="true"||; s|</part>|</part><part id="8"><filter type="meshloader"><param type="string" key="filepath" value="lid.gltf"/></filter></part>|' own/lids.xml
{ cat kept/plane.obj; yes '# nothing to see here, but many bytes of it' | head -n 400000; } > own/plane.obj
lids() { timeout 100 "$program" own/lids.xml "${start[@]}" --threads 2 --format xyz --output lids "$@" > messages 2>&1; }
lay() { # lay FILE HEIGHT: corners of a triangle at that height, 32 bits each, as for printf
  local far='\x00\x00\xc8\x42' near='\x00\x00\xc8\xc2' none='\x00\x00\x00\x00'
  printf "$near$2$far$far$2$far$none$2$near" > "own/$1"
}
low='\x00\x00\x00\x3f' high='\x00\x00\x80\x3f'
for uri in b.bin b.dat b "b'c.bin" 'b\u00e4.bin'; do
  name=${uri/'\u00e4'/$'\xc3\xa4'}
  cat > own/lid.gltf << EOF
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"uri": "$uri", "byteLength": 36}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-100, 0, -100], "max": [100, 9, 100]}]}
EOF
  rm -rf lids cache
  lay "$name" "$low"
  lids || fail "$name: ended with $(cat messages)"
  before=$(sums lids)
  rm -rf lids
  lids && grep -q "is read from its cache" messages && [ "$(sums lids)" = "$before" ] || fail "$name: the scene is not cached: $(cat messages)"
  rm -rf lids
  lay "$name" "$high"
  lids && grep -q "is cached" messages || fail "$name: with another buffer it said: $(cat messages)"
  [ "$(sums lids)" != "$before" ] || fail "$name: another buffer makes no difference"
  rm -rf lids
  (ulimit -f 60 && lids) && fail "the limit has no effect"
  lay "$name" "$low"
  lids --resume && fail "$name: another buffer was taken"
  grep -qF "$name has changed" messages || fail "$name: of another buffer it said: $(cat messages)"
  lay "$name" "$high"
  lids --resume || fail "$name: the run cannot be resumed: $(cat messages)"
done
cp kept/plane.obj own

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
