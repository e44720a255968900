// SPDX-License-Identifier: BSD-3-Clause
// Tables of spectra in files.
#pragma once

#include <petzval/colour/spectrum.h>

#include <string>
#include <string_view>
#include <vector>

namespace petzval {

struct NamedSpectrum {
  std::string name;
  Spectrum spectrum;
};

/// The spectra of one file: all on the same wavelengths and in the same unit.
struct SpectrumSet {
  std::string name, source, unit;
  std::vector<NamedSpectrum> spectra;  ///< at least one, in the order of the file's columns

  /// \throws InputError for a name that is not there, listing those that are.
  const Spectrum& find(const std::string& spectrum_name) const;
};

/// Reads a CSV file of spectra: optional `# name: …`, `# source: …`, `# unit: …` and other comment lines, one
/// line of column names that starts with `wavelength_nm`, then one line a wavelength, increasing.
///
///     const SpectrumSet chart = read_spectrum_set("colorchecker_reflectance");
///     const Spectrum& dark_skin = chart.find("dark skin");
///
/// \param path_or_name  a path, or the name of a bundled set (data/spectra).
/// \throws InputError with file and line.
SpectrumSet read_spectrum_set(const std::string& path_or_name);

/// As read_spectrum_set, from text. \param file  for the messages.
SpectrumSet parse_spectrum_set(std::string_view text, const std::string& file);

}  // namespace petzval
