#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Runs the survey program by mpirun: any number of processes and threads must leave the bytes of one; one that is killed ends them all and
# leaves nothing that looks whole; what is left is resumed.
# Usage: pulsecast_mpirun.sh MPIEXEC PROGRAM SURVEY FOLDER, where FOLDER is emptied.
set -u
export LC_ALL=C
mpirun=$1 program=$2 survey=$3 folder=$4
rm -rf "$folder"
mkdir -p "$folder" || exit 2
cd "$folder" || exit 2
export XDG_CACHE_HOME=$folder/cache

fail() {
  echo "$*"
  exit 1
}

launch=("$mpirun")
if "$mpirun" --version | grep -qE 'Open MPI|OpenRTE'; then  # as mpirun or as mpiexec
  launch+=(--oversubscribe)
  [ "$(id -u)" = 0 ] && launch+=(--allow-run-as-root)
fi
start=(--gpsStartTime 1577836800)

# Names and sums of all files below the runs of an output, without the time in their names.
sums() { (cd "$1" && find . -type f ! -path './*/.*' -printf '%f ' -exec md5sum {} ';' | sed 's| \./.*||' | sort); }

# The same files from any number of processes and threads: same PROCESSES THREADS FORMAT [OPTION...].
same() {
  local name=$3_$1_$2
  [ -d "one_$3" ] || "$program" "$survey" "${start[@]}" --output "one_$3" --threads 1 --format "${@:3}" --quiet || fail "one process failed"
  "${launch[@]}" -n "$1" "$program" "$survey" "${start[@]}" --output "$name" --threads "$2" --format "${@:3}" > told 2> notes ||
    fail "$name failed: $(cat told notes)"
  [ "$(sums "$name")" = "$(sums "one_$3")" ] || fail "$name is not as from one process: $(diff <(sums "$name") <(sums "one_$3"))"
  [ "$(grep -c pulses told)" -gt 0 ] || fail "nothing was told"
  [ "$(grep -c ' pulses  ' told)" = 1 ] || fail "more than one process tells: $(cat told)"
}
for ranks in "1 2" "2 1" "2 2" "3 1" "5 2"; do
  # shellcheck disable=SC2086
  same $ranks las --writeWaveform --writePulse --calcEchowidth
done
same 3 2 laz
same 2 1 xyz --writeWaveform --writeMisses --missesAt 50
same 3 1 xyz.gz --splitByChannel
grep -q 'of its own' notes && fail "the scene is not shared: $(cat notes)"

# Formats that one process writes are refused by name, before there is a folder.
for format in ply pcd npz kitti mcap ptx; do
  "${launch[@]}" -n 2 "$program" "$survey" --format $format --output refused > told 2>&1 && fail "$format was written by two processes"
  grep -q "format $format needs all points in one process: expected --format xyz, xyz.gz, las or laz under mpirun" told || fail "$format: $(cat told)"
done
[ -e refused ] && fail "what was refused left a folder"

# What is wrong is said once.
"${launch[@]}" -n 3 "$program" nowhere.xml > told 2>&1 && fail "a survey that is not there was simulated"
[ "$(grep -c 'error: nowhere.xml' told)" = 1 ] || fail "an error should be told once: $(cat told)"

# The processes of a run that is under way, by rank.
begin() { # begin OUTPUT [OPTION...]
  "${launch[@]}" -n 3 "$program" "$survey" "${start[@]}" --threads 1 --quiet --format las --output "$@" 2> told &
  pid=$!
}
rank() { # rank NUMBER: its process
  local child
  for child in $(pgrep -P $pid); do
    tr '\0' '\n' < "/proc/$child/environ" 2> /dev/null | grep -qx "OMPI_COMM_WORLD_RANK=$1" && echo "$child"
  done
}
files() { find "$1" -name '*_points.las' 2> /dev/null | wc -l; }

"$program" "$survey" "${start[@]}" --threads 2 --quiet --format las --output whole || fail "one process failed"
expected=$(sums whole)

# Every file that stands under its name is one of the whole run, or is named as cut.
expect_whole_files() {
  local line
  sums "$1" | grep -v unfinished.txt | grep -v '\.part ' > there
  while IFS= read -r line; do grep -qxF "$line" <<< "$expected" || fail "$2: $line looks whole, but is not"; done < there
}

kills=0
for victim in 1 0 2; do
  for tries in 1 2 3 4 5 6 7 8; do
    rm -rf killed_$victim
    begin killed_$victim
    while kill -0 $pid 2> /dev/null && [ "$(files killed_$victim)" -lt $((victim + 1)) ]; do sleep 0.02; done
    target=$(rank $victim)
    [ -n "$target" ] && kill -KILL "$target" 2> /dev/null
    wait $pid && continue # it was done before
    [ -s told ] || fail "nothing was said of rank $victim, which was killed"
    [ "$(sums killed_$victim)" = "$expected" ] && continue
    expect_whole_files killed_$victim "rank $victim was killed"
    kills=$((kills + 1))
    break
  done
done
[ $kills -gt 0 ] || fail "no process could be killed in time"
"${launch[@]}" -n 2 "$program" "$survey" "${start[@]}" --quiet --format las --output killed_1 --resume || fail "cannot be resumed"
[ "$(sums killed_1)" = "$expected" ] || fail "resumed by mpirun, it is not as it should be: $(diff <(sums killed_1) <(echo "$expected"))"
"$program" "$survey" "${start[@]}" --quiet --format las --output killed_0 --resume || fail "one process cannot resume what three began"
[ "$(sums killed_0)" = "$expected" ] || fail "resumed by one process, it is not as it should be"

# Asked to stop, the first process sees to it that what is there is whole, as far as it goes.
for tries in 1 2 3 4 5 6 7 8; do
  rm -rf stopped
  begin stopped
  while kill -0 $pid 2> /dev/null && [ "$(files stopped)" -lt 2 ]; do sleep 0.02; done
  target=$(rank 0)
  [ -n "$target" ] && kill -TERM "$target" 2> /dev/null
  wait $pid
  [ $? = 3 ] && break
done
[ -n "$(find stopped -name unfinished.txt)" ] || fail "a run could not be stopped, or tells nothing of it"
[ -z "$(find stopped -name '*.part')" ] || fail "files are left open by a run that was stopped"
resume_stopped() { "${launch[@]}" -n 2 "$program" "$survey" "${start[@]}" --quiet --format las --output stopped --resume; }
lock=$(dirname "$(find stopped -name unfinished.txt)")/.lock
before=$(sums stopped)
(
  flock -n 9 || exit 2
  echo "$$ $(hostname)" >&9
  resume_stopped > told 2>&1
) 9<> "$lock" && fail "what another process writes was resumed"
[ "$(grep -c "error: stopped/.*: is being written by process $$ of " told)" = 1 ] || fail "a refusal should be told once: $(cat told)"
[ "$(sums stopped)" = "$before" ] || fail "what another process writes was touched"
resume_stopped || fail "what was stopped cannot be resumed"
[ -z "$(find stopped -name .lock)" ] || fail "a lock is left"
[ "$(sums stopped)" = "$expected" ] || fail "what was stopped and resumed is not as it should be"
[ -z "$(find /dev/shm -maxdepth 1 -name 'pulsecast-*.scene' -newer told 2> /dev/null)" ] || fail "a scene is left in memory"
echo "the bytes of one process from 1, 2, 3 and 5; $kills were killed"
