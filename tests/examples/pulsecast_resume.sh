#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Kills the survey program at ten random moments and resumes it: it must leave the same bytes as a run that was let alone.
# Usage: pulsecast_resume.sh PROGRAM SURVEY FOLDER [SEED], where FOLDER is emptied and SEED begins the random moments.
set -u
export LC_ALL=C
program=$1 survey=$2 folder=$3
tests=$(cd "$(dirname "$0")" && pwd) || exit 2
seed=${4:-$(($(date +%s%N) % 32768))}
RANDOM=$seed
rm -rf "$folder"
mkdir -p "$folder" || exit 2
cd "$folder" || exit 2

fail() {
  echo "seed $seed: $*"
  exit 1
}

# Sends a signal to a run after so many milliseconds: signalled SIGNAL TIME OUTPUT FORMAT [OPTION...]. Sets `status`, and fails if the run
# had come to its end before. Adapts `duration`, as the load of the machine changes: moments shall come neither too late nor too early.
signalled() {
  local pid words=("${options[@]}")
  [ "$1" = INT ] && unset 'words[-1]' # --quiet
  "$program" "${words[@]}" --output "$3" --format "$4" "${@:5}" > /dev/null 2> said &
  pid=$!
  sleep "$(printf '%d.%03d' $(($2 / 1000)) $(($2 % 1000)))"
  kill -"$1" $pid 2> /dev/null
  wait $pid 2> /dev/null
  status=$?
  [ $status = 1 ] && fail "a run failed: $(cat said)"
  [ -e "$3" ] || duration=$((duration + duration / 10 + 1))
  [ $status = 0 ] && duration=$((duration > 20 ? duration - duration / 20 : duration))
  [ $status != 0 ]
}
killed() { signalled KILL "$@"; }

# Logs of unfinished runs of an output, but for those in a hidden folder: of a run killed before its folder has its name.
states() { find "$1" -name unfinished.txt ! -path '*/.*/*' 2> /dev/null; }

# Names and sums of all files below the runs of an output, without the time in their names.
sums() { (cd "$1" && find . -type f ! -path './*/.*' -printf '%f ' -exec md5sum {} ';' | sed 's| \./.*||' | sort); }

. "$tests/whole_runs.sh"

# One run after the other, each killed again and again until it is complete.
kills=0 cut_short=0 n=0
for ((tries = 0; (kills < 10 || cut_short == 0) && tries < 200; ++tries)); do
  format=$([ $((n % 2)) = 0 ] && echo las || echo xyz)
  resume=$([ -e "killed_$n" ] && echo --resume)
  moment=$((RANDOM % duration + 1))
  if killed $moment killed_$n $format $resume; then
    kills=$((kills + 1))
    moments="${moments:-} $moment"
    [ -n "$(find "killed_$n" -name '*.part' 2> /dev/null)" ] && cut_short=$((cut_short + 1))
    [ $((kills % 3)) != 0 ] && continue
    run killed_$n $format --resume || fail "moments [ms]$moments: a run could not be resumed"
  fi
  [ "$(sums killed_$n)" = "${expected[$format]}" ] ||
    fail "moments [ms]$moments: resumed, killed_$n is not what it should be:
$(diff <(sums killed_$n) <(echo "${expected[$format]}"))"
  n=$((n + 1))
done
[ $kills -ge 10 ] || fail "only $kills runs could be killed"
[ $cut_short != 0 ] || fail "no run was killed while it wrote"

# Interrupted in the middle, it says so by its status, and all it leaves is whole.
for ((n = 0; n < 100; ++n)); do
  rm -rf interrupted
  signalled INT $((RANDOM % duration + 1)) interrupted xyz && [ -n "$(states interrupted)" ] && break
done
[ $n -lt 100 ] || fail "no run could be interrupted"
[ $status = 3 ] || fail "it ended with $status when it was interrupted"
grep -q -- "--resume continues" said || fail "it did not say how to go on when it was interrupted"
[ -z "$(find interrupted -name '*.part')" ] || fail "files are left open by a run that was interrupted"
find interrupted -name '*_points.xyz' -exec awk 'NF != columns && columns { exit 1 } { columns = NF }' {} ';' || fail "a line is not whole"
[ -z "$(find interrupted -name '*_points.xyz' -size +0 -exec tail -c 1 {} ';' | tr -d '\n')" ] || fail "a last line is not whole"
run interrupted xyz --resume || fail "a run that was interrupted could not be resumed"
[ "$(sums interrupted)" = "${expected[xyz]}" ] || fail "an interrupted run is not what it should be when resumed"

# Formats that are folders, or that end with a summary, are resumed as well.
for format in kitti npz mcap; do
  run whole_$format $format || fail "the run that is let alone failed"
  for ((n = 0; n < 20; ++n)); do
    killed $((RANDOM % duration + 1)) killed_$format $format && [ -n "$(states killed_$format)" ] && break
    rm -rf killed_$format
  done
  run killed_$format $format --resume || fail "$format could not be resumed"
  [ "$(sums killed_$format)" = "$(sums whole_$format)" ] || fail "resumed, $format is not what it should be"
done

# What would go wrong if the state were, and that these comparisons would tell.
# One state is needed: a run killed as it goes from one survey to the next may leave two. It must lack some of the eight results, or nothing
# is left to simulate.
until killed $((RANDOM % duration + 1)) broken las && state=$(states broken) && [ "$(grep -c . <<< "$state")" = 1 ] &&
  [ "$(grep -c '^file ' "$state")" -lt 8 ]; do
  rm -rf broken
done
cp "$state" state
sed '/^end$/,$d' state > "$state"
run broken las --resume 2> message && fail "a state that lacks its end was taken"
grep -q 'unfinished.txt.*truncated' message || fail "of a state that lacks its end it was said: $(cat message)"
sed 's/^seed .*/seed 6/' state > "$state"
run broken las --resume || fail "a run of another seed could not be resumed"
[ "$(sums broken)" != "${expected[las]}" ] || fail "a run that was resumed with another seed has the same bytes"
echo "seed $seed: killed after$moments ms, $cut_short times while files were open, and all the same when resumed"
