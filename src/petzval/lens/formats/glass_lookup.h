// SPDX-License-Identifier: BSD-3-Clause
// From the glass name in a lens file to a material.
#pragma once

#include <petzval/glass/catalogue.h>
#include <petzval/lens/lens_file.h>

#include <set>
#include <string>
#include <vector>

namespace petzval {

/// Finds the glasses of one file, after the user's substitutions, and remembers which were asked for.
class GlassLookup {
 public:
  explicit GlassLookup(const LensReadOptions& options) : options_(options) {}

  /// Whether the user asked for another glass in place of this one; case does not matter.
  bool is_substituted(const std::string& name) const;
  /// The material that a file calls `name`.
  /// \param preferred  catalogues to search first, in this order.
  /// \throws InputError naming the nearest known glasses and the way to substitute one.
  Material find(const std::string& name, const std::vector<std::string>& preferred = {});
  /// The same for a name that may leave out all but letters and digits, "NBK7" for "N-BK7", as CODE V does.
  /// \param catalogue  that it is of; "": any.
  Material find_squeezed(const std::string& name, const std::string& catalogue);

  /// \throws InputError if a substitution is for a glass that the file does not have, naming those it has.
  void require_all_used() const;

 private:
  const GlassCatalogue& catalogue() const;
  Material of_catalogue(const std::string& name, const std::vector<std::string>& preferred) const;

  const LensReadOptions& options_;
  std::set<std::string> asked_;
};

}  // namespace petzval
