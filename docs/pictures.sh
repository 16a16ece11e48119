#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Draws the pictures of the pages anew, by the commands of docs/gallery.md. Usage: docs/pictures.sh [BUILD [PATTERN]]; BUILD is build/release
# if not told; with PATTERN, only blocks of commands with a line that has it, such as `airplane`.
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
mkdir -p build/pictures
awk -v pattern="${2:-}" '/^```sh$/ { inside = 1; block = ""; next } /^```$/ && inside { inside = 0; if (block ~ pattern) printf "%s", block; next }
                         inside { block = block $0 "\n" }' docs/gallery.md | sed "s|build/release/|$build/|g" | sh -eux
