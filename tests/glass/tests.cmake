# SPDX-License-Identifier: BSD-3-Clause
add_test(NAME glass.pack_glass COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/pack_glass_test.py ${PROJECT_SOURCE_DIR})
set_tests_properties(glass.pack_glass PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
