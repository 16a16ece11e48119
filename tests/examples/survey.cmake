# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# The example leaves the same bytes as the survey program does of a survey whose legs share a file:
# cmake -DPROGRAM=survey -DSURVEY_PROGRAM=pulsecast -DFOLDER=... -DSURVEY=tests/examples/pulsecast/survey.xml -P survey.cmake
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)

cmake_path(GET SURVEY PARENT_PATH folder)
file(READ ${SURVEY} text)
string(REGEX REPLACE "<leg( stripId=\"a\")?>" "<leg stripId=\"a\">" text "${text}")
file(WRITE ${FOLDER}/survey.xml "${text}")
expect(1 "missing.xml" missing.xml)
expect(0 "pulses" survey.xml --assets ${folder} --seed 5 --output .)
set(PROGRAM ${SURVEY_PROGRAM})
expect(0 "pulses" survey.xml --assets ${folder} --seed 5 --lasOutput --gpsStartTime "1980-01-06 00:00:00")  # the start of a GPS week
file(GLOB_RECURSE las ${FOLDER}/output/strip00a_points.las)
file(SHA256 ${FOLDER}/cloud.las of_example)
file(SHA256 ${las} of_program)
file(SIZE ${las} size)
if(size LESS 10000 OR NOT of_example STREQUAL of_program)
  message(SEND_ERROR "cloud.las is not ${las}, of ${size} bytes")
endif()
