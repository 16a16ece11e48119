# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Compiles SOURCE with COMPILER and INCLUDES: as it is, which must succeed, and with SHOULD_NOT_COMPILE defined, which must fail with messages
# that match the regular expression in each of the source's comments `// error: ...`. Where that is the fault of options of the compiler,
# each comment `// option: ...` names one; they are tried in turn. A comment `// mistake N: ...` stands for a compilation of its own, with
# MISTAKE=N besides: the regular expression must match the first line with `error:`.

set(ENV{LC_ALL} C)

function(fail reason)
  message(NOTICE "${SOURCE} ${reason}")
  message(FATAL_ERROR "the check failed")
endfunction()

list(TRANSFORM INCLUDES PREPEND -I)
set(compile ${COMPILER} -std=c++20 -fsyntax-only ${INCLUDES} ${SOURCE})
if(COMPILER MATCHES "clang")
  list(APPEND compile -ferror-limit=0)
endif()

execute_process(COMMAND ${compile} RESULT_VARIABLE failure ERROR_VARIABLE messages)
if(failure)
  fail("should compile, but does not:\n${messages}")
endif()

# Compiles with arguments, and sets `messages`.
function(must_fail)
  execute_process(COMMAND ${compile} -DSHOULD_NOT_COMPILE ${ARGN} RESULT_VARIABLE failure ERROR_VARIABLE messages)
  if(NOT failure)
    fail("compiles, but should not (${ARGN})")
  endif()
  set(messages "${messages}" PARENT_SCOPE)
endfunction()

function(expect expected)
  if(NOT messages MATCHES "${expected}")
    fail("fails without the message `${expected}`:\n${messages}")
  endif()
endfunction()

file(STRINGS ${SOURCE} mistakes REGEX "^// mistake [0-9]+: ")
foreach(mistake IN LISTS mistakes)
  string(REGEX MATCH "^// mistake ([0-9]+): (.*)$" mistake "${mistake}")
  set(expected "${CMAKE_MATCH_2}")
  must_fail(-DMISTAKE=${CMAKE_MATCH_1} -Wfatal-errors)  # the first message is the one
  expect("error: [^\n]*${expected}")
endforeach()

file(STRINGS ${SOURCE} all_expected REGEX "^// error: ")
list(TRANSFORM all_expected REPLACE "^// error: " "")
if(NOT all_expected AND NOT mistakes)
  fail("needs a line `// error: REGEX` or `// mistake N: REGEX`")
endif()
file(STRINGS ${SOURCE} options REGEX "^// option: ")
list(TRANSFORM options REPLACE "^// option: " "")
if(options)
  list(TRANSFORM options APPEND " -Wfatal-errors")
elseif(all_expected)
  set(options -DMISTAKE=0)
endif()
foreach(option IN LISTS options)
  separate_arguments(arguments UNIX_COMMAND ${option})
  must_fail(${arguments})
  foreach(expected IN LISTS all_expected)
    expect("${expected}")
  endforeach()
endforeach()
