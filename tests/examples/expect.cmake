# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Fails unless PROGRAM, given the arguments, ends with the code and says what matches.
function(expect code says)
  execute_process(COMMAND ${PROGRAM} ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result STREQUAL "${code}" OR NOT out MATCHES "${says}")
    message(SEND_ERROR "`${PROGRAM} ${ARGN}` ended with ${result}, not ${code}, or without saying `${says}`:\n${out}")
  endif()
endfunction()
