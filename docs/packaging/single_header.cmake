# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Writes headers, given as a list of their paths, and all that they include of the library as one file:
# cmake -DINCLUDE=include "-DHEADERS=pulsecast/pulsecast.hpp;pulsecast/shape/voxel_grid.hpp" -DOUT=pulsecast.hpp -P single_header.cmake
# INCLUDE is a folder, or a list of folders of which the first that has a header gives it.
cmake_minimum_required(VERSION 3.25)
set(written)
set(text)

# Adds a header, after those that it includes.
function(add header)
  if(header IN_LIST written)
    return()
  endif()
  list(APPEND written ${header})
  unset(path)
  find_file(path ${header} PATHS ${INCLUDE} NO_CACHE REQUIRED NO_DEFAULT_PATH)
  file(READ ${path} own)
  file(STRINGS ${path} includes REGEX "^#include <pulsecast/")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include <(.*)>.*" "\\1" include "${include}")
    add(${include})
  endforeach()
  string(REGEX REPLACE "^(//[^\n]*\n)+" "" own "${own}")
  string(REGEX REPLACE "#if !__has_include\\(<pulsecast/[^\n]*\n#error [^#]*#endif\n" "" own "${own}")
  string(REGEX REPLACE "#include <pulsecast/[^\n]*\n" "" own "${own}")
  set(text "${text}\n// ---- ${header}\n${own}")
  set(text "${text}" PARENT_SCOPE)
  set(written ${written} PARENT_SCOPE)
endfunction()

foreach(header IN LISTS HEADERS)
  add(${header})
endforeach()
file(WRITE ${OUT} "// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

// Headers of pulsecast in one file, for those who copy rather than install. It needs GLM, C++20 and threads. Each keeps its include guard:
// this file may be included before and after other headers of the same version.
${text}")
