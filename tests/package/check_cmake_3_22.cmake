# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Checks that the CMake files installed under PREFIX use nothing newer than CMake 3.22. No such CMake is packaged for Debian 12, so this
# reads them: every command must be in this list, and no argument in the list of those that came later.
cmake_minimum_required(VERSION 3.25)

# Source: "cmake --help-command-list" of 3.22, those that package files have a use for.
set(commands add_library break cmake_policy continue else elseif endforeach endfunction endif endmacro endwhile file find_dependency find_library find_path
             find_package foreach function get_filename_component get_property get_target_property if include include_guard list macro
             mark_as_advanced math message return set set_property set_target_properties string target_compile_definitions
             target_include_directories target_link_libraries target_sources unset while)
list(APPEND commands and not or)  # these may stand at the beginning of a line within a condition
# Source: the release notes of 3.23, 3.24 and 3.25.
set(arguments BYPASS_PROVIDER CXX_MODULES FILE_SET GLOBAL PATH_EQUAL PROPAGATE REGISTRY_VIEW VALIDATOR)

# What a text uses that CMake 3.22 does not have. Commands of its own, comments and what it has for newer versions only are left out.
function(find_newer text out)
  string(REGEX REPLACE "(^|\n) *#[^\n]*" "\\1" text "${text}")
  string(REGEX REPLACE "if\\(NOT CMAKE_VERSION VERSION_LESS \"3\\.2[3-9][.0-9]*\"\\)\n( [^\n]*\n)*endif\\(\\)\n" "" text "${text}")
  string(REGEX MATCHALL "(function|macro)\\([a-z_]+" own "${text}")
  list(TRANSFORM own REPLACE ".*\\(" "")
  string(REGEX MATCHALL "(^|\n) *[A-Za-z_]+ *\\(" used "${text}")
  list(TRANSFORM used REPLACE "[ \n(]" "")
  list(TRANSFORM used TOLOWER)
  set(newer)
  foreach(command IN LISTS used)
    if(NOT command IN_LIST commands AND NOT command IN_LIST own)
      list(APPEND newer ${command})
    endif()
  endforeach()
  foreach(argument IN LISTS arguments)
    if(text MATCHES "[ \n(]${argument}[ \n)]")
      list(APPEND newer ${argument})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES newer)
  set(${out} "${newer}" PARENT_SCOPE)
endfunction()

# The check notices what it is there to notice.
function(expect_newer text expected)
  find_newer("${text}" newer)
  if(NOT newer STREQUAL expected)
    message(FATAL_ERROR "In \"${text}\" was found \"${newer}\", which should have been \"${expected}\".")
  endif()
endfunction()
set(guarded "\n  target_sources(a\n    INTERFACE\n      FILE_SET \"HEADERS\"\n  )\nendif()\n")
expect_newer("  block(PROPAGATE a)\n  set(b)\nendblock()\n" "block;endblock;PROPAGATE")
expect_newer("find_package(TIFF QUIET GLOBAL)\n" GLOBAL)
expect_newer("if(NOT CMAKE_VERSION VERSION_LESS \"3.22.0\")${guarded}" FILE_SET)
expect_newer("if(NOT CMAKE_VERSION VERSION_LESS \"3.23.0\")${guarded}set(a)\n" "")
expect_newer("# block()\nfunction(own)\n  set(a GLOBALLY)\nendfunction()\nown()\n" "")

file(GLOB_RECURSE files ${PREFIX}/*.cmake)
foreach(needed pulsecast.cmake pulsecastConfig.cmake pulsecastConfigVersion.cmake)
  if(NOT files MATCHES "/${needed}(;|$)")
    message(FATAL_ERROR "${PREFIX} has no ${needed}")
  endif()
endforeach()
foreach(file IN LISTS files)
  file(READ ${file} text)
  find_newer("${text}" newer)
  if(newer)
    message(SEND_ERROR "${file} uses what CMake 3.22 does not have, or what this check does not know of: ${newer}")
  endif()
endforeach()
