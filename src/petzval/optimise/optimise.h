// SPDX-License-Identifier: BSD-3-Clause
// Better lenses: numbers of a prescription altered until its rays meet more closely.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/base/context.h>
#include <petzval/optimise/lens_variable.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What is made small.
enum class OptimiseMerit {
  rms_spot,   ///< RMS radius of the spots [µm], all wavelengths of a field about one centre
  wavefront,  ///< RMS of the wavefront [nm], of every wavelength about one point of the image
  mtf  ///< RMS over both directions of what the MTF of all wavelengths together lacks of 1 [%], by rays
};

struct OptimiseRequest {
  std::vector<LensVariable> variables = {};  ///< none: all radii, and the distance to the sensor
  FieldTableRequest at = {};                 ///< fields and wavelengths; empty: the lens's own
  /// Of the fields, anticlockwise from +y as seen from the film; empty: 0, 90, 180 and 270 for lenses that
  /// are not round or have poses among their variables, else the one of `at`.
  std::vector<double> azimuths_deg = {};
  std::vector<double> field_weights = {};  ///< one a field; empty: all alike
  OptimiseMerit merit = OptimiseMerit::rms_spot;
  double mtf_frequency_cpmm = 0;  ///< of the MTF
  /// Of every field at the reference wavelength, about the paraxial height; absent: it does not count.
  std::optional<double> most_distortion_percent = {};
  std::optional<double> efl_mm = {};  ///< at the reference wavelength; absent: what the lens has
  double least_rim_mm = 0.5;          ///< of glass at the clear aperture; what is thinner already may stay so
  int rounds = 30;                    ///< at most; in each the rays are chosen anew from the real pupils
  int starts = 1;                     ///< the lens itself, and this number less one that begin beside it
  double start_spread = 0.05;         ///< how far beside: standard deviation, as a share of every number
  int glasses = 0;  ///< so many of the nearest of its maker are tried in each glass's place (nearest_glasses)
};

/// One variable before and after.
struct OptimisedNumber {
  LensNumber number;
  double before = 0, after = 0;  ///< as people give it: the radius of a curvature
};

/// A glass that another has replaced, "SCHOTT:N-SF2".
struct ChosenGlass {
  std::size_t surface = 0;  ///< that it follows
  std::string before, after;
};

struct OptimiseResult {
  Lens lens;                                        ///< as altered, its name saying so
  double before = 0, after = 0;                     ///< the merit: root mean square over the weighted fields
  std::vector<double> fields_before, fields_after;  ///< of every field
  double efl_before_mm = 0, efl_after_mm = 0;
  std::vector<OptimisedNumber> numbers;
  std::vector<ChosenGlass> glasses;  ///< that were replaced, in the order of surfaces
  std::vector<double> by_round;      ///< the merit, from the start of the winner on
  int start = 0;                     ///< which start won; 0: the lens itself
};

/// Least squares by Levenberg and Marquardt (Moré's MINPACK, as Eigen has it) over transverse aberrations or
/// path differences of rays through the real pupils, with exact derivatives (DerivedTracer); beside them the
/// focal length, the thickness of glass at the rim and distortion. An MTF is sought from the lens as it is
/// and from that of the least spots, for where it is lost already it has no slope. Glasses are chosen after
/// that: each near one is put in the place of each, the numbers follow, the best such change is kept, until
/// none is better. A lens that no step improves comes back as it was. The same request and seed give the same
/// lens on any number of threads. \throws InputError for variables, weights or numbers that do not fit, a
/// lens with gratings, ideal lenses or ray transfers, a field at which no ray passes; Cancelled.
OptimiseResult optimise(const Lens& lens, const OptimiseRequest& request = {}, const Context& context = {});

}  // namespace petzval
