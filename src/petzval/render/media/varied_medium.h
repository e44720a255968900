// SPDX-License-Identifier: BSD-3-Clause
// Bodies whose medium depends on where light enters them.
#pragma once

#include <petzval/render/media/medium.h>
#include <petzval/render/textures/texture.h>

#include <array>
#include <memory>
#include <vector>

namespace petzval::render {

/// diffuse_albedo() of an index, by tables: as scattering_albedo(), to 1e-4.
class AlbedoTable {
 public:
  explicit AlbedoTable(double eta);
  double scattering_albedo(double reflectance, double g) const;

 private:
  std::vector<double> reflectances_;  ///< rising, at even steps of √(1 − albedo) from 1 to 0
};

/// Below the surface of a material "subsurface" with textures. All of a walk has the medium that the place
/// has where it enters (Chiang, Kutz and Burley, ACM SIGGRAPH Talks 2016), as pbrt-v4 has it.
struct VariedMedium {
  SpectrumTexture absorption, scattering;  ///< coefficients; or both null:
  SpectrumTexture reflectance, mfp;
  BandSpectrum coefficients[2];  ///< absorption and scattering, if none of the four is there
  FloatTexture scale, g;
  /// Of the boundary, by group and lane; empty where coefficients are given.
  std::vector<std::array<std::shared_ptr<const AlbedoTable>, lane_count>> albedos;

  Medium at(const TexturePoint& point, int group) const;
};

}  // namespace petzval::render
