# SPDX-License-Identifier: BSD-3-Clause
# tests/cli/test_*.py run the built program: what a user, a script or another program relies on.
if(TARGET petzval_program)
  file(GLOB scripts CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/test_*.py)
  foreach(script IN LISTS scripts)
    get_filename_component(name ${script} NAME_WE)
    string(REPLACE "test_" "cli." name ${name})
    add_test(NAME ${name} COMMAND Python3::Interpreter ${script})
    # AddressSanitizer keeps memory of its own beside the program's: bounds on memory hold without it.
    set(sanitized "")
    if(CMAKE_CXX_FLAGS MATCHES "sanitize=[a-z,-]*address")
      set(sanitized "PETZVAL_SANITIZED=1;")
    endif()
    set_tests_properties(${name} PROPERTIES ENVIRONMENT
      "${sanitized}PYTHONDONTWRITEBYTECODE=1;PETZVAL_PROGRAM=$<TARGET_FILE:petzval_program>;PETZVAL_DATA=${PROJECT_SOURCE_DIR}/data")
  endforeach()
  # Programs of others, that are not asked for on every machine.
  set_tests_properties(cli.raw_programs PROPERTIES SKIP_RETURN_CODE 77)
endif()
