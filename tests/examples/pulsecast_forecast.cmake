# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Plans surveys with the survey program, and holds the plans against what comes of running them:
# cmake -DPROGRAM=... -DFOLDER=... -DSURVEY=tests/examples/pulsecast/survey.xml -P pulsecast_forecast.cmake
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
set(ENV{XDG_CACHE_HOME} ${FOLDER}/cache)

include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)

# quantities and their units
foreach(range 5 0mm -5mm 5s 5mm2 mm nan 1e999mm)
  expect(2 "accuracy.*'range=${range}': expected a length" forecast ${SURVEY} --accuracy=range=${range})
endforeach()
foreach(intensity 2x 0 0% %)
  expect(2 "accuracy.*'intensity=${intensity}': expected a share" forecast ${SURVEY} --accuracy range=5mm,intensity=${intensity})
endforeach()
foreach(limits "ranges=5mm" "5mm" ",")
  expect(2 "accuracy.*expected range=, position=, intensity= or echoes=" ${SURVEY} --accuracy ${limits})
endforeach()
foreach(time 10 5m 1d 0s)
  expect(2 "time.*'${time}': expected a duration" forecast ${SURVEY} --time ${time})
endforeach()
foreach(memory 4 4G 4Gbit 0GB)
  expect(2 "memory.*'${memory}': expected a size" forecast ${SURVEY} --memory ${memory})
endforeach()
foreach(asked "--time;10min" "--apply")
  expect(2 "is for forecast only" ${SURVEY} ${asked})
endforeach()
expect(2 "--accuracy is for a run or forecast only" info ${SURVEY} --accuracy range=5mm)
expect(2 "--apply needs a limit" forecast ${SURVEY} --apply)
expect(2 "expected SURVEY.xml" forecast)
expect(1 "missing.xml" forecast missing.xml)

# The survey with a fortieth of its pulses, which takes less time to plan, and its files.
cmake_path(GET SURVEY PARENT_PATH folder)
file(COPY ${folder}/plane.obj ${folder}/plane.mtl DESTINATION ${FOLDER}/own)
file(READ ${SURVEY} before)
string(REPLACE "pulseFreqs_Hz=\"2000\"" "pulseFreqs_Hz=\"50\"" before "${before}")
file(WRITE ${FOLDER}/own/survey.xml "${before}")

# what fits and what does not, of each kind and in any unit
expect(0 "current settings: beamSampleQuality 2 .7 subrays., binSize_ns 0.25.*run time.*memory.*points.*files.*range, 95 %.*intensity, 95 %.*lost echoes.*invented echoes" forecast own/survey.xml)
foreach(able "--time;2h" "--time;600MIN" "--memory;900 GB" "--memory;500GiB" "--accuracy;range=10m,echoes=9" "--accuracy;RANGE=1000cm,echoes=900%"
             "--accuracy;intensity=9,echoes=9" "--time;2h;--memory;900GB;--accuracy;range=10m,position=20 m,intensity=9,echoes=9")
  expect(0 "best within the limits: beamSampleQuality" forecast own/survey.xml ${able})
endforeach()
foreach(unable "--time;0.001ms" "--memory;0.001kB" "--accuracy;range=1e-9um" "--accuracy;intensity=1e-12%"
               "--accuracy;range=10m,echoes=9;--memory;1kB")
  expect(1 "nearest: beamSampleQuality.*error: no settings meet the limits" forecast own/survey.xml ${unable} --apply own/untouched.xml)
endforeach()
if(EXISTS ${FOLDER}/own/untouched.xml)
  message(SEND_ERROR "a survey was written although no settings meet the limits")
endif()

# Sets `out` to the points that a survey is said to have as it is, and `low` and `high` to the ends of the interval.
function(planned out low high)
  execute_process(COMMAND ${PROGRAM} forecast ${ARGN} WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT text MATCHES "  points +([0-9]+) .([0-9]+) to ([0-9]+)")
    message(SEND_ERROR "`forecast ${ARGN}` says nothing of points:\n${text}")
  endif()
  set(${out} ${CMAKE_MATCH_1} PARENT_SCOPE)
  set(${low} ${CMAKE_MATCH_2} PARENT_SCOPE)
  set(${high} ${CMAKE_MATCH_3} PARENT_SCOPE)
