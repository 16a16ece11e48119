#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Fails unless two files with the same order of quaternions link, and two with different ones do not, by the name of the symbol that refuses
# them. Usage: check_settings.sh COMPILER INCLUDES
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
printf '#include <pulsecast/base/vector.hpp>\nint other();\nint main() { return other(); }\n' > main.cpp
printf '#include <pulsecast/base/vector.hpp>\nint other();\nint other() { return 0; }\n' > other.cpp
"$1" -std=c++20 "-I$2" -c main.cpp -o main.o
"$1" -std=c++20 "-I$2" main.o other.cpp -o same && ./same
"$1" -std=c++20 "-I$2" -DGLM_FORCE_QUAT_DATA_WXYZ main.cpp other.cpp -o wxyz && ./wxyz
for setting in DATA_WXYZ CTOR_XYZW; do
  if "$1" -std=c++20 "-I$2" -DGLM_FORCE_QUAT_$setting main.o other.cpp -o other 2> said; then
    echo "GLM_FORCE_QUAT_$setting in one file of two links"
    exit 1
  fi
  grep -q pulsecast_order_of_quaternion said || { cat said; exit 1; }
done
