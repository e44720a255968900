// SPDX-License-Identifier: BSD-3-Clause
// Spatial frequency response of one slanted edge.
#pragma once

#include <petzval/measure/sfr/edge_line.h>
#include <petzval/measure/sfr/edge_samples.h>
#include <petzval/measure/sfr/level_contours.h>
#include <petzval/measure/sfr/rounded_blocks.h>

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

struct SfrOptions {
  /// 1 (a straight line) to 5; 0: straight, unless the samples show a bend, which then gets order 2 or 3.
  int edge_order = 0;
  /// Light that varies linearly on both sides is told from the edge, if the samples show that it does.
  bool varying_light = true;
  std::vector<double> frequencies_cpp;  ///< empty: 0, 0.01, … 1
  /// Contrast that the PSF's far tail takes away or adds where the target is not a half-plane: at (x, y), the
  /// sum of ∬ r⁻³ dA [1/pixel] over what is bright beyond the half-plane minus what is missing from it.
  /// Empty: the target is a half-plane.
  std::function<double(double x, double y)> missing_target;
  /// Where the target has corners at the ends of the edge, as far as it is known [pixels].
  std::vector<ContourPoint> corners;
  /// Of a JPEG: how it was recorded. Outlives the options; null: as single pixels.
  const RoundedBlocks* blocks = nullptr;
  /// Pixel values from which on the sensor clips, or up to which it does: such pixels spoil an edge.
  std::optional<double> clip_low, clip_high;
  /// The light of each code value, rising, where values have been rounded to them; empty: they have not. They
  /// outlive the options.
  std::span<const double> code_levels;
  /// At how many places an edge has been looked for: unless the samples show it against odds of one to so
  /// many, and not light that changes smoothly, it is refused; 0: it is known to be here.
  double places = 0;
  /// Edges that are plainly bent to a smaller radius are refused; 0: none are.
  double least_radius_px = 0;
  /// Where the edge is known to run already; its direction points from dark to bright.
  std::optional<EdgeLine> start;
};

/// Contrast at which SFR falls below a level for the first time.
struct MtfLevel {
  double level = 0.5;
  double frequency_cpp = 0;  ///< NaN if the table ends before
  double deviation_cpp = 0;  ///< standard deviation from noise, rounding and what the model cannot follow
};

/// What the deviations of an edge are made of: at each frequency of its SFR, then at each level that it
/// passes.
struct DeviationParts {
  std::vector<double> of_samples;  ///< noise, rounding and what is not known of the tail
  /// Squares of what corners, and the choice of splines, change of the contrast: of how much the profile of a
  /// part of the samples differs, less what noise makes of that on average. And their variance by noise.
  std::vector<double> model_square, square_variance;
  std::vector<double>
      level_run;       ///< by how much a level's frequency changes with the contrast [cycles/pixel]
  double corners = 0;  ///< in proportion to what corners add to the profile; 0: none are known
  bool without_noise = false;
};

struct EdgeMeasurement {
  EdgeLine line;
  double dark = 0, bright = 0;              ///< levels far away, the tail extrapolated
  double noise_dark = 0, noise_bright = 0;  ///< standard deviations of the values about the profile
  double tail_px = 0;    ///< what the profile misses of a level at a distance d is tail/d of the step
  double middle_px = 0;  ///< where the profile passes one half, from `line`
  double rise_px = 0;    ///< 10 % to 90 %
  double overshoot = 0, undershoot = 0;  ///< beyond bright and dark, over the step
  std::vector<double> frequencies_cpp, sfr;
  std::vector<double> phase_rad;
  std::vector<double> sfr_deviation;  ///< the same of sfr
  std::vector<MtfLevel> mtf;          ///< at 0.9, 0.8, … 0.1
  /// How the deviations of sfr at MTF80, MTF50 and MTF20 hang together: correlations of the first and second,
  /// first and third, second and third; 0 where a level is not reached.
  std::array<double, 3> level_correlations{};
  DeviationParts parts;                       ///< of the deviations
  std::vector<double> distance_px, esf, lsf;  ///< profile and its slope [1/pixel], both over the step
  /// What the light of either side changes by over the samples, over the step; 0 if it is even.
  double light_variation = 0;
  std::size_t samples = 0;
  std::vector<std::string> notes;

  const MtfLevel& mtf50() const { return mtf[4]; }
};

/// Measures one edge: guess → edge line and profile fitted in turn until the line rests (EdgeSpreadModel
/// holds how the profile is fitted and transformed). Nothing is tapered or binned. A bend and light that
/// varies are taken up where they stand out from the noise five times over and are large enough to matter.
/// \param lattice_step  spacing of the samples [pixels]. \throws InputError when there is no edge, its
/// samples are clipped, or it is too short to be measured.
EdgeMeasurement measure_edge(const std::vector<EdgeSample>& samples, double lattice_step,
                             const SfrOptions& options);

}  // namespace petzval
