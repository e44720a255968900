// SPDX-License-Identifier: BSD-3-Clause
// Glasses by name: the bundled catalogue, and the user's own before it.
#pragma once

#include <petzval/glass/material.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace petzval {

/// All glasses of one packed catalogue file, and any that were put before them. Opening one maps names; a
/// glass is decoded when it is asked for. Copies are cheap.
class GlassCatalogue {
 public:
  /// \throws InputError if the file is missing or damaged.
  static GlassCatalogue open(const std::string& path);
  /// `<data>/glass/catalogue.pgc`, opened once per process and shared.
  static const GlassCatalogue& bundled();

  /// These glasses alone. \throws InputError for a name that cannot be one.
  static GlassCatalogue of(std::vector<Glass> glasses);
  /// The same catalogue with glasses that are found before its own; of two with one full name the first
  /// counts. \throws InputError for a name that cannot be one.
  GlassCatalogue with(std::vector<Glass> own) const;

  std::size_t size() const;
  /// "CATALOGUE:NAME" of every glass, sorted.
  std::vector<std::string> full_names() const;
  /// "CDGM", "HIKARI", … of every glass, sorted.
  std::vector<std::string> catalogues() const;

  /// Finds "CATALOGUE:NAME" or a bare "NAME" (searched in `preferred` catalogues first, then in all, each
  /// time among the glasses of with() before the others; a bare name that several catalogues hold with
  /// different coefficients and no preference decides is an error that lists them). Case does not matter,
  /// nothing else is forgiven. \throws InputError for an unknown glass, naming the nearest known ones.
  std::shared_ptr<const Glass> find(const std::string& name,
                                    const std::vector<std::string>& preferred = {}) const;
  bool contains(const std::string& full_name) const;
  /// Full names of the glasses whose bare name has these letters and digits, whatever stands between them:
  /// "NBK7" finds "SCHOTT:N-BK7". Sorted; none if there are none.
  std::vector<std::string> names_spelled(const std::string& letters_and_digits) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;  ///< never changed once it is here
};

/// The material of a lens made of this glass, "SCHOTT:N-BK7" or "N-BK7". \throws InputError as find().
///
///     const Material crown = glass_material("SCHOTT:N-BK7");
///     std::cout << crown.description() << ": " << crown.index(587.5618) << '\n';
Material glass_material(const std::string& name, const GlassCatalogue& glasses = GlassCatalogue::bundled());

}  // namespace petzval
