# SPDX-License-Identifier: BSD-3-Clause
# The examples in the documents do what the documents say, and those in examples/ run.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_test(NAME docs.runner_finds_faults COMMAND Python3::Interpreter ${here}/test_run_examples.py)
set_tests_properties(docs.runner_finds_faults PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
if(TARGET petzval_program)
  file(GLOB documents CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/*.md ${PROJECT_SOURCE_DIR}/docs/*.md)
  list(REMOVE_ITEM documents ${PROJECT_SOURCE_DIR}/docs/HOWTO_CPP.md)  # consumer.find_package runs it
  foreach(document IN LISTS documents)
    get_filename_component(name ${document} NAME_WE)
    string(TOLOWER ${name} name)
    add_test(NAME docs.${name}
      COMMAND Python3::Interpreter ${here}/run_examples.py $<TARGET_FILE:petzval_program> ${document})
    set_tests_properties(docs.${name} PROPERTIES
      ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;PETZVAL_DATA=${PROJECT_SOURCE_DIR}/data")
  endforeach()

  # All of them as a site: no page that no list has, no link that leads nowhere.
  add_test(NAME docs.site COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/tools/make_site.py
    $<TARGET_FILE:petzval_program> ${PROJECT_BINARY_DIR}/site)
  set_tests_properties(docs.site PROPERTIES SKIP_RETURN_CODE 77
    ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;PETZVAL_DATA=${PROJECT_SOURCE_DIR}/data")
  find_program(DOXYGEN doxygen)
  if(DOXYGEN)  # headers whose comments name parameters that are not there
    add_test(NAME docs.api_pages COMMAND ${DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile)
    set_tests_properties(docs.api_pages PROPERTIES FAIL_REGULAR_EXPRESSION "warning:")
  endif()

  # examples/, as their README says to run them.
  set(examples ${PROJECT_SOURCE_DIR}/examples)
  set(scratch ${PROJECT_BINARY_DIR}/examples)
  file(MAKE_DIRECTORY ${scratch})
  add_test(NAME examples.open_a_gap COMMAND ${examples}/open_a_gap.sh)
  add_test(NAME examples.choose_lens COMMAND ${examples}/choose_lens.sh)
  add_test(NAME examples.stop_down COMMAND ${examples}/stop_down.sh ${scratch})
  add_test(NAME examples.build_table COMMAND petzval_program optics build edmund-54852 --wavelengths 587.56
    --sensor third-inch-768x576 -o edmund.h5)
  add_test(NAME examples.read_table COMMAND Python3::Interpreter ${examples}/read_table.py edmund.h5)
  add_test(NAME examples.closed_loop COMMAND Python3::Interpreter ${examples}/closed_loop.py)
  set_tests_properties(examples.build_table PROPERTIES FIXTURES_SETUP table)
  set_tests_properties(examples.read_table PROPERTIES FIXTURES_REQUIRED table)
  set_tests_properties(examples.open_a_gap examples.choose_lens examples.stop_down examples.build_table examples.read_table
    examples.closed_loop PROPERTIES
    WORKING_DIRECTORY ${scratch}
    ENVIRONMENT "PATH=$<TARGET_FILE_DIR:petzval_program>:$ENV{PATH};PETZVAL_DATA=${PROJECT_SOURCE_DIR}/data")
endif()
