// SPDX-License-Identifier: BSD-3-Clause
// From places on the film to rays in the scene.
#pragma once

#include <petzval/render/camera/wave_image.h>
#include <petzval/render/film/film_sampling.h>
#include <petzval/render/spectra/lanes.h>
#include <petzval/render/vector3.h>

#include <array>
#include <span>

namespace petzval::render {

/// A ray of light that reaches the film, followed backwards out into the scene.
struct CameraRay {
  bool passes = false;
  Vector3 origin, direction;  ///< camera space: looking along +z, x to the right, y up; scene units
  /// What radiance along the ray adds to irradiance, lane by lane [sr]: 1/density in film phase space.
  Lanes weight = Lanes::all(0);
  /// The same for the hero wavelength when it alone takes the path.
  float weight_alone = 0;
  /// How likely each wavelength would have led to this ray, up to a factor; lanes without a band do not
  /// count.
  Lanes density = Lanes::all(1);
  /// Where each wavelength lands [pixels]; all at the film sample unless `spread`.
  bool spread = false;
  std::array<float, lane_count> column{}, row{};
};

/// How a picture is taken. Implementations may be asked from several threads at once.
class FilmCamera {
 public:
  virtual ~FilmCamera() = default;
  /// Rays for samples of one group of wavelengths; many at a time are cheaper. `rays` is as long as
  /// `samples`.
  /// \param film  how the samples of the picture are drawn: what else could have found a ray.
  virtual void trace(int group, const FilmSampling& film, std::span<const FilmSample> samples,
                     std::span<CameraRay> rays) const = 0;
  /// Whether wavelengths part on their way, so that it matters which one leads.
  virtual bool disperses() const { return false; }
  /// Where light lands by wave optics, where that is wanted; null: everywhere as rays have it.
  virtual const WaveImage* waves() const { return nullptr; }
};

}  // namespace petzval::render
