// SPDX-License-Identifier: BSD-3-Clause
// The diffraction PSF of a lens at a field point.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/wave/angle_characteristic.h>
#include <petzval/wave/chord_sum.h>

#include <optional>

namespace petzval {

/// Grid and quadrature of one PSF.
struct PsfPlan {
  int size = 0;              ///< cells a side
  double spacing_um = 0;     ///< of the cells
  int samples_per_cell = 1;  ///< a side; 1 at or below λN/2, where samples say everything
  int first_row = 0, last_row = -1,
      reach = -1;                      ///< as in PsfGrid: a chosen window is dark where no ray is near
  int radial_nodes = 0, azimuths = 0;  ///< of pupil_waves(), to rounding in the whole window

  PsfGrid grid() const { return {size, spacing_um, samples_per_cell, first_row, last_row, reach}; }
};

/// How closely light must be known that is then added up over the cells of an image.
struct CoarseLight {
  double cell_um = 0;    ///< 0: as closely as can be
  double tolerance = 0;  ///< relative L2 error of the image

  bool any() const { return cell_um > 0; }
  /// From a tolerance of 10⁻² on. Below it only samples in blurred windows are farther apart.
  bool loose() const { return any() && tolerance >= 1e-2; }
  /// Cells of a chosen window need be no narrower: light that is gathered so adds a twelfth of their square
  /// to a variance, √tolerance/6 of a cell's.
  double spacing_um() const;
  /// Whether rays say enough where a PSF is wide: what waves carry a cell or more beyond their edges is
  /// 1 − E ≈ 2λN/(π² r) of the light, less than the tolerance.
  bool rays_serve(double lambda_n_um) const;
};

/// What the caller fixes; zeros are chosen. The window holds the ray spot and twelve λN around it, or more
/// until `wanted_share` of the light is inside. The spacing is 0.45 λN, or wider when `largest_size` (or
/// `size`) cells of that do not span the window: then each value is the light of its cell.
struct PsfOptions {
  int size = 0;
  double spacing_um = 0;
  int largest_size = 256;      ///< of a chosen size
  double wanted_share = 0.99;  ///< of the light, inside a chosen window
  double margin = 1;           ///< about the rays of a chosen window, over what it would be
  /// A chosen window is exactly as wide as it is to be, by a spacing that divides it, and so follows closely
  /// from place to place; else it is a multiple of eight cells.
  bool exact_window = false;
  double widest_wave_window_lambda_n = 500;
  /// Light of a smooth pupil in wider cells, sampled so that nothing is mistaken for detail that cells of the
  /// image can hold; or of rays.
  CoarseLight coarse = {};
  /// Nodes in any order are summed in windows up to this, whose square their number goes with: a million
  /// rays. Beyond it the rays of a pupil that is not smooth are counted.
  double widest_node_window_lambda_n = 256;
  int radial_nodes = 0, azimuths = 0;
  /// Of a spot of rays, where waves would take too long: as many as fill 256 × 256 cells by a dozen each.
  int spot_radial_nodes = 384;
};

/// \returns nothing when no ray of the field passes.
std::optional<PsfPlan> plan_psf(const FieldTracer& tracer, const ChiefRay& chief,
                                const PsfOptions& options = {});

/// The pupil of a field as plane waves at the sensor (docs/PSF.md, angle characteristic): real rays through
/// the vignetted pupil, β towards positive t, away from the axis.
std::optional<PupilWaves> pupil_waves(const FieldTracer& tracer, const ChiefRay& chief, int radial_nodes,
                                      int azimuths);

/// Plan, rays and sum in one: by chords of a smooth pupil (fit_pupil), or by traced nodes where the pupil is
/// not smooth or the stop has blades. Nothing when no ray passes.
std::optional<Psf> point_spread(const FieldTracer& tracer, const ChiefRay& chief,
                                const PsfOptions& options = {});

/// The same of a pupil that has been fitted already.
Psf point_spread(const SmoothPupil& pupil, const PsfOptions& options = {});

}  // namespace petzval
