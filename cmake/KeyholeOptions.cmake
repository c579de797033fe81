# Flags that every target of the project shares.
add_library(keyhole_options INTERFACE)
target_compile_options(keyhole_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms in std::string (GCC bugs 105651, 105329), which a precompiled header lets through.
  target_compile_options(keyhole_options INTERFACE -Wno-restrict -Wno-stringop-overflow
                         -Wno-stringop-overread -Wno-array-bounds)
endif()
# sqrt must not set errno: the inner loop takes many square roots.
target_compile_options(keyhole_options INTERFACE -fno-math-errno)
# Vectors of four doubles are no part of the ABI before AVX: none crosses a library's border.
target_compile_options(keyhole_options INTERFACE -Wno-psabi)
if(KEYHOLE_WERROR)
  target_compile_options(keyhole_options INTERFACE -Werror)
endif()
if(KEYHOLE_NATIVE)
  target_compile_options(keyhole_options INTERFACE -march=native)
endif()
if(KEYHOLE_SANITIZE)
  target_compile_options(keyhole_options INTERFACE -fsanitize=${KEYHOLE_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  if(KEYHOLE_SANITIZE MATCHES thread)
    target_compile_definitions(keyhole_options INTERFACE KEYHOLE_THREAD_SANITIZER)
  endif()
  target_link_options(keyhole_options INTERFACE -fsanitize=${KEYHOLE_SANITIZE})
endif()

# What nearly every file includes, parsed once (Eigen alone takes two seconds): one precompiled header for the
# position-independent libraries, one for the programs.
function(keyhole_precompiled name pic)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cpp CONTENT "// Carries a precompiled header.\n")
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE keyhole_options Eigen3::Eigen)
  target_compile_features(${name} PRIVATE cxx_std_20)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ${pic})
  target_precompile_headers(${name} PRIVATE <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <functional> <map>
                                            <memory> <optional> <string> <vector>)
endfunction()
keyhole_precompiled(keyhole_library_headers ON)
keyhole_precompiled(keyhole_program_headers OFF)

# keyhole_library(NAME DEPENDS...): the library of one folder of src/. All sources of the folder belong to it.
function(keyhole_library name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.h)
  if(sources)
    add_library(keyhole_${name} STATIC ${sources} ${headers})
    set(scope PUBLIC)
    target_link_libraries(keyhole_${name} PRIVATE $<BUILD_INTERFACE:keyhole_options>)
    if(NOT name STREQUAL "chain")  # standard library only
      target_precompile_headers(keyhole_${name} REUSE_FROM keyhole_library_headers)
    endif()
  else()
    add_library(keyhole_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(keyhole::${name} ALIAS keyhole_${name})
  set_property(GLOBAL APPEND PROPERTY KEYHOLE_LIBRARIES keyhole_${name})
  set_target_properties(keyhole_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(keyhole_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/keyhole>)
  target_compile_features(keyhole_${name} ${scope} cxx_std_20)
  target_link_libraries(keyhole_${name} ${scope} ${ARGN})
endfunction()

# Writes a source file that holds the text of every file of mixes/.
function(keyhole_embed_mixes source)
  file(GLOB mixes CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/mixes/*.toml)
  set(entries)
  foreach(mix IN LISTS mixes)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${mix})
    file(READ ${PROJECT_SOURCE_DIR}/${mix} text)
    string(APPEND entries "        {\"${mix}\", R\"mix(${text})mix\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT
"// Made from mixes/ by CMake.
#include \"strategies/builtin_mix_texts.h\"

const std::vector<keyhole::BuiltinMixText>& keyhole::builtin_mix_texts() {
    static const std::vector<BuiltinMixText> texts = {
@entries@    };
    return texts;
}
")
endfunction()
