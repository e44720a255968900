// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing lenses, whatever the format.
#pragma once

#include <petzval/glass/catalogue.h>
#include <petzval/lens/lens.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace petzval {

struct LensReadOptions {
  /// Explicit glass substitutions, "LAK10C" → "CDGM:H-LAK10", or "SK1" → "1.61025/56.71", nd and Vd of a
  /// glass that no catalogue has. Nothing is substituted without one.
  std::map<std::string, std::string> substitutions = {};
  /// If given: gains the substitutions of glasses that the lens has; one that it has not is then no error. So
  /// several lenses can be read with the same.
  std::shared_ptr<std::set<std::string>> substituted = {};
  /// Where glasses are looked for; absent: the bundled catalogue alone.
  std::optional<GlassCatalogue> glasses = {};
};

/// A lens and what its reader has to say of it (apertures that are missing, an image distance that was
/// solved…), one line each, for stderr.
struct LensFile {
  Lens lens = {};
  std::vector<std::string> notes = {};
};

/// Reads a lens.
///
///     Lens lens = read_lens("dgauss-50mm").lens;
///     lens = with_setting(lens, "surfaces[4].thickness_mm=2.1");
///     write_lens(lens, "altered.zmx");
///
/// By path or bundled name; the format is told by extension (.json native or ISET, .dat, .zmx,
/// .seq, .txt of the Optical Bench, .lens, .csv and .tsv for tables) and content. The lens is valid. \throws
/// InputError with file and line, for anything that is wrong or not modelled, and for a substitution of a
/// glass that the file does not have.
LensFile read_lens(const std::string& path_or_name, const LensReadOptions& options = {});

/// Writes by extension (.json native, .iset.json, .dat, .zmx, .seq), whole or not at all. What a format
/// leaves out without altering a ray (fields and wavelengths in tables of rows) is returned, one line each.
/// \throws InputError if the format cannot hold the lens, naming the surface.
std::vector<std::string> write_lens(const Lens& lens, const std::string& path);

/// The lens as native JSON text, and back; every double survives.
std::string lens_to_json(const Lens& lens);
/// \param file  for error messages.
Lens lens_from_json(const std::string& text, const std::string& file, const LensReadOptions& options = {});

/// Applies "surfaces[4].thickness_mm=0.5": a path into the native JSON form, and a JSON value (a bare word is
/// taken as a string). \param options  where glasses are looked for; substitutions are not used.
/// \throws InputError if the path names nothing in the format or the result is not a lens.
Lens with_setting(const Lens& lens, const std::string& assignment, const LensReadOptions& options = {});

}  // namespace petzval
