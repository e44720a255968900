// SPDX-License-Identifier: BSD-3-Clause
// From what is measured on a photograph back to the lens: how a lens was built, by the sharpness of edges
// over the frame.
#pragma once

#include <petzval/base/context.h>
#include <petzval/lens/lens.h>
#include <petzval/measure/sfr/sfr_map.h>
#include <petzval/optimise/build_number.h>
#include <petzval/wave/photosite.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

struct FitBuildRequest {
  /// What may be off, as parse_build_numbers() has it; empty: defocus_mm and sensor_tilt_deg.
  std::vector<std::string> free = {};
  double pixel_pitch_um = 0;  ///< of the photographs, which are centred on the axis
  Photosite photosite = {};
  std::vector<double> wavelengths_nm = {};  ///< empty: the lens's own
  std::vector<double> weights = {};         ///< of the light of each; empty: all alike
  std::string channel = {};  ///< of the edges; empty: luminance, or green where there are colours
  /// One a photograph: where its sensor stood, away from the lens, against the lens's own image surface [mm].
  /// Empty: not known, and every photograph has a defocus of its own.
  std::vector<double> focus_shifts_mm = {};
};

/// One number that was found.
struct FittedNumber {
  BuildNumber number;
  double value = 0, deviation = 0;  ///< in the unit of the number
};

/// An edge and what the lens makes of it.
struct FittedEdge {
  int photograph = 0;
  double x_px = 0, y_px = 0, normal_deg = 0;  ///< as MapEdge
  double measured_cpp = 0;                    ///< MTF50
  double designed_cpp = 0, fitted_cpp = 0;    ///< of the lens as given, and as fitted; NaN above 1
};

/// Another lens that explains the photographs as well.
struct OtherBuild {
  std::vector<double> values;  ///< in the order of the numbers
  double chi_squared = 0;
};

struct FitBuildResult {
  Lens lens;  ///< as built: with poses, its sensor where the first photograph had it
  std::vector<FittedNumber> numbers;
  std::vector<double> correlation;  ///< of the numbers, row-major
  double chi_squared_before = 0, chi_squared = 0;
  int freedom = 0;       ///< degrees of freedom: data less numbers
  double scaled_by = 1;  ///< what the stated deviations were multiplied by: √(chi²/freedom), if above 1
  std::vector<FittedEdge> edges;
  std::vector<OtherBuild> others;    ///< far from the fit and as good
  std::vector<std::string> remarks;  ///< what the photographs cannot tell, a line each
};

///     FitBuildRequest request;
///     request.pixel_pitch_um = 3.45;
///     request.free = {"defocus_mm", "sensor_tilt_deg", "element_decentre_mm@2-3"};
///     const FitBuildResult found = fit_build(lens, read_sfr_maps("map.json"), request);
///     for (const FittedNumber& each : found.numbers)
///       std::cout << each.number.name() << ": " << each.value << " +- " << each.deviation << '\n';
///
/// The numbers that best explain the contrast of all edges at MTF80, MTF50 and MTF20 (or at MTF50 alone), by
/// Levenberg and Marquardt (Moré's MINPACK, as Eigen has it) from starts on both sides of focus and with
/// tilts of all signs. Contrast is that of edge_transfer() times the photosite's. Deviations are the stated
/// ones with their correlations, 0.003 of contrast for what ruler and model do not share at each edge, and
/// two errors of all edges together: 1 % of contrast, for light that is spread far, and blur of 6 % of the
/// variance of a square pixel. The covariance is the inverse of the normal matrix, scaled by chi² over the
/// degrees of freedom where that is above 1.
/// After the fit every number and all of them together are turned round and fitted again: what fits as well
/// within four of chi² is named, and so are numbers that only together are known. The same request gives the
/// same result on any number of threads.
/// \throws InputError for maps without edges, a frame beyond the lens's light, numbers that do not fit the
/// lens or of which the edges say nothing; Cancelled.
FitBuildResult fit_build(const Lens& lens, const std::vector<SfrMap>& photographs,
                         const FitBuildRequest& request, const Context& context = {});

}  // namespace petzval
