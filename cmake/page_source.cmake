# SPDX-License-Identifier: BSD-3-Clause
# cmake -D OUTPUT=page_files.cpp -D WEB=folder -D MADE=folder -P page_source.cmake: files as bytes of a C++ source.
set(files
  "/|text/html|${WEB}/index.html"
  "/app.js|text/javascript|${MADE}/app.js"
  "/app.css|text/css|${MADE}/app.css"
  "/icon.svg|image/svg+xml|${WEB}/icon.svg")
set(bytes "")
set(rows "")
set(number 0)
foreach(file IN LISTS files)
  string(REPLACE "|" ";" parts "${file}")
  list(GET parts 0 path)
  list(GET parts 1 type)
  list(GET parts 2 source)
  file(READ ${source} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n    " hex "${hex}")
  string(APPEND bytes "constexpr unsigned char file_${number}[] = {\n    ${hex}0};\n")
  string(APPEND rows "    {\"${path}\", \"${type}; charset=utf-8\", text(file_${number})},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: BSD-3-Clause
// Made by cmake/page_source.cmake.
#include <petzval/live/page_files.h>

#include <cstddef>

namespace petzval {

namespace {

${bytes}
/// Without the nought at the end.
template <std::size_t count>
std::string_view text(const unsigned char (&bytes)[count]) {
  return {reinterpret_cast<const char*>(bytes), count - 1};
}

}  // namespace

std::span<const PageFile> page_files() {
  static const PageFile all[] = {
${rows}  };
  return all;
}

}  // namespace petzval
")
