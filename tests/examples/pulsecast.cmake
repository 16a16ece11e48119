# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Runs the survey program as its users would, rightly and wrongly:
# cmake -DPROGRAM=... -DFOLDER=... -DSURVEY=tests/examples/pulsecast/survey.xml -P pulsecast.cmake
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

# Fails unless PROGRAM, given the arguments, ends with the code and says what matches.
function(expect code says)
  execute_process(COMMAND ${PROGRAM} ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result STREQUAL "${code}" OR NOT out MATCHES "${says}")
    message(SEND_ERROR "`${PROGRAM} ${ARGN}` ended with ${result}, not ${code}, or without saying `${says}`:\n${out}")
  endif()
endfunction()

# The hashes of all files below a folder, with their names but for the time in them.
function(sums folder out)
  file(GLOB_RECURSE files RELATIVE ${FOLDER}/${folder} ${FOLDER}/${folder}/*)
  set(all)
  foreach(file IN LISTS files)
    file(SHA256 ${FOLDER}/${folder}/${file} hash)
    cmake_path(GET file FILENAME name)
    list(APPEND all "${name} ${hash}")
  endforeach()
  list(SORT all)
  set(${out} "${all}" PARENT_SCOPE)
endfunction()

expect(0 "--assets.*--format.*--resume" --help)
expect(0 "pulsecast [0-9]" --version)
expect(2 "required" --quiet)
expect(2 "nonsense" ${SURVEY} --nonsense)
expect(2 "format" ${SURVEY} --format doc)
expect(2 "seed" ${SURVEY} --seed x)
expect(1 "missing.xml" check missing.xml)
expect(1 "gpsStartTime" ${SURVEY} --gpsStartTime yesterday)
expect(0 "nothing is wrong" check ${SURVEY})
expect(0 "leg000.*2000.*strip00a" info ${SURVEY})
expect(0 "test_preview.png" preview ${SURVEY} --output preview)
expect(0 "" catalogue)

# faults are told before anything is left
file(READ ${SURVEY} text)
string(REPLACE "scanFreq_hz=\"20\"" "scanFreq_hz=\"200\"" spoilt "${text}")
file(WRITE ${FOLDER}/spoilt.xml "${spoilt}")
cmake_path(GET SURVEY PARENT_PATH folder)
expect(1 "scanFreq_hz" spoilt.xml --assets ${folder} --output untouched)
if(EXISTS ${FOLDER}/untouched)
  message(SEND_ERROR "a survey that cannot be run left a folder")
endif()

set(start --gpsStartTime "2020-01-01 00:00:00")
expect(0 "pulses" ${SURVEY} --output one --threads 1 ${start} --writePulse --writeWaveform --calcEchowidth --rebuildScene)
expect(0 "" ${SURVEY} --output three --nthreads 3 --gps-start-time 1577836800 --write-pulse --write-waveform --calc-echowidth -q -vt)
sums(one one)
sums(three three)
if(NOT one OR NOT one STREQUAL three)
  message(SEND_ERROR "one thread and three left other files:\n${one}\n${three}")
endif()
foreach(name leg000_points.xyz leg000_trajectory.txt leg000_pulse.txt leg000_fullwave.txt strip00a_points.xyz strip00a_trajectory.txt)
  if(NOT one MATCHES "${name} ")
    message(SEND_ERROR "there is no ${name}: ${one}")
  endif()
endforeach()
expect(0 "has no effect" ${SURVEY} --output las --lasOutput --legacyEnergyModel --kdt 2)
file(GLOB_RECURSE las ${FOLDER}/las/leg000_points.las)
if(NOT las)
  message(SEND_ERROR "--lasOutput left no LAS file")
endif()
expect(0 "complete" ${SURVEY} --output las --lasOutput --resume)

# a run of which a leg and the strip are missing
file(GLOB run ${FOLDER}/one/test/*)
file(WRITE ${run}/unfinished.txt "seed 5\nstart_time 259218\nrun 0\nhow other\n")
expect(1 "other options" ${SURVEY} --output one --resume ${start} --writePulse --writeWaveform --calcEchowidth)
