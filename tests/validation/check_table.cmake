# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Holds the table of docs/validation.md against what the validation tests print:
# cmake -DPROGRAM=test_validation -DDOCUMENT=docs/validation.md [-DUPDATE=ON] -P check_table.cmake

execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE printed RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "The validation tests fail:\n${printed}")
endif()
string(REGEX REPLACE "\n[^|\n][^\n]*" "" rows "\n${printed}")
string(REGEX REPLACE "\n\n+" "\n" rows "${rows}")
string(STRIP "${rows}" rows)
set(table "| case | closed form | simulated | tolerance |\n|---|---:|---:|---:|\n${rows}\n")

set(begin "<!-- What follows is printed by the tests. -->\n")
set(end "<!-- End of what the tests print. -->")
file(READ ${DOCUMENT} document)
string(FIND "${document}" "${begin}" from)
string(FIND "${document}" "${end}" to)
if(from EQUAL -1 OR to EQUAL -1)
  message(FATAL_ERROR "${DOCUMENT} has no place for the table")
endif()
string(LENGTH "${begin}" length)
math(EXPR from "${from} + ${length}")
math(EXPR length "${to} - ${from}")
string(SUBSTRING "${document}" ${from} ${length} written)
if(written STREQUAL table)
  return()
endif()
if(NOT UPDATE)
  message(FATAL_ERROR "${DOCUMENT} has another table than the tests print; -DUPDATE=ON writes it:\n${table}")
endif()
string(SUBSTRING "${document}" 0 ${from} before)
string(SUBSTRING "${document}" ${to} -1 after)
file(WRITE ${DOCUMENT} "${before}${table}${after}")