endfunction()

# Sets `out` to the points that a run leaves.
function(simulated out)
  file(REMOVE_RECURSE ${FOLDER}/output)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --output output -q WORKING_DIRECTORY ${FOLDER})
  file(GLOB_RECURSE files ${FOLDER}/output/*_points.xyz)
  set(points 0)
  foreach(file IN LISTS files)
    file(STRINGS ${file} lines)
    list(LENGTH lines number)
    math(EXPR points "${points} + ${number}")
  endforeach()
  set(${out} ${points} PARENT_SCOPE)
endfunction()

# A small survey is counted as a whole; one with more pulses than a sample has, and swaps, is forecast within 5 %.
simulated(points ${SURVEY})
planned(value low high ${SURVEY})
if(points EQUAL 0 OR NOT points EQUAL value OR NOT points EQUAL low OR NOT points EQUAL high)
  message(SEND_ERROR "a small survey has ${points} points, and was planned to have ${value} (${low} to ${high})")
endif()
file(READ ${folder}/long.xml text)
string(REPLACE "pulseFreqs_Hz=\"30000\"" "pulseFreqs_Hz=\"90000\"" text "${text}")
file(WRITE ${FOLDER}/long.xml "${text}")
simulated(points long.xml --assets ${folder})
planned(value low high long.xml --assets ${folder})
math(EXPR least "${points} * 95 / 100")
math(EXPR most "${points} * 105 / 100")
if(points EQUAL 0 OR value LESS least OR value GREATER most OR low GREATER value OR high LESS value)
  message(SEND_ERROR "a long survey has ${points} points, and was planned to have ${value} (${low} to ${high})")
endif()

# Points, memory and files of a run are within their intervals: with compressors on many threads, with an octree of points that waits on the
# disk, and with a line of text for each pulse.
file(READ ${FOLDER}/long.xml text)
string(REGEX REPLACE "<swap>.*</swap>" "" text "${text}")  # the same scene in each run
file(WRITE ${FOLDER}/alike.xml "${text}")
set(table ${CMAKE_CURRENT_LIST_DIR}/../../bench/forecast.sh)
foreach(how "laz;-j;8" "copc.laz;-j;2;--writePulse")
  execute_process(COMMAND bash ${table} ${PROGRAM} alike.xml -- --assets ${folder} --seed 1 --format ${how}
                  WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE text ERROR_VARIABLE text)
  string(REGEX MATCHALL ", in\\)" within "${text}")
  list(LENGTH within number)
  if(NOT number EQUAL 3)
    message(SEND_ERROR "a forecast of ${how} is wrong:\n${text}")
  endif()
endforeach()

# Applies the cheapest settings there are, and sets `out` to the rings of subrays that were chosen: by time, so it may be others each time.
function(applied out)
  execute_process(COMMAND ${PROGRAM} forecast ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT result EQUAL 0 OR NOT text MATCHES "limits: beamSampleQuality ([0-9]+) .[0-9]+ subrays?., binSize_ns ([0-9.]+).*written to own/[a-z]+.xml")
    message(SEND_ERROR "nothing was applied: ${text}")
  endif()
  set(${out} ${CMAKE_MATCH_1} PARENT_SCOPE)
endfunction()

# What is applied is what was chosen, and nothing else is touched.
applied(rings own/survey.xml --accuracy range=10m,echoes=9 --apply own/new.xml)
file(READ ${FOLDER}/own/new.xml after)
set(element "\n *<FWFSettings beamSampleQuality=\"${rings}\" binSize_ns=\"[0-9.]+\"/>")
if(NOT after MATCHES "<survey [^>]*>${element}")
  message(SEND_ERROR "beamSampleQuality ${rings} was not applied:\n${after}")
endif()
string(REGEX REPLACE "${element}" "" rest "${after}")
if(NOT rest STREQUAL before)
  message(SEND_ERROR "more was changed than should be:\n${rest}\n${before}")
endif()
expect(0 "nothing is wrong" check own/new.xml)
expect(0 "current settings: beamSampleQuality ${rings} " forecast own/new.xml)
file(READ ${FOLDER}/own/survey.xml now)
if(NOT now STREQUAL before)
  message(SEND_ERROR "the survey itself was changed")
endif()
file(READ ${FOLDER}/own/new.xml text)  # what stands there is replaced, however it is written
string(REGEX REPLACE "beamSampleQuality=.${rings}. binSize_ns=\"[0-9.]+\"" "\n  winSize_ns='1' beamSampleQuality\n = '20'" text "${text}")
file(WRITE ${FOLDER}/own/new.xml "${text}")
applied(rings own/survey.xml --accuracy range=10m,echoes=9 --apply)
expect(0 "current settings: beamSampleQuality ${rings} " forecast own/survey.xml)
applied(rings own/new.xml --accuracy range=10m,echoes=9 --apply)
file(READ ${FOLDER}/own/new.xml text)
if(NOT text MATCHES "<FWFSettings binSize_ns=\"[0-9.]+\" *\n  winSize_ns='1' beamSampleQuality\n = '${rings}'/>")
  message(SEND_ERROR "settings were not replaced in their place:\n${text}")
endif()

# A symbolic link stays one, and what it leads to keeps its mode; its files are found from where the link stands.
file(MAKE_DIRECTORY ${FOLDER}/elsewhere)
file(RENAME ${FOLDER}/own/survey.xml ${FOLDER}/elsewhere/real.xml)
file(CHMOD ${FOLDER}/elsewhere/real.xml PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ)
file(CREATE_LINK ../elsewhere/real.xml ${FOLDER}/own/survey.xml SYMBOLIC)
string(REPLACE "= '${rings}'" "= '20'" text "${text}")
file(WRITE ${FOLDER}/elsewhere/real.xml "${text}")
applied(rings own/survey.xml --accuracy range=10m,echoes=9 --apply)
file(READ ${FOLDER}/elsewhere/real.xml text)
execute_process(COMMAND stat -c %A elsewhere/real.xml own/survey.xml WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE modes)
if(NOT modes MATCHES "^-rw-r-----\nl" OR NOT text MATCHES "beamSampleQuality\n* *= *'${rings}'")
  message(SEND_ERROR "through a symbolic link, ${rings} was written otherwise: ${modes}${text}")
endif()
file(GLOB left RELATIVE ${FOLDER}/own ${FOLDER}/own/* ${FOLDER}/elsewhere/*)
if(left MATCHES "part")
  message(SEND_ERROR "a trial is left: ${left}")
endif()

expect(1 "error" forecast own/survey.xml --accuracy range=10m,echoes=9 --apply nowhere/new.xml)  # there is no such folder
expect(1 "plane.obj" forecast own/survey.xml --accuracy range=10m,echoes=9 --apply astray.xml)  # its files would not be found from there
if(EXISTS ${FOLDER}/astray.xml OR EXISTS ${FOLDER}/astray.xml.part)
  message(SEND_ERROR "a survey was written that cannot be read")
endif()

# A run takes the cheapest settings that reach an accuracy, and says what it reached; without such settings it does not begin.
expect(0 "accuracy range=10m,echoes=900%.*chosen +beamSampleQuality.*range, 95 %: .*lost echoes: .*errors by a sample.*sampling.*instrument"
       own/survey.xml --accuracy range=10m,echoes=9 --seed 1 --output accurate)
file(GLOB reports ${FOLDER}/accurate/*/*/report.json)
if(NOT reports)
  message(SEND_ERROR "a run with an accuracy has no report.json")
endif()
expect(1 "accuracy range=1e-12.*mm.*no settings are known to reach it; nearest are beamSampleQuality [0-9]+ .*lost echoes"
       own/survey.xml --accuracy range=1e-9um --seed 1 --output inaccurate)
if(EXISTS ${FOLDER}/inaccurate)
  message(SEND_ERROR "a run began although no settings reach the accuracy")
endif()
