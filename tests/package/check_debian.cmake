# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Makes a Debian package of BUILD in FOLDER, and looks for what must be in it.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${CPACK} --config ${BUILD}/CPackConfig.cmake -B ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB package ${FOLDER}/*.deb)
execute_process(COMMAND ${DPKG_DEB} --contents ${package} OUTPUT_VARIABLE contents COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${DPKG_DEB} --info ${package} OUTPUT_VARIABLE info COMMAND_ERROR_IS_FATAL ANY)
set(files include/pulsecast/pulsecast.hpp include/pulsecast/adapters/las.hpp share/cmake/pulsecast/pulsecastConfig.cmake)
if(EXISTS ${BUILD}/examples/pulsecast)
  list(APPEND files bin/pulsecast share/man/man1/pulsecast.1 share/pulsecast/data/)
endif()
foreach(file IN LISTS files)
  string(FIND "${contents}" " ./usr/${file}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "The package has no /usr/${file}:\n${contents}")
  endif()
endforeach()
if(NOT info MATCHES "Package: pulsecast\n" OR NOT info MATCHES "Depends: [^\n]*libglm-dev")
  message(FATAL_ERROR "The package does not say what it should:\n${info}")
endif()
