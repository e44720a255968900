// SPDX-License-Identifier: BSD-3-Clause
// Light from all around, far away.
#pragma once

#include <petzval/render/lights/light_tree.h>
#include <petzval/render/lights/portal.h>
#include <petzval/render/spectra/wavelength_groups.h>
#include <petzval/render/textures/picture_file.h>
#include <petzval/render/transform.h>

#include <array>
#include <memory>
#include <vector>

namespace petzval::render {

/// A density over the unit square, constant in each of width × height cells.
class SquareDistribution {
 public:
  /// \param weights  row by row, none negative; all zero counts as even.
  SquareDistribution(std::vector<double> weights, int width, int height);
  struct Point {
    double u = 0, v = 0, density = 0;
  };
  Point sample(double u, double v) const;
  double density(double u, double v) const;

 private:
  int width_, height_;
  std::vector<double> rows_, cells_;  ///< cumulative: of rows, and of each row's cells
};

/// The directions of a sphere from the unit square and back, areas kept (Clarberg 2008, as pbrt-v4 lays out
/// its sky pictures).
Vector3 sphere_from_square(double u, double v);
void square_from_sphere(Vector3 direction, double& u, double& v);

/// An infinite light: the same from everywhere, or a square picture in the equal-area octahedral layout.
class Environment {
 public:
  /// \param radiance  [group].
  Environment(BandSpectrum radiance, Transform world_from_light);
  /// Each pixel's colour as light of `white` (the spectrum of rgb 1, scaled).
  Environment(const std::shared_ptr<const PictureFile>& picture, BandSpectrum white,
              const WavelengthGroups& groups, Transform world_from_light);

  /// From now on it is seen only through this opening, which stands in the world.
  void put_behind(Portal portal);

  /// At a place, from a unit direction (world space, towards the light).
  Lanes radiance(const Vector3& from, const Vector3& direction, int group) const {
    if (portal_ && !portal_->lets_out(from, direction)) return Lanes::all(0);
    return radiance(direction, group);
  }
  struct Sample {
    Vector3 direction;
    double pdf = 0;  ///< over solid angle
  };
  /// A picture by its luminance, mostly by what of it exceeds the mean; an even light over the cosine of a
  /// surface, which is how it arrives there, or evenly at a point that has none; through a portal by what can
  /// be seen of it there.
  Sample sample(const LightReceiver& to, double u, double v) const;
  double pdf(const LightReceiver& to, Vector3 direction) const;
  /// Nearly what a point can get of it that asking for it finds sooner than chance does.
  double importance(const LightReceiver& to) const;

 private:
  Lanes radiance(const Vector3& direction, int group) const;
  /// A mean over wavelengths.
  double luminance(Vector3 direction) const;
  /// Nearly what a plane gets of it in the open, of all wavelengths, from its spherical harmonics of order 2
  /// (Ramamoorthi & Hanrahan 2001); at least a twentieth of what it would get if the light were even.
  double irradiance(Vector3 normal) const;
  /// What a point gets of it in the open, of all wavelengths: ∫ radiance over the sphere.
  double fluence() const;
  /// 0 for light that is the same from everywhere, near 1 for light that comes from few directions: 1 −
  /// mean² / mean square of the radiance.
  double unevenness() const { return unevenness_; }

  struct Sky;
  BandSpectrum radiance_;
  Transform world_from_light_;
  std::shared_ptr<const Sky> sky_;
  std::shared_ptr<const Portal> portal_;  ///< null: seen from everywhere
  double mean_ = 0, unevenness_ = 0;
  std::array<double, 9> irradiance_{};  ///< coefficients over the directions of the light's own space
};

}  // namespace petzval::render
