# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` puts where: program, static library, headers, data, and the package for find_package. The
# component `program` is what its users need, `development` what programs of others are built with.
include(CMakePackageConfigHelpers)

set(PETZVAL_INSTALL_DATADIR ${CMAKE_INSTALL_DATADIR}/petzval)
set(PETZVAL_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/petzval)

install(TARGETS petzval EXPORT petzvalTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)

# The public headers, and those that they include; all others are the library's own.
set(PETZVAL_PUBLIC_HEADERS petzval.h dataset/dataset.h measure/colour_chart.h measure/photon_transfer.h
  measure/picture_comparison.h measure/sfr/measure_picture.h report/lens_drawing.h target/formats/polygon_file.h
  target/test_charts.h)
function(petzval_install_headers)
  set(waiting ${PETZVAL_PUBLIC_HEADERS})
  set(installed)
  while(waiting)
    list(POP_FRONT waiting header)
    if(header IN_LIST installed)
      continue()
    endif()
    list(APPEND installed ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/src/petzval/${header} lines REGEX "^#include <petzval/")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include <petzval/([^>]*)>.*" "\\1" included ${line})
      list(APPEND waiting ${included})
    endforeach()
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/src/petzval/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/petzval/${folder}
      COMPONENT development)
  endwhile()
  list(SORT installed)
  list(TRANSFORM installed PREPEND ${PROJECT_SOURCE_DIR}/src/petzval/ OUTPUT_VARIABLE documented)
  list(JOIN documented " " PETZVAL_API_INPUT)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
  string(REPLACE ";" "\n" installed "${installed}")
  file(WRITE ${PROJECT_BINARY_DIR}/public_headers.txt "${installed}\n")
endfunction()
petzval_install_headers()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/ DESTINATION ${PETZVAL_INSTALL_DATADIR} COMPONENT program PATTERN "*.py" EXCLUDE)
# Found from the data: a prefix holds share/petzval and libexec/petzval, wherever it is moved.
install(TARGETS petzval_read_hdf5 RUNTIME DESTINATION libexec/petzval COMPONENT program)
if(PETZVAL_BUILD_APPS)
  # The program finds its data in ../share/petzval beside itself, so the whole tree may be moved.
  install(TARGETS petzval_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/share/petzval.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/share/petzval.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME petzval COMPONENT program)
endif()

install(EXPORT petzvalTargets NAMESPACE petzval:: DESTINATION ${PETZVAL_INSTALL_CMAKEDIR} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/petzvalConfig.cmake.in
  ${PROJECT_BINARY_DIR}/petzvalConfig.cmake
  INSTALL_DESTINATION ${PETZVAL_INSTALL_CMAKEDIR} PATH_VARS PETZVAL_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/petzvalConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/petzvalConfig.cmake ${PROJECT_BINARY_DIR}/petzvalConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/PetzvalDependencies.cmake ${CMAKE_CURRENT_LIST_DIR}/default_data.cpp.in DESTINATION ${PETZVAL_INSTALL_CMAKEDIR}
  COMPONENT development)

# `--target site`: the documents as a site, with the pages of the C++ interface, in site/html.
find_program(DOXYGEN doxygen)
if(DOXYGEN AND PETZVAL_BUILD_APPS)
  add_custom_target(site
    COMMAND ${DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/make_site.py $<TARGET_FILE:petzval_program> ${PROJECT_BINARY_DIR}/site
      --api ${PROJECT_BINARY_DIR}/api/html
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Writing the site" VERBATIM)
endif()
