# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` puts where: program, static library, headers, data, and the package for find_package.
include(CMakePackageConfigHelpers)

set(PETZVAL_INSTALL_DATADIR ${CMAKE_INSTALL_DATADIR}/petzval)
set(PETZVAL_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/petzval)

install(TARGETS petzval EXPORT petzvalTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/petzval DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/ DESTINATION ${PETZVAL_INSTALL_DATADIR} PATTERN "*.py" EXCLUDE)
if(PETZVAL_BUILD_APPS)
  # The program finds its data in ../share/petzval beside itself, so the whole tree may be moved.
  install(TARGETS petzval_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

install(EXPORT petzvalTargets NAMESPACE petzval:: DESTINATION ${PETZVAL_INSTALL_CMAKEDIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/petzvalConfig.cmake.in
  ${PROJECT_BINARY_DIR}/petzvalConfig.cmake
  INSTALL_DESTINATION ${PETZVAL_INSTALL_CMAKEDIR} PATH_VARS PETZVAL_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/petzvalConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/petzvalConfig.cmake ${PROJECT_BINARY_DIR}/petzvalConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/PetzvalDependencies.cmake ${CMAKE_CURRENT_LIST_DIR}/default_data.cpp.in DESTINATION ${PETZVAL_INSTALL_CMAKEDIR})
