// SPDX-License-Identifier: BSD-3-Clause
// Where the bundled data is, and how a name becomes a path.
#pragma once

#include <string>
#include <vector>

namespace petzval {

/// The folder with glass/, lenses/, spectra/, sensors/, scenes/: the one that was set, else $PETZVAL_DATA,
/// else the default. \throws InputError if there is none.
std::string data_directory();

/// Sets it for this process, before anything bundled is read: what has been read is kept. \throws InputError
/// for a folder without glass/.
void set_data_directory(const std::string& path);

/// Sets the one that counts where nobody says otherwise. A program that links the installed package has it
/// set to the package's own data. Not checked here.
void set_default_data_directory(const std::string& path);
/// As it was set, or nothing.
std::string default_data_directory();

/// A file given by the user: a path that exists is taken as it is; a bare name (no '/') means
/// `<data>/<kind>/<name><extension>`, or that in a folder below it. \param what  for the message: "lens",
/// "sensor". \throws InputError naming the nearest bundled names.
std::string find_data_file(const std::string& kind, const std::string& extension,
                           const std::string& path_or_name, const std::string& what);

/// The kind and the folders below it, "lenses" and "lenses/patents", sorted: kinds themselves.
std::vector<std::string> bundled_folders(const std::string& kind);

/// Names (without extension) of the bundled files of a kind, sorted; those in folders below it not among
/// them.
std::vector<std::string> bundled_names(const std::string& kind, const std::string& extension);

/// Those too: first the kind's own, then folder by folder.
std::vector<std::string> all_bundled_names(const std::string& kind, const std::string& extension);

/// Up to `count` of `candidates` nearest to `name`, nearest first: by edit distance without regard to case,
/// or because `name` is a part of them or their beginning.
std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& candidates,
                                       std::size_t count = 3);

}  // namespace petzval
