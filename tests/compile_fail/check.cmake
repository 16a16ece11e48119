# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Compiles SOURCE twice with COMPILER and INCLUDES: as it is, which must succeed, and with SHOULD_NOT_COMPILE defined, which must
# fail with a message that matches the regular expression in the source's comment `// error: ...`. Where that is the fault of options of
# the compiler, each comment `// option: ...` names one; they are tried in turn.

set(ENV{LC_ALL} C)

function(fail reason)
  message(NOTICE "${SOURCE} ${reason}")
  message(FATAL_ERROR "the check failed")
endfunction()

list(TRANSFORM INCLUDES PREPEND -I)
set(compile ${COMPILER} -std=c++20 -fsyntax-only ${INCLUDES} ${SOURCE})

execute_process(COMMAND ${compile} RESULT_VARIABLE failure ERROR_VARIABLE messages)
if(failure)
  fail("should compile, but does not:\n${messages}")
endif()

file(STRINGS ${SOURCE} expected REGEX "^// error: ")
list(LENGTH expected count)
if(NOT count EQUAL 1)
  fail("needs one line `// error: REGEX`")
endif()
string(REGEX REPLACE "^// error: " "" expected "${expected}")

file(STRINGS ${SOURCE} options REGEX "^// option: ")
list(TRANSFORM options REPLACE "^// option: " "")
if(options)
  list(TRANSFORM options APPEND " -Wfatal-errors")  # the first message is the one
else()
  set(options -DSHOULD_NOT_COMPILE)
endif()
foreach(option IN LISTS options)
  separate_arguments(arguments UNIX_COMMAND ${option})
  execute_process(COMMAND ${compile} -DSHOULD_NOT_COMPILE ${arguments} RESULT_VARIABLE failure ERROR_VARIABLE messages)
  if(NOT failure)
    fail("compiles, but should not (${option})")
  elseif(NOT messages MATCHES "${expected}")
    fail("fails without the message `${expected}`:\n${messages}")
  endif()
endforeach()
