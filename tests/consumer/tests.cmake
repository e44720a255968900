# SPDX-License-Identifier: BSD-3-Clause
# The installed package, used by a project that is not part of this one.
add_test(NAME consumer.find_package
  COMMAND ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR} -D SOURCE=${CMAKE_CURRENT_LIST_DIR} -D TREE=${PROJECT_SOURCE_DIR}
    -D SCRATCH=${PROJECT_BINARY_DIR}/consumer -D PYTHON=${Python3_EXECUTABLE} -D COMPILER=${CMAKE_CXX_COMPILER} "-DFLAGS=${CMAKE_CXX_FLAGS}"
    -D CONFIGURATION=${CMAKE_BUILD_TYPE} -P ${CMAKE_CURRENT_LIST_DIR}/build_and_run.cmake)
