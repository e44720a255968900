// SPDX-License-Identifier: BSD-3-Clause
// The third way to the sensor: figures of exactly known sharpness, through optics that are known exactly.
#pragma once

#include <petzval/base/context.h>
#include <petzval/image/spectral_image.h>
#include <petzval/lens/lens.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/expose.h>
#include <petzval/target/render_target.h>
#include <petzval/wave/pupil_otf.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// A pupil of any shape and wavefront. Waves are those of the first wavelength; at others the path is the
/// same. An empty pupil is clear and round: Airy's.
struct PupilBlur {
  GeneralPupil pupil = {};
  double f_number = 8;  ///< working
};

/// The same Gaussian at every wavelength.
struct GaussianBlur {
  double sigma_um = 0;  ///< along the picture's x axis
  double ratio = 1;     ///< of the standard deviation along y to that along x
};

/// A lens at a field, as its file defines fields; the image lies below the middle.
struct LensBlur {
  Lens lens = {};
  double field = 0;
};

using TargetBlur = std::variant<PupilBlur, GaussianBlur, LensBlur>;

/// A target and how it is seen. A value: alter it and see again.
///
///     TargetRequest request;
///     request.scene.polygons = {{{rectangle({120, 120}, 100, 100, 5)}}};
///     request.columns = request.rows = 240;
///     request.blur = PupilBlur{.f_number = 5.6};
///     const SpectralImage light = target(request);
struct TargetRequest {
  /// Made by rectangle(), half_plane(), text_polygons(), test_chart(), or read from a file
  /// (target/formats). Levels: 0 is `black` and 1 is `white`.
  TargetScene scene = {};
  int columns = 0, rows = 0;
  TargetBlur blur = {};
  std::vector<double> wavelengths_nm{550};
  std::vector<double> weights = {};  ///< of the light of each wavelength; empty: equal
  double pitch_um = 4.73;
  Photosite photosite = {};
  std::optional<Sensor> sensor = {};  ///< its pitch and photosite are then those
  double black = 0, white = 1;        ///< linear levels
};

/// Frame, pitch and photosite, the sensor's where there is one.
TargetOptions target_options(const TargetRequest& request);

/// The Gaussian with which edges upright in the picture have this MTF50, photosites included.
/// \throws InputError for a frequency at which the photosites alone leave less than half.
GaussianBlur gaussian_of_mtf50(double mtf50_cpp, double pitch_um, const Photosite& photosite);

/// Of one wavelength. \throws InputError for optics that are none, or a field that no ray reaches.
std::shared_ptr<const Otf> target_otf(const TargetRequest& request, double wavelength_nm);
/// Of all wavelengths with their weights.
std::shared_ptr<const Otf> target_otf(const TargetRequest& request);

/// The irradiance on the sensor: a band for each wavelength, seen through the optics at that wavelength.
/// Level 1 is 1 W·m⁻²·nm⁻¹, shared out to the bands by their weights, so that the bands add up to
/// relative_target(). Bands stand in the order of their wavelengths. The lens's facts are stated as far as
/// they are known. \throws InputError as render_target(), for wavelengths that are given twice, and for a
/// frame larger than the sensor; Cancelled.
SpectralImage target(const TargetRequest& request, const Context& context = {});

/// All wavelengths together, as levels in double precision. \throws as target().
TargetImage relative_target(const TargetRequest& request, const Context& context = {});

/// A mosaic of levels: each pixel sees the wavelength of its colour. \param pattern  "rggb", "bggr", "grbg"
/// or "gbrg"; wavelengths are those of red, green and blue. \throws InputError for others; as target().
TargetImage mosaic_target(const TargetRequest& request, const std::string& pattern,
                          const Context& context = {});

/// What a sensor makes of levels, where level 1 saturates every pixel, whatever its colour: numbers of the
/// converter over their range from black to white. Automatic exposure is taken for 0.01 s, for nothing but
/// dark electrons depends on it. Noise grows from the context's seed. \throws InputError for a picture
/// larger than the sensor, and as capture(); Cancelled.
TargetImage recorded_levels(const TargetImage& levels, const Sensor& sensor,
                            const ExposeOptions& options = {}, const Context& context = {});

/// Gaussian noise of this standard deviation. \throws InputError unless it is zero or more.
void add_target_noise(TargetImage& levels, double sigma, std::uint64_t seed);

/// Diameter of the blur that geometry alone would make, twice the largest transverse aberration [um]; 0 but
/// for a pupil with aberrations.
double geometric_blur_um(const TargetRequest& request);

}  // namespace petzval
