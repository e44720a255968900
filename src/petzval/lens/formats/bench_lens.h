// SPDX-License-Identifier: BSD-3-Clause
// What prescriptions from patents have in common, whatever file they stand in: nd and Vd in place of glasses,
// and an image distance that may be missing.
#pragma once

#include <petzval/lens/lens_file.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What a file says beside its surfaces.
struct BenchFacts {
  std::optional<double> f_number = {};
  std::optional<double> full_angle_deg = {};   ///< of view
  std::optional<double> image_circle_mm = {};  ///< diameter
  bool unfocused = false;                      ///< it gives no image distance
};

/// A glass by nd and Vd; by nd alone where Vd is not given (0), which is remembered.
Material bench_material(double nd, double vd, std::size_t surface, std::vector<std::size_t>& no_dispersion);

/// Gives a lens of surfaces its aperture, fields, wavelengths (F, d, C) and, where needed, the image surface
/// in the paraxial focus, with notes of what was not said. \throws InputError if that is no lens.
void complete_bench_lens(LensFile& made, const BenchFacts& facts,
                         const std::vector<std::size_t>& no_dispersion, const std::string& file);

}  // namespace petzval
