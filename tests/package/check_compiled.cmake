# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Installs the library in SOURCE with `pulsecast::compiled` into FOLDER. A project with OPTIONS must link it and run; the same project with
# containers of another size must not link, and the message must name the check.
file(REMOVE_RECURSE ${FOLDER})
function(run)
  execute_process(COMMAND ${CMAKE_COMMAND} ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(-S ${SOURCE} -B ${FOLDER}/library ${OPTIONS} -DBUILD_TESTING=OFF -DPULSECAST_PROGRAMS=OFF -DPULSECAST_COMPILED=ON)
run(--build ${FOLDER}/library)
run(--install ${FOLDER}/library --prefix ${FOLDER}/prefix)
run(-S ${CMAKE_CURRENT_LIST_DIR} -B ${FOLDER}/program ${OPTIONS} -DINSTALLED=${FOLDER}/prefix -DTARGETS=helios,compiled)
run(--build ${FOLDER}/program --target consumer)
execute_process(COMMAND ${FOLDER}/program/consumer COMMAND_ERROR_IS_FATAL ANY)

execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER}/program --target other_build RESULT_VARIABLE failed OUTPUT_VARIABLE messages
                ERROR_VARIABLE messages)
if(NOT failed)
  message(FATAL_ERROR "a program of another build links")
elseif(NOT messages MATCHES "undefined reference to [^\n]*compiled_library_of_this_build<")
  message(FATAL_ERROR "a program of another build does not link, but for another reason:\n${messages}")
endif()
