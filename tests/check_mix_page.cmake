# Checks that docs/mix-files.md ends with what `keyhole mixes strategies --markdown` prints.
# Usage: cmake -DROOT=<project folder> -DKEYHOLE=<the command> -P check_mix_page.cmake
cmake_policy(VERSION 3.25)

execute_process(COMMAND ${KEYHOLE} mixes strategies --markdown OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ ${ROOT}/docs/mix-files.md page)
set(mark "<!-- keyhole mixes strategies --markdown -->\n\n")
string(FIND "${page}" "${mark}" start)
string(LENGTH "${mark}" mark_length)
if(start LESS 0)
  message(FATAL_ERROR "docs/mix-files.md has no line ${mark}")
endif()
math(EXPR start "${start} + ${mark_length}")
string(SUBSTRING "${page}" ${start} -1 committed)
if(NOT committed STREQUAL printed)
  message(FATAL_ERROR "docs/mix-files.md is not what the command prints; after the mark, it should read\n${printed}")
endif()
