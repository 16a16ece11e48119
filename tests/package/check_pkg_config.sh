#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Compiles a program with the flags of pkg-config, from a copy of an installation: check_pkg_config.sh PKG_CONFIG COMPILER PREFIX FOLDER VERSION SOURCE
set -eu
pkg_config=$1 compiler=$2 prefix=$3 folder=$4 version=$5 source=$6
rm -rf "$folder"
mkdir -p "$folder/moved/share"
cp -r "$prefix/include" "$folder/moved/include"
cp -r "$prefix/share/pkgconfig" "$folder/moved/share/pkgconfig"
export PKG_CONFIG_PATH="$folder/moved/share/pkgconfig"
[ "$("$pkg_config" --modversion pulsecast)" = "$version" ] || { echo "expected version $version, not $("$pkg_config" --modversion pulsecast)"; exit 1; }
flags=$("$pkg_config" --cflags --libs pulsecast)
case $flags in *"$folder"/moved/*) ;; *) echo "the flags are not of the copy: $flags"; exit 1 ;; esac
# shellcheck disable=SC2086
"$compiler" -std=c++20 -fsyntax-only $flags "$source"
echo "compiled with $flags"
