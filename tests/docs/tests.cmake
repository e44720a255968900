# SPDX-License-Identifier: BSD-3-Clause
# The examples in the documents do what the documents say.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_test(NAME docs.runner_finds_faults COMMAND Python3::Interpreter ${here}/test_run_examples.py)
set_tests_properties(docs.runner_finds_faults PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
if(TARGET petzval_program)
  file(GLOB documents CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/*.md ${PROJECT_SOURCE_DIR}/docs/*.md)
  foreach(document IN LISTS documents)
    get_filename_component(name ${document} NAME_WE)
    string(TOLOWER ${name} name)
    add_test(NAME docs.${name}
      COMMAND Python3::Interpreter ${here}/run_examples.py $<TARGET_FILE:petzval_program> ${document})
    set_tests_properties(docs.${name} PROPERTIES
      ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;PETZVAL_DATA=${PROJECT_SOURCE_DIR}/data")
  endforeach()
endif()
