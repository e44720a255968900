// SPDX-License-Identifier: BSD-3-Clause
// The bundled glass catalogue.
#pragma once

#include <petzval/glass/material.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace petzval {

/// All glasses of one packed catalogue file. Opening one maps names; a glass is decoded when it is asked for.
class GlassCatalogue {
 public:
  /// \throws InputError if the file is missing or damaged.
  static GlassCatalogue open(const std::string& path);
  /// `<data>/glass/catalogue.pgc`, opened once per process and shared.
  static const GlassCatalogue& bundled();

  std::size_t size() const;
  /// "CATALOGUE:NAME" of every glass, sorted.
  std::vector<std::string> full_names() const;
  /// "CDGM", "HIKARI", … of every glass, sorted.
  std::vector<std::string> catalogues() const;

  /// Finds "CATALOGUE:NAME" or a bare "NAME" (searched in `preferred` catalogues first, then in all; a bare
  /// name that several catalogues hold with different coefficients and no preference decides is an error that
  /// lists them). Case does not matter, nothing else is forgiven. \throws InputError for an unknown glass,
  /// naming the nearest known ones.
  std::shared_ptr<const Glass> find(const std::string& name,
                                    const std::vector<std::string>& preferred = {}) const;
  bool contains(const std::string& full_name) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace petzval
