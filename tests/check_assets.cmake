# Checks that scenes/generate_assets.py writes the meshes and textures that are in the folder, byte for byte, and that
# the folder has no others. Usage: cmake -DROOT=<project folder> -DPYTHON=<python3> -DWORK=<folder> -P check_assets.cmake
cmake_policy(VERSION 3.25)

file(REMOVE_RECURSE ${WORK})
file(COPY ${ROOT}/scenes/generate_assets.py DESTINATION ${WORK})
execute_process(COMMAND ${PYTHON} ${WORK}/generate_assets.py COMMAND_ERROR_IS_FATAL ANY)

file(GLOB made RELATIVE ${WORK} ${WORK}/meshes/* ${WORK}/textures/*)
file(GLOB kept RELATIVE ${ROOT}/scenes ${ROOT}/scenes/meshes/* ${ROOT}/scenes/textures/*)
if(NOT made OR NOT made STREQUAL kept)
  message(FATAL_ERROR "generate_assets.py writes ${made}, but scenes/ holds ${kept}")
endif()
foreach(file IN LISTS made)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WORK}/${file} ${ROOT}/scenes/${file}
                  RESULT_VARIABLE different)
  if(different)
    message(FATAL_ERROR "scenes/${file} is not what generate_assets.py writes")
  endif()
endforeach()
list(LENGTH made count)
message(STATUS "All ${count} generated files are as kept.")
