#!/bin/bash
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Stops a run by the button of its live page: it must leave whole files, and give the same as a run that was let alone when it is resumed.
# Usage: pulsecast_live.sh PROGRAM SURVEY FOLDER, where FOLDER is emptied.
set -u
export LC_ALL=C
program=$1 survey=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder" || exit 2
cd "$folder" || exit 2

fail() {
  echo "$*"
  exit 1
}

options=("$survey" --gpsStartTime 1577836800 --threads 2)
sums() { (cd "$1" && find . -type f ! -path './*/.*' ! -name page.html -printf '%f ' -exec md5sum {} ';' | sed 's| \./.*||' | sort); }

"$program" "${options[@]}" --quiet --output whole || fail "the run that is let alone failed"

# What the server at an address answers: ask ADDRESS METHOD PATH
ask() {
  local host=${1#http://}
  host=${host%%/*}
  exec 3<> "/dev/tcp/${host%:*}/${host#*:}" || return 1
  printf '%s %s HTTP/1.1\r\nHost: %s\r\nConnection: close\r\nContent-Length: 0\r\n\r\n' "$2" "$3" "$host" >&3
  tr -d '\0' <&3
  exec 3>&-
}

for ((n = 0, status = 0; n < 20 && status != 3; ++n)); do
  rm -rf stopped
  "$program" "${options[@]}" --live --page --output stopped > said.txt 2> /dev/null &
  pid=$!
  address=
  for ((k = 0; k < 500; ++k)); do
    address=$(sed -n 's|^watch this run at \(http://127\.0\.0\.1:[0-9]*/[0-9a-f]\{32\}/\)$|\1|p' said.txt)
    [ -n "$address" ] && break
    sleep 0.02
  done
  [ -n "$address" ] || fail "no address was said: $(cat said.txt)"
  path=/${address#http://*/}
  [[ $(ask "$address" POST /stop) == *" 403 "* ]] || fail "the run can be stopped without the secret"
  [[ $(ask "$address" POST "${path}stop") == *" 204 "* ]] || fail "the button does nothing"
  wait $pid
  status=$?
done
[ $status = 3 ] || fail "a run that is stopped ends with $status, not 3"
[ "$(find stopped -name unfinished.txt | wc -l)" = 1 ] || fail "a run that is stopped cannot be resumed"
[ -z "$(find stopped -name '*.part')" ] || fail "a run that is stopped leaves what is not whole"
[ "$(find stopped -name page.html | wc -l)" = 1 ] || fail "a run that is stopped leaves no page"
"$program" "${options[@]}" --quiet --resume --output stopped || fail "it could not be resumed"
[ "$(sums stopped)" = "$(sums whole)" ] || fail "resumed, it is not what it should be:
$(diff <(sums stopped) <(sums whole))"
