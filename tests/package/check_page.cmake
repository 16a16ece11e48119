# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Gets the header of the page's files in each way there is, in FOLDER: from headers that were copied out of SOURCE, which say by an error what to
# run; from PREFIX, where the library is installed; and in one header with page.hpp. The page is the same in all.
cmake_minimum_required(VERSION 3.25)
list(TRANSFORM INCLUDES PREPEND -I)
set(program ${CMAKE_CURRENT_LIST_DIR}/page.cpp)
file(REMOVE_RECURSE ${FOLDER})
file(COPY ${SOURCE}/include DESTINATION ${FOLDER})

# Sets `html` to the page that the headers in a folder give.
function(page_from folder)
  execute_process(COMMAND ${COMPILER} -std=c++20 -I${folder} ${INCLUDES} ${program} -o ${FOLDER}/page -lz COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${FOLDER}/page OUTPUT_VARIABLE html COMMAND_ERROR_IS_FATAL ANY)
  set(html "${html}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I${FOLDER}/include ${INCLUDES} ${program} RESULT_VARIABLE failure
                ERROR_VARIABLE messages)
if(NOT failure OR NOT messages MATCHES "assets.hpp is generated: [^`]*`(cmake -P include/[^`]*)`")
  message(FATAL_ERROR "without the page's files as a header, nobody is told what to run:\n${messages}")
endif()
separate_arguments(command UNIX_COMMAND "${CMAKE_MATCH_1}")
execute_process(COMMAND ${command} WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
page_from(${FOLDER}/include)
set(copied "${html}")
if(NOT copied MATCHES "^<!DOCTYPE html>.*</html>\n$")
  message(FATAL_ERROR "no page:\n${copied}")
endif()

page_from(${PREFIX}/include)
if(NOT html STREQUAL copied)
  message(FATAL_ERROR "the installed page is another")
endif()

file(STRINGS ${program} header REGEX "^#include <pulsecast/")
string(REGEX REPLACE ".*<(.*)>.*" "\\1" header "${header}")
execute_process(COMMAND ${CMAKE_COMMAND} "-DINCLUDE=${SOURCE}/include;${BUILD}/include" -DHEADERS=${header} -DOUT=${FOLDER}/single/${header}
                        -P ${SOURCE}/docs/packaging/single_header.cmake COMMAND_ERROR_IS_FATAL ANY)
page_from(${FOLDER}/single)
if(NOT html STREQUAL copied)
  message(FATAL_ERROR "the page of the single header is another")
endif()
