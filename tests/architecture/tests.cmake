# SPDX-License-Identifier: BSD-3-Clause
# Rules that the compiler does not know: directions of includes, licence lines, nothing left unfinished, a list
# that must be whole.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_test(NAME architecture.include_directions
  COMMAND Python3::Interpreter ${here}/include_directions.py
    ${PROJECT_SOURCE_DIR}/src/petzval ${PROJECT_SOURCE_DIR}/tests)
add_test(NAME architecture.source_rules COMMAND Python3::Interpreter ${here}/source_rules.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.symmetry_list
  COMMAND Python3::Interpreter ${here}/symmetry_list.py
    ${PROJECT_SOURCE_DIR}/docs/TRACING.md ${PROJECT_SOURCE_DIR}/src/petzval)
add_test(NAME architecture.checked_by COMMAND Python3::Interpreter ${here}/checked_by.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.photon_path
  COMMAND Python3::Interpreter ${here}/photon_path.py
    ${PROJECT_SOURCE_DIR}/docs/ARCHITECTURE.md ${PROJECT_SOURCE_DIR}/src/petzval)
if(TARGET petzval_program)
  add_test(NAME architecture.parameter_names
    COMMAND Python3::Interpreter ${here}/parameter_names.py $<TARGET_FILE:petzval_program>
      ${PROJECT_SOURCE_DIR}/src/petzval ${PROJECT_SOURCE_DIR}/apps/petzval/option_names.cpp)
endif()
find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
if(CLANG_FORMAT)
  file(GLOB_RECURSE formatted CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/src/*.cpp
    ${PROJECT_SOURCE_DIR}/apps/*.h ${PROJECT_SOURCE_DIR}/apps/*.cpp ${PROJECT_SOURCE_DIR}/tests/*.h
    ${PROJECT_SOURCE_DIR}/tests/*.cpp ${PROJECT_SOURCE_DIR}/bench/*.h ${PROJECT_SOURCE_DIR}/bench/*.cpp
    ${PROJECT_SOURCE_DIR}/fuzz/*.h ${PROJECT_SOURCE_DIR}/fuzz/*.cpp ${PROJECT_SOURCE_DIR}/python/*.h ${PROJECT_SOURCE_DIR}/python/*.cpp ${PROJECT_SOURCE_DIR}/examples/*.cpp)
  add_test(NAME architecture.format COMMAND ${CLANG_FORMAT} --dry-run -Werror ${formatted})
endif()
find_program(CLANG NAMES clang++-14 clang++)
if(CLANG)
  foreach(what headers sources)
    add_test(NAME architecture.clang_${what}
      COMMAND Python3::Interpreter ${here}/clang_clean.py ${what} ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CLANG})
    set_tests_properties(architecture.clang_${what} PROPERTIES PROCESSORS 2 SKIP_RETURN_CODE 77)
  endforeach()
endif()
foreach(checker include_directions source_rules)
  add_test(NAME architecture.${checker}_finds_faults COMMAND Python3::Interpreter ${here}/test_${checker}.py)
  set_tests_properties(architecture.${checker} architecture.${checker}_finds_faults PROPERTIES
    ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
endforeach()
