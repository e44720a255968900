# SPDX-License-Identifier: BSD-3-Clause
# The page of petzval live in a real browser, where there is one that can be driven; and its types, where there is tsc.
find_program(CHROMIUM chromium)
find_program(CHROMEDRIVER chromedriver)
execute_process(COMMAND ${Python3_EXECUTABLE} -c "import selenium" RESULT_VARIABLE no_selenium OUTPUT_QUIET ERROR_QUIET)
if(TARGET petzval_program AND CHROMIUM AND CHROMEDRIVER AND no_selenium EQUAL 0)
  foreach(what IN ITEMS page scenes)
    add_test(NAME browser.live_${what} COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/test_live_${what}.py
      $<TARGET_FILE:petzval_program> ${CHROMIUM} ${CHROMEDRIVER})
    # Nothing in them depends on time. They are begun first, for they are the longest, and one after the other.
    set_tests_properties(browser.live_${what} PROPERTIES RESOURCE_LOCK browser COST 1000 TIMEOUT 1500 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
  endforeach()
else()
  message(STATUS "no test in a browser: it wants chromium, chromium-driver and python3-selenium")
endif()
find_program(TSC tsc)
if(TSC)
  add_test(NAME architecture.page_types COMMAND ${TSC} -p ${PROJECT_SOURCE_DIR}/web)
endif()
