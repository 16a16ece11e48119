# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# For ARM (aarch64), with qemu for the tests (Debian packages: g++-aarch64-linux-gnu, qemu-user). Headers of GLM and doctest are this machine's;
# libraries for ARM, such as Fast CDR, may lie in build/aarch64_root, where `.ci/steps` unpacks them.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64;-L;/usr/aarch64-linux-gnu)
cmake_path(SET root NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../../build/aarch64_root/usr)
list(APPEND CMAKE_PREFIX_PATH ${root})
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${root}/include)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-L${root}/lib/aarch64-linux-gnu -Wl,-rpath,${root}/lib/aarch64-linux-gnu")
set(CMAKE_DISABLE_FIND_PACKAGE_MPI TRUE)  # of this machine: found by its programs
set(CMAKE_DISABLE_FIND_PACKAGE_Python TRUE)
