# SPDX-License-Identifier: BSD-3-Clause
# The page of `petzval live` in the library: TypeScript and styles of web/ bundled by esbuild, and the bundle as a C++ source.
find_program(ESBUILD esbuild)
mark_as_advanced(ESBUILD)
if(NOT ESBUILD)
  message(FATAL_ERROR "the program esbuild is missing, which bundles the page of petzval live; tools/install_packages.sh "
    "installs Debian's, another one is chosen by -D ESBUILD=PATH")
endif()

# petzval_page(TARGET): adds the page's source to a target.
function(petzval_page target)
  set(web ${PROJECT_SOURCE_DIR}/web)
  set(made ${PROJECT_BINARY_DIR}/web)
  file(GLOB parts CONFIGURE_DEPENDS ${web}/*.ts ${web}/*.css)
  add_custom_command(OUTPUT ${made}/app.js ${made}/app.css
    COMMAND ${ESBUILD} ${web}/main.ts --bundle --minify --charset=utf8 --target=es2020 --log-level=warning --outfile=${made}/app.js
    COMMAND ${ESBUILD} ${web}/style.css --bundle --minify --charset=utf8 --log-level=warning --outfile=${made}/app.css
    DEPENDS ${parts} VERBATIM)
  add_custom_command(OUTPUT ${made}/page_files.cpp
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${made}/page_files.cpp -D WEB=${web} -D MADE=${made}
      -P ${PROJECT_SOURCE_DIR}/cmake/page_source.cmake
    DEPENDS ${made}/app.js ${made}/app.css ${web}/index.html ${web}/icon.svg ${PROJECT_SOURCE_DIR}/cmake/page_source.cmake VERBATIM)
  target_sources(${target} PRIVATE ${made}/page_files.cpp)
  set_source_files_properties(${made}/page_files.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
