// SPDX-License-Identifier: BSD-3-Clause
// How far mixtures of kernels are from the kernels that they stand for.
#pragma once

#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/imaging/scene_look.h>
#include <petzval/sensor/sensor.h>

#include <array>
#include <limits>
#include <memory>

namespace petzval {

/// The cells from which light comes, and by how many they reach beyond the picture on every side: of an error
/// that lands beside the picture nothing is seen.
struct SourceGrid {
  SensorGeometry cells;
  int margin = 0;
  const SceneLook* look = nullptr;  ///< how bright cells are; null: all alike
  CellRing zone = whole_frame;      ///< those whose error counts

  SourceGrid(const SensorGeometry& all, int beyond = 0, const SceneLook* brightness = nullptr)
      : cells(all), margin(beyond), look(brightness) {}
};

/// The relative L2 error that a product convolution makes of noise with a standard deviation as large as its
/// mean: √(Σd²/(1 + Σh²)), RMS over places of the grid, h the kernel of PsfField and d what the mixture of
/// kernels differs from it. A place counts by the square of how bright the lens makes it: where no light
/// falls, kernels do not matter.
struct KernelError {
  static constexpr int places = 64, first_places = 8;
  double rms = 0;                                    ///< over all places looked at
  std::array<double, first_places> first_squares{};  ///< at the first few of them
};

/// \param limit  no more is added up once the error is sure to be above it: then what is returned is above
/// it, but not the error.
KernelError kernel_error(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes,
                         double limit = std::numeric_limits<double>::infinity());

/// The same for PSFs that differ little from others of which it is known: places are alike, so a few tell by
/// how much all have changed. \param few  at how many it is looked, 1 to first_places.
KernelError kernel_error_like(const KernelError& known, const PsfField& psfs, const SourceGrid& grid,
                              int tile, int nodes, int few = KernelError::first_places);

/// What kernel_error() misses: just inside the last height of a table, where a pupil may close within a few
/// cells, mixtures may be off by far more than elsewhere.
struct RimError {
  CellRing ring;           ///< that must be left out for the error of the rest to stay within the limit
  double mean_square = 0;  ///< of the error of the rim without the ring, as a part of the whole grid's
  double outermost = 0;    ///< mean square error in its outermost thousandth
  bool within = true;      ///< false: even without the largest ring that is looked at it is beyond the limit
};

/// The errors of many layouts, one after the other: true kernels are made once, and a layout is looked at
/// first where the one before was at its worst. What it is given must outlive it.
class LayoutErrors {
 public:
  LayoutErrors(const PsfField& psfs, const SourceGrid& grid);
  ~LayoutErrors();
  /// kernel_error()
  KernelError at_places(int tile, int nodes, double limit);
  /// kernel_error_like()
  KernelError at_places_like(const KernelError& known, int tile, int nodes, int few);
  /// \param limit  for the RMS error of the rim, as a part of the whole grid's.
  RimError at_rim(int tile, int nodes, double limit);
  /// Whether a layout may do with a smaller ring than the one that at_rim() found for another, of which a few
  /// kernels tell most.
  bool does_with_less(int tile, int nodes, double limit, const CellRing& ring);
  /// The same for PSFs that differ little from others of which it is known: unless that found a ring, the
  /// outermost cells tell by how much all have changed.
  RimError at_rim_like(const RimError& known, int tile, int nodes, double limit);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace petzval
