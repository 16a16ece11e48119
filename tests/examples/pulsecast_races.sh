#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Lets two processes of the survey program race for one folder, while the first is stopped, interrupted or killed: what the first writes must
# be whole, the second must be refused by the name of the first, and after a kill the folder must be free at once.
# Usage: pulsecast_races.sh PROGRAM SURVEY FOLDER [RACES] [SEED], where FOLDER is emptied and SEED begins the random moments.
# PULSECAST_RACES says how many races there are, unless RACES does.
set -u
export LC_ALL=C
program=$1 survey=$2 folder=$3
tests=$(cd "$(dirname "$0")" && pwd) || exit 2
races=${4:-${PULSECAST_RACES:-6}} seed=${5:-$(($(date +%s%N) % 32768))}
RANDOM=$seed
rm -rf "$folder"
mkdir -p "$folder" || exit 2
cd "$folder" || exit 2

fail() {
  echo "seed $seed, race ${race:-0} (${kind:-}, ${format:-}): $*"
  [ -z "${first:-}" ] || kill -KILL "$first" 2> /dev/null
  exit 1
}

pause() { sleep "0.$(printf '%03d' $(($1 % 1000)))"; } # pause MILLISECONDS

# Names and sums of all files below the two repetitions of a run, or more, hidden ones as well, without the time in their names. A hidden
# folder is one that was not made yet when its process was killed.
sums() { (cd "$1" && find . -name '.2*' -prune -o -type f -printf '%f ' -exec md5sum {} ';' | sed 's| \./.*||' | sort); }

. "$tests/whole_runs.sh"

# True if the first process holds the lock of a folder.
at_work() { [ -n "$(find raced -mindepth 2 -name .lock -path '*/2*' -size +0 -exec grep -l "^$first " {} + 2> /dev/null)" ]; }

# Stops the first process at work. False if it came to its end instead.
stop_first() {
  kill -STOP "$first" 2> /dev/null
  local state=
  until [[ $state == [TZX] ]]; do
    state=$(sed 's/.*) //; s/ .*//' "/proc/$first/stat" 2> /dev/null) && [ -n "$state" ] || return 1
  done
  [ "$state" = T ] && at_work
}

# Starts the first process, and waits until it is at work in its folder for a random while. False if it has ended by then.
start_first() { # start_first [OPTION...]
  "$program" "${options[@]}" --output raced --format "$format" "$@" &
  first=$!
  until at_work; do
    kill -0 $first 2> /dev/null || break
    sleep 0.002
  done
  pause $((RANDOM % duration / 2 + 1))
  kill -0 $first 2> /dev/null
}

expect_refused() { # expect_refused STATUS MESSAGES PROCESS
  [ "$1" = 1 ] && grep -q "^error: raced/.*/20[-0-9_]*: is being written by process $3 of " "$2" ||
    fail "beside process $3, the second ended with $1, saying: $(cat "$2")"
}

expect_whole() {
  [ "$(sums raced)" = "${expected[$format]}" ] || fail "$1 is not as it should be: $(diff <(sums raced) <(echo "${expected[$format]}"))"
  [ "$(find raced -mindepth 2 -maxdepth 2 -name '2*' | wc -l)" = 2 ] || fail "there are not two folders: $(find raced -mindepth 2 -maxdepth 2)"
}

ends() { # ends STATUS: how the first process must end
  wait "$first"
  local status=$?
  [ $status = "$1" ] || fail "the first ended with $status, not $1"
  first=
}

kinds=(alone stopped interrupted killed second_killed both_resume)
declare -A count
refused=0 tries=0
for ((race = 0; race < races; ++tries)); do
  [ $tries -lt $((20 * races + 20)) ] || fail "only $race races in $tries tries: runs end before they can be raced"
  kind=${kinds[race % ${#kinds[@]}]} format=$([ $((RANDOM % 2)) = 0 ] && echo las || echo xyz)
  rm -rf raced
  if ! start_first; then
    wait "$first"
    continue
  fi
  resumes=false
  if [ $((RANDOM % 2)) = 0 ]; then # the first is one that resumes, too
    resumes=true
    kill -KILL "$first"
    wait "$first" 2> /dev/null
    if ! start_first --resume; then
      wait "$first"
      continue
    fi
  fi
  if [ "$kind" != alone ] && ! stop_first; then
    kill -CONT "$first" 2> /dev/null
    wait "$first"
    continue
  fi

  if [ "$kind" = second_killed ]; then
    "$program" "${options[@]}" --output raced --format "$format" --resume 2> messages &
    second=$!
    pause $((RANDOM % 20))
    kill -KILL $second 2> /dev/null
    wait $second 2> /dev/null
  else
    run raced "$format" --resume 2> messages
    status=$?
    if [ "$kind" = alone ] && [ $status = 0 ]; then # the first had come to its end before
      ends 0
      expect_whole "what the first wrote"
      continue
    fi
    expect_refused $status messages "$first"
    refused=$((refused + 1))
  fi

  case $kind in
    alone)
      ends 0
      ;;
    stopped | second_killed)
      kill -CONT "$first"
      ends 0
      ;;
    interrupted)
      kill -INT "$first"
      kill -CONT "$first"
      wait "$first"
      status=$?
      first=
      [ $status = 3 ] || [ $status = 0 ] || fail "it ended with $status when it was interrupted"
      # One that resumes may be interrupted before it comes to what the killed one left.
      $resumes || [ -z "$(find raced -name '*.part' -o -name .lock)" ] || fail "it left $(find raced -name '*.part' -o -name .lock)"
      run raced "$format" --resume || fail "what was interrupted cannot be resumed"
      ;;
    killed)
      kill -KILL "$first"
      run raced "$format" --resume || fail "what was killed cannot be resumed at once"
      wait "$first" 2> /dev/null
      ;;
    both_resume)
      kill -KILL "$first"
      wait "$first" 2> /dev/null
      run raced "$format" --resume 2> messages_1 &
      first=$!
      run raced "$format" --resume 2> messages_2 &
      second=$!
      wait $first
      status_1=$?
      wait $second
      status_2=$?
      [ $status_1 = 0 ] || expect_refused $status_1 messages_1 '[0-9]*'
      [ $status_2 = 0 ] || expect_refused $status_2 messages_2 '[0-9]*'
      [ $status_1 = 0 ] || [ $status_2 = 0 ] || fail "of two that resume, none did"
      ;;
  esac
  first=
  expect_whole "what was raced for"
  count[$kind]=$((${count[$kind]:-0} + 1))
  race=$((race + 1))
done

# Runs that begin in one second have folders of their own.
kind=together format=xyz
for ((n = 0; n < 6; ++n)); do
  run together xyz &
  runs[n]=$!
done
for pid in "${runs[@]}"; do wait "$pid" || fail "one of many failed"; done
[ "$(sums together)" = "$(for pid in "${runs[@]}"; do echo "${expected[xyz]}"; done | sort)" ] || fail "what they wrote is not as it should be"
[ "$(find together -mindepth 2 -maxdepth 2 | wc -l)" = 12 ] || fail "6 runs have the folders $(find together -mindepth 2 -maxdepth 2)"
echo "seed $seed: $race races ($(for k in "${!count[@]}"; do printf '%s %s, ' "$k" "${count[$k]}"; done)$refused refused), every run whole"
