# `cmake --install`: the command, the libraries with their headers, and the files for find_package(keyhole).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/keyhole)

install(TARGETS keyhole RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
get_property(libraries GLOBAL PROPERTY KEYHOLE_LIBRARIES)
install(TARGETS ${libraries} EXPORT keyholeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT keyholeTargets NAMESPACE keyhole:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/keyhole
        FILES_MATCHING PATTERN "*.h" PATTERN app EXCLUDE)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/keyholeConfig.cmake.in
  ${PROJECT_BINARY_DIR}/keyholeConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/keyholeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/keyholeConfig.cmake ${PROJECT_BINARY_DIR}/keyholeConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindOpenImageIO.cmake ${CMAKE_CURRENT_LIST_DIR}/FindRandom123.cmake
        DESTINATION ${package_dir})
