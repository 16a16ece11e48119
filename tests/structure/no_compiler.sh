#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Stands before a compiler or linker, and in the place of ar: makes an empty output, and fails if a source is missing. A build with it runs
# every rule that generates a file, in order, and compiles nothing.
previous=
for argument in "$@"; do
  case $argument in
    *.cpp) [ -e "$argument" ] || { echo "missing: $argument" >&2; exit 1; } ;;
  esac
  case $previous in
    -o | qc) : > "$argument" ;;
  esac
  previous=$argument
done
