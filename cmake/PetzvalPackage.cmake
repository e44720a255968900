# SPDX-License-Identifier: BSD-3-Clause
# What `cpack` makes of a build: petzval (the program, its helpers and data) and petzval-dev (headers, library, and the
# package for find_package) for Debian. tools/make_packages.sh makes and tries them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME petzval)
set(CPACK_PACKAGE_CONTACT "The Petzval authors <petzval@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "It takes a lens prescription, a scene and a sensor, and computes what the camera records.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and the static library, for programs of one's own.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_LICENSE BSD-3-Clause)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME petzval)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME petzval-dev)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# What find_package(petzval) looks for in turn (PetzvalDependencies.cmake): the libraries that the build installs, but for
# those of the program and of its helper alone.
file(READ ${PROJECT_SOURCE_DIR}/tools/install_packages.sh packages)
string(REGEX REPLACE ".*# libraries\n([^)#]*)[)].*" "\\1" packages "${packages}")
string(REGEX MATCHALL "[^ \n]+" packages "${packages}")
list(REMOVE_ITEM packages libcli11-dev libraw-dev)
list(JOIN packages ", " packages)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "petzval (= ${PROJECT_VERSION}), ${packages}")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/petzval RENAME copyright COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/petzval-dev RENAME copyright
  COMPONENT development)
include(CPack)
