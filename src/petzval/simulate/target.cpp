// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/version.h>
#include <petzval/base/wavelength.h>
#include <petzval/lens/first_order.h>
#include <petzval/sensor/lens_facts.h>
#include <petzval/sensor/photo_current.h>
#include <petzval/simulate/target.h>
#include <petzval/wave/gaussian_otf.h>
#include <petzval/wave/sampled_otf.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>
#include <string_view>

namespace petzval {

namespace {

void check(const TargetRequest& request) {
  if (request.wavelengths_nm.empty()) throw InputError("`wavelength`: at least one is needed");
  for (const double nm : request.wavelengths_nm) require_wavelength(nm, fmt::format("`wavelength` {:g}", nm));
  if (!request.weights.empty() && request.weights.size() != request.wavelengths_nm.size())
    throw InputError(fmt::format("`weights`: {} for {} wavelengths; give one a wavelength",
                                 request.weights.size(), request.wavelengths_nm.size()));
  if (!std::isfinite(request.black) || !std::isfinite(request.white) || request.black == request.white)
    throw InputError(fmt::format("`black` {} and `white` {}: two different numbers are right", request.black,
                                 request.white));
}

/// The share of the light in each wavelength.
std::vector<double> shares(const TargetRequest& request) {
  std::vector<double> result = request.weights;
  if (result.empty()) result.assign(request.wavelengths_nm.size(), 1.0);
  for (const double weight : result)
    if (!(weight >= 0) || !std::isfinite(weight))
      throw InputError(fmt::format("a weight of {}: zero or a positive number is right", weight));
  const double sum = std::accumulate(result.begin(), result.end(), 0.0);
  if (!(sum > 0))
    throw InputError("the weights of the wavelengths are all zero; one at least must be positive");
  for (double& share : result) share /= sum;
  return result;
}

std::shared_ptr<const Otf> otf_of(const PupilBlur& blur, const TargetRequest& request, double nm) {
  GeneralPupil scaled = blur.pupil;
  for (std::vector<double>* waves : {&scaled.w_waves, &scaled.zernike_waves})
    for (double& w : *waves) w *= request.wavelengths_nm.front() / nm;
  return general_pupil_otf(scaled, nm, blur.f_number);
}

std::shared_ptr<const Otf> otf_of(const GaussianBlur& blur, const TargetRequest&, double) {
  if (blur.ratio == 1) return gaussian_otf(blur.sigma_um);
  return elliptical_gaussian_otf(blur.sigma_um, blur.ratio * blur.sigma_um);
}

std::shared_ptr<const Otf> otf_of(const LensBlur& blur, const TargetRequest&, double nm) {
  FieldTracer tracer(blur.lens, nm);
  const std::optional<ChiefRay> chief =
      tracer.chief_ray(object_field(blur.lens, blur.lens.fields.kind, blur.field));
  const std::optional<Psf> spread = chief ? point_spread(tracer, *chief, {}) : std::nullopt;
  if (!spread)
    throw InputError(
        fmt::format("{}: no ray passes at field {:g} and {:g} nm", blur.lens.name, blur.field, nm));
  return std::make_shared<SampledOtf>(*spread);
}

void to_levels(TargetImage& image, const TargetRequest& request) {
  if (request.black == 0 && request.white == 1) return;
  for (double& value : image.values()) value = request.black + value * (request.white - request.black);
}

TargetImage levels(const TargetRequest& request, const Otf& otf) {
  TargetImage image = render_target(request.scene, otf, target_options(request));
  to_levels(image, request);
  return image;
}

std::string blur_text(const GaussianBlur& blur) {
  if (blur.ratio == 1) return fmt::format("a Gaussian of {:g} um", blur.sigma_um);
  return fmt::format("a Gaussian of {:g} x {:g} um", blur.sigma_um, blur.ratio * blur.sigma_um);
}
std::string blur_text(const PupilBlur& blur) {
  return fmt::format("a pupil at f/{:g}", blur.f_number);
}
std::string blur_text(const LensBlur& blur) {
  return fmt::format("{} at field {:g}", blur.lens.name, blur.field);
}

std::optional<LensFacts> facts(const GaussianBlur&) {
  return {};
}
std::optional<LensFacts> facts(const PupilBlur& blur) {
  return LensFacts{.f_number = blur.f_number};
}
std::optional<LensFacts> facts(const LensBlur& blur) {
  return lens_facts(blur.lens.name, first_order(blur.lens));
}

void require_room(int columns, int rows, const Sensor& sensor) {
  const SensorGeometry& frame = sensor.geometry;
  if (columns > frame.columns || rows > frame.rows)
    throw InputError(
        fmt::format("a picture of {} x {} pixels on {}, which has {} x {}; a smaller `size` is right",
                    columns, rows, sensor.name, frame.columns, frame.rows));
}

/// The light of the ground, unless a channel of the sensor is blind to it: no white balance follows from it
/// then.
std::optional<Spectrum> white_for(const TargetRequest& request, const Spectrum& light) {
  if (request.sensor && request.sensor->electronics)
    for (const double current : channel_currents(*request.sensor, light))
      if (!(current > 0)) return {};
  return light;
}

/// Without light, but all else stated.
SpectralImage empty_image(const TargetRequest& request, const std::vector<std::size_t>& order,
                          const std::vector<double>& share) {
  std::vector<double> nm, white;
  for (const std::size_t i : order) nm.push_back(request.wavelengths_nm[i]), white.push_back(share[i]);
  if (std::ranges::adjacent_find(nm) != nm.end()) throw InputError("`wavelength`: each may be given once");
  const TargetOptions options = target_options(request);
  const std::string aperture = options.photosite.text();
  SpectralImage image(options.columns, options.rows, nm, options.pitch_um,
                      aperture == "box"     ? PixelAperture::box
                      : aperture == "point" ? PixelAperture::point
                                            : PixelAperture::photosite);
  if (image.pixel_aperture() == PixelAperture::photosite) image.photosite = aperture;
  image.lens = std::visit([](const auto& blur) { return facts(blur); }, request.blur);
  image.illuminant = white_for(request, Spectrum(nm, white));
  image.provenance = fmt::format("petzval {} target: {} polygons through {}, level 1 is 1 W m^-2 nm^-1",
                                 version(), request.scene.polygons.size(),
                                 std::visit([](const auto& blur) { return blur_text(blur); }, request.blur));
  return image;
}

}  // namespace

TargetOptions target_options(const TargetRequest& request) {
  TargetOptions options;
  options.columns = request.columns, options.rows = request.rows;
  options.pitch_um = request.sensor ? request.sensor->geometry.pitch_um : request.pitch_um;
  options.photosite = request.sensor ? request.sensor->photosite : request.photosite;
  if (request.sensor) require_room(request.columns, request.rows, *request.sensor);
  return options;
}

GaussianBlur gaussian_of_mtf50(double mtf50_cpp, double pitch_um, const Photosite& photosite) {
  if (!(mtf50_cpp > 0) || !std::isfinite(mtf50_cpp))
    throw InputError(fmt::format("`mtf50` {}: a positive number [cycles/pixel] is right", mtf50_cpp));
  const double site = std::abs(photosite.transform(mtf50_cpp, 0));
  if (!(site > 0.5))
    throw InputError(
        fmt::format("`mtf50` {:g} cycles/pixel: there the photosites alone leave {:.3f}; a lower "
                    "frequency, or smaller photosites, are right",
                    mtf50_cpp, site));
  // exp(−2π²σ²f²) · site = ½.
  return {std::sqrt(std::log(2 * site) / 2) / (pi * mtf50_cpp) * pitch_um, 1};
}

std::shared_ptr<const Otf> target_otf(const TargetRequest& request, double wavelength_nm) {
  check(request);
  return std::visit([&](const auto& blur) { return otf_of(blur, request, wavelength_nm); }, request.blur);
}

std::shared_ptr<const Otf> target_otf(const TargetRequest& request) {
  check(request);
  if (request.wavelengths_nm.size() == 1) return target_otf(request, request.wavelengths_nm.front());
  std::vector<MixedOtf::Part> parts;
  for (std::size_t i = 0; i < request.wavelengths_nm.size(); ++i)
    parts.push_back(
        {request.weights.empty() ? 1.0 : request.weights[i], target_otf(request, request.wavelengths_nm[i])});
  return std::make_shared<MixedOtf>(std::move(parts));
}

SpectralImage target(const TargetRequest& request, const Context& context) {
  check(request);
  const std::vector<double> share = shares(request);
  std::vector<std::size_t> order(request.wavelengths_nm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return request.wavelengths_nm[i]; });
  SpectralImage light = empty_image(request, order, share);
  run_within(context, [&](const ProgressCallback& progress) {
    for (int band = 0; band < light.bands(); ++band) {
      if (progress) progress(static_cast<double>(band) / light.bands(), "target");
      const std::size_t i = order[static_cast<std::size_t>(band)];
      const TargetImage image = levels(request, *target_otf(request, request.wavelengths_nm[i]));
      std::ranges::transform(image.values(), light.band(band).begin(),
                             [&](double value) { return static_cast<float>(share[i] * value); });
    }
  });
  return light;
}

