// SPDX-License-Identifier: BSD-3-Clause
#include "plot_output.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/whole_file.h>

#include "command.h"
#include "other_program.h"

namespace petzval::app {

void require_drawing(const std::string& path, const std::string& what,
                     const std::vector<std::string>& others) {
  std::vector<std::string> extensions{".svg", ".png", ".pdf"};
  extensions.insert(extensions.end(), others.begin(), others.end());
  require_extension(path, extensions, what);
  const std::string extension = extension_of(path);
  if ((extension == ".png" || extension == ".pdf") && run_other_program({"rsvg-convert", "--version"}) != 0)
    throw InputError(path,
                     "needs the program rsvg-convert (Debian: apt install librsvg2-bin); an .svg can be had "
                     "without it");
}

bool is_drawing_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".svg" || extension == ".png" || extension == ".pdf";
}

void write_drawing(const std::string& path, const std::string& svg, const std::string& name) {
  const std::string extension = extension_of(name);
  if (extension == ".svg") return write_whole_file(path, svg);
  constexpr const char* zoom = "2";  // a drawing is some 600 pixels wide
  WholeFile drawn(path), source(path + ".svg");
  write_whole_file(source.temporary_path(), svg);
  std::vector<std::string> words{"rsvg-convert", "--format", extension.substr(1),    "--background-color",
                                 "white",        "--output", drawn.temporary_path(), source.temporary_path()};
  if (extension == ".png") words.insert(words.begin() + 1, {"--zoom", zoom});
  if (run_other_program(words) != 0) throw Failure(fmt::format("{}: rsvg-convert could not write it", name));
  drawn.commit();
}

}  // namespace petzval::app
