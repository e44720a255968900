# SPDX-License-Identifier: BSD-3-Clause
# python/tests, by pytest, on the package as it lies in the tree of the build.
if(TARGET petzval_python AND TARGET petzval_program)
  execute_process(COMMAND ${PETZVAL_PYTHON} -c "import pytest, xarray" RESULT_VARIABLE without_pytest ERROR_QUIET)
  if(without_pytest)
    message(STATUS "${PETZVAL_PYTHON} has no pytest or no xarray: the tests python.* are left out")
  else()
    file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/tests/test_*.py)
    foreach(script IN LISTS scripts)
      get_filename_component(name ${script} NAME_WE)
      string(REPLACE "test_" "python." name ${name})
      add_test(NAME ${name} COMMAND ${PETZVAL_PYTHON} -m pytest -q -c ${PROJECT_SOURCE_DIR}/pyproject.toml ${script})
      set_tests_properties(${name} PROPERTIES ENVIRONMENT
        "PYTHONDONTWRITEBYTECODE=1;PYTHONPATH=${PROJECT_BINARY_DIR}/python;PETZVAL_PROGRAM=$<TARGET_FILE:petzval_program>")
    endforeach()
  endif()
endif()
