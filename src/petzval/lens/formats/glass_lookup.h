// SPDX-License-Identifier: BSD-3-Clause
// From the glass name in a lens file to a material.
#pragma once

#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/lens_file.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// Finds the glasses of one file, after the user's substitutions, and remembers which were asked for.
class GlassLookup {
 public:
  explicit GlassLookup(const LensReadOptions& options) : options_(options) {}
  /// The same for files of other programs: a glass that is made no more is taken from its successor, one of
  /// another maker than the file names where no other has it; each time a note says so.
  GlassLookup(const LensReadOptions& options, std::string file, std::vector<std::string>& notes)
      : options_(options), file_(std::move(file)), notes_(&notes) {}

  /// Whether the user asked for another glass in place of this one; case does not matter.
  bool is_substituted(const std::string& name) const;
  /// The material that a file calls `name`.
  /// \param preferred  catalogues to search first, in this order.
  /// \throws InputError naming the nearest known glasses and the way to substitute one.
  Material find(const std::string& name, const std::vector<std::string>& preferred = {});
  /// The same for a name that may leave out all but letters and digits, "NBK7" for "N-BK7", as CODE V does.
  /// \param catalogue  that it is of; "": any.
  Material find_squeezed(const std::string& name, const std::string& catalogue);

  /// Remembers a glass that is not to be found, so that all of them can be named at once, and stands in for
  /// it until then. \param located  the complaint, with its place. \param where  "SURF 3".
  Material missing(const InputError& located, const std::string& name, const std::string& where);
  /// \throws InputError naming all glasses that are missing.
  void require_all_found() const;

  /// \throws InputError if a substitution is for a glass that the file does not have, naming those it has.
  void require_all_used() const;

 private:
  const GlassCatalogue& catalogue() const;
  Material of_other_program(const std::string& name, const std::vector<std::string>& preferred);
  Material of_catalogue(const std::string& name, const std::vector<std::string>& preferred) const;

  /// Nothing where the name is none of a retired glass, or no successors are to be taken.
  std::optional<Material> successor(const std::string& name, const std::vector<std::string>& preferred);
  void note(const std::string& text);

  struct Missing {
    InputError error;
    std::string name, where;
  };
  const LensReadOptions& options_;
  std::string file_;
  std::vector<std::string>* notes_ = nullptr;
  std::set<std::string> asked_, noted_;
  std::vector<Missing> missing_;
};

}  // namespace petzval
