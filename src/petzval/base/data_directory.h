// SPDX-License-Identifier: BSD-3-Clause
// Where the bundled data is, and how a name becomes a path.
#pragma once

#include <string>
#include <vector>

namespace petzval {

/// Version of the library, "major.minor.patch".
const char* version();

/// The folder with glass/, lenses/, spectra/, sensors/, scenes/: $PETZVAL_DATA if set, else share/petzval
/// beside the running program, else where the library was installed to, else the source tree that it was
/// built from. \throws InputError if none of them exists.
std::string data_directory();

/// A file given by the user: a path that exists is taken as it is; a bare name (no '/') means
/// `<data>/<kind>/<name><extension>`. \param what  for the message: "lens", "sensor".
/// \throws InputError naming the nearest bundled names.
std::string find_data_file(const std::string& kind, const std::string& extension,
                           const std::string& path_or_name, const std::string& what);

/// Names (without extension) of the bundled files of a kind, sorted.
std::vector<std::string> bundled_names(const std::string& kind, const std::string& extension);

/// Up to `count` of `candidates` nearest to `name` by edit distance without regard to case, nearest first.
std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& candidates,
                                       std::size_t count = 3);

}  // namespace petzval
