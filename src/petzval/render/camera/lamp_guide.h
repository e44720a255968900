// SPDX-License-Identifier: BSD-3-Clause
// Directions through a lens towards what is small and bright.
#pragma once

#include <petzval/render/vector3.h>
#include <petzval/sensor/sensor.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace petzval::render {

/// A ball that holds a light of some size, in camera space [scene units], and how bright it is, on any scale.
struct Lamp {
  Vector3 centre;
  double radius = 0, radiance = 0;
};

/// From camera space to that of the lens.
struct LensPlace {
  double scene_units_per_mm = 1e-3, origin_z_mm = 0;
};

/// How light of one lamp reaches the film: a disk on the film, and for each point of it an ellipse of
/// directions (α, β), {middle + [a b; c d] · unit disk}, whose numbers are cubic polynomials of the place.
class LampDisk {
 public:
  /// From rays of the lamp's middle and of its rim, traced to the film; nothing for a lamp that no light of
  /// reaches the film, or that is so sharp that its ellipses are as large as the pupil. \param tracers  of
  /// the middle of the spectrum and of its ends.
  static std::optional<LampDisk> find(const Lamp& lamp, std::span<const Tracer> tracers,
                                      const LensPlace& place);

  double x_mm() const { return x_mm_; }
  double y_mm() const { return y_mm_; }
  /// Beyond this none of its light is found.
  double radius_mm() const { return reach_mm_; }
  double area_sr() const;
  bool reaches(double x_mm, double y_mm) const;
  /// The direction at a place of the unit disk.
  std::array<double, 2> direction(double x_mm, double y_mm, double s, double t) const;
  /// 1/area inside of the ellipse, 0 outside.
  double density_per_sr(double x_mm, double y_mm, double alpha, double beta) const;

 private:
  using Terms = std::array<double, 10>;
  struct Ellipse {
    double alpha, beta, a, b, c, d;

    double determinant() const { return a * d - b * c; }
    /// A direction as a place of the unit disk.
    std::array<double, 2> within(double towards_alpha, double towards_beta) const;
  };
  class Fit;
  Terms terms(double x_mm, double y_mm) const;
  Ellipse ellipse(double x_mm, double y_mm) const;

  double x_mm_ = 0, y_mm_ = 0, radius_mm_ = 0;  ///< on the film, of the light of the lamp's middle
  double reach_mm_ = 0;                         ///< of all of its light
  std::array<Terms, 6> numbers_{};              ///< of Ellipse, in its order
};

/// A small lamp out of focus fills a disk on the film, but from each point of the film it is seen through a
/// small part of the pupil alone: of directions drawn evenly over the pupil few meet it, and its disk is
/// speckled. Where disks reach, half of the directions are drawn from their ellipses, and half from the
/// pupil. A direction's density is that of both together, so that the mean of a picture is the same whatever
/// the ellipses are (defensive mixtures: T. Hesterberg, Technometrics 37, 1995).
class LampGuide {
 public:
  struct Direction {
    double alpha = 0, beta = 0;
  };

  /// No lamps: no ellipse anywhere.
  LampGuide() = default;
  /// \param margin_mm  around the film from where light may be asked for.
  LampGuide(std::span<const Lamp> lamps, std::span<const Tracer> tracers, const LensPlace& place,
            const SensorGeometry& film, double margin_mm, const ExitPupilRegions& pupil);

  /// Whether any disk reaches this film point.
  bool concerns(double x_mm, double y_mm) const;
  /// A direction for two numbers in [0, 1) from the ellipses of a film point that is concerned.
  Direction sample(double x_mm, double y_mm, double u, double v) const;
  /// The density of sample() [1/sr].
  double density_per_sr(double x_mm, double y_mm, double alpha, double beta) const;

  /// Of directions at film points that are concerned, this share is drawn from the ellipses.
  static constexpr double share = 0.5;

 private:
  struct Seen {
    LampDisk disk;
    double weight;  ///< how often it is chosen, beside others
  };
  const std::vector<std::uint32_t>& near(double x_mm, double y_mm) const;
  double weight_at(double x_mm, double y_mm) const;

  double left_mm_ = 0, top_mm_ = 0, cell_mm_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<Seen> seen_;
  std::vector<std::vector<std::uint32_t>> cells_;  ///< which disks meet each
};

}  // namespace petzval::render
