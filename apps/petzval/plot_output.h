// SPDX-License-Identifier: BSD-3-Clause
// Plots and drawings in files.
#pragma once

#include <string>
#include <vector>

namespace petzval::app {

/// \throws InputError unless the path ends in .svg, .png or .pdf, or one of `others`; for the second and
/// third unless the program rsvg-convert, which makes them of the first, is there.
void require_drawing(const std::string& path, const std::string& what,
                     const std::vector<std::string>& others = {});
/// Whether the path ends in one of the three.
bool is_drawing_name(const std::string& path);

/// Writes a drawing as the extension of `name` says. \param path  the file to write, of any name.
/// \throws Failure.
void write_drawing(const std::string& path, const std::string& svg, const std::string& name);
inline void write_drawing(const std::string& path, const std::string& svg) {
  write_drawing(path, svg, path);
}

}  // namespace petzval::app