TargetImage relative_target(const TargetRequest& request, const Context& context) {
  return result_within(context,
                       [&](const ProgressCallback&) { return levels(request, *target_otf(request)); });
}

TargetImage mosaic_target(const TargetRequest& request, const std::string& pattern, const Context& context) {
  std::string letters = pattern;
  std::ranges::transform(letters, letters.begin(), [](unsigned char c) { return std::tolower(c); });
  constexpr std::array<std::string_view, 4> known{"rggb", "bggr", "grbg", "gbrg"};
  if (std::ranges::find(known, letters) == known.end())
    throw InputError(fmt::format("`bayer` {}: rggb, bggr, grbg or gbrg is right", pattern));
  if (request.wavelengths_nm.size() != 3)
    throw InputError(
        "`bayer` takes three wavelengths, for red, green and blue: `wavelength` 620,540,460 for example");
  return result_within(context, [&](const ProgressCallback&) {
    constexpr std::string_view colours = "rgb";
    TargetImage result(request.rows, request.columns);
    for (std::size_t colour = 0; colour < colours.size(); ++colour) {
      const TargetImage image = levels(request, *target_otf(request, request.wavelengths_nm[colour]));
      for (int row = 0; row < result.rows(); ++row)
        for (int column = 0; column < result.columns(); ++column)
          if (letters[static_cast<std::size_t>(row % 2 * 2 + column % 2)] == colours[colour])
            result.at(row, column) = image.at(row, column);
    }
    return result;
  });
}

double geometric_blur_um(const TargetRequest& request) {
  const auto* blur = std::get_if<PupilBlur>(&request.blur);
  if (!blur) return 0;
  const double radius =
      blur->pupil.is_radial() ? geometric_radius(blur->pupil.radial()) : 2 * blur->pupil.steepest();
  return 2 * radius * request.wavelengths_nm.front() * 1e-3 * blur->f_number;
}

}  // namespace petzval
