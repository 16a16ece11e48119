# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Runs the example PROGRAM in FOLDER as its users would, rightly and wrongly: cmake -DPROGRAM=... -DFOLDER=... -P check.cmake
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

# Fails unless PROGRAM, given the arguments, ends with the code and says what matches.
function(expect code says)
  execute_process(COMMAND ${PROGRAM} ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result STREQUAL "${code}" OR NOT out MATCHES "${says}")
    message(SEND_ERROR "`${PROGRAM} ${ARGN}` ended with ${result}, not ${code}, or without saying `${says}`:\n${out}")
  endif()
endfunction()

expect(0 "--output.*--threads.*--seed" --help)
expect(2 "nonsense" --nonsense)
expect(2 "--threads.*not in range" --threads 0)
expect(2 "--threads.*not in range" --threads -1)
expect(2 "--seed" --seed -1)
file(WRITE ${FOLDER}/file "not a folder")
expect(1 "^.?error: file/.*output folder" --output file/folder)

cmake_path(GET PROGRAM STEM name)
if(NOT name STREQUAL "tripod")
  return()
endif()

expect(2 "--resolution.*not in range" --resolution 0)
expect(2 "--position" --position 1,2)
expect(2 "--position" --position nan,0,0)
expect(2 "--position" --position 1,2,3,4)
expect(1 "missing.obj" missing.obj)
file(WRITE ${FOLDER}/broken.obj "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")
expect(1 "broken.obj, line 4" broken.obj --output untouched)
file(GLOB left ${FOLDER}/untouched/*)
if(left)
  message(SEND_ERROR "a scan that failed left ${left}")
endif()

file(WRITE ${FOLDER}/floor.obj "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\n")
file(WRITE ${FOLDER}/wall.obj "v -5 5 0\nv 5 5 0\nv 5 5 4\nv -5 5 4\nf 1 2 3 4\n")
expect(0 "from 3 set-ups" floor.obj wall.obj --resolution 2)
expect(0 "from 2 set-ups" floor.obj wall.obj --resolution 2 --position 1,0,0 --position -1.5,-2,0)

# The same bytes on any number of threads.
expect(0 "pulses" --resolution 3 --xyz --threads 1 --output 1)
foreach(threads IN ITEMS 2 3 7)
  expect(0 "pulses" --resolution 3 --xyz --threads ${threads} --output ${threads})
  foreach(file IN ITEMS cloud.las cloud.png cloud.xyz trajectory.txt)
    file(SHA256 ${FOLDER}/1/${file} one)
    file(SHA256 ${FOLDER}/${threads}/${file} several)
    if(NOT one STREQUAL several)
      message(SEND_ERROR "${file} is not the same with ${threads} threads as with 1")
    endif()
  endforeach()
endforeach()
