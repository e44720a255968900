// SPDX-License-Identifier: BSD-3-Clause
#include "target_optics.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>

#include <charconv>
#include <cmath>

namespace petzval::app {

std::pair<double, double> pair_of(const std::string& text, char separator, const std::string& option) {
  const std::size_t at = text.find(separator);
  double first = 0, second = 0;
  const auto whole = [](const char* from, const char* to, double& value) {
    const auto [end, error] = std::from_chars(from, to, value);
    return error == std::errc() && end == to && std::isfinite(value);
  };
  if (at == std::string::npos || !whole(text.data(), text.data() + at, first) ||
      !whole(text.data() + at + 1, text.data() + text.size(), second))
    throw InputError(
        fmt::format("{} {}: two numbers with '{}' between them are right", option, text, separator));
  return {first, second};
}

void TargetOptics::add_to(CLI::App& command) {
  command
      .add_option("--psf", psf,
                  "airy, wavefront (with --w020, --zernike and so on), gaussian (with --sigma) or lens")
      ->check(CLI::IsMember({"airy", "wavefront", "gaussian", "lens"}));
  lens.add_to(command, false, false);
  command.add_option("--field", field,
                     "Field of the --lens, as its file defines fields; its image lies below the middle");
  command.add_option("--f-number", f_number, "Working f-number")->capture_default_str();
  command
      .add_option("--wavelength", wavelengths_nm,
                  "Wavelength [nm]; several, separated by commas, are mixed by --weights")
      ->delimiter(',');
  command.add_option("--weights", weights, "Light of each wavelength; default: equal")->delimiter(',');
  command.add_option("--pixel-pitch", pitch_um, "Pixel pitch [um]")->capture_default_str();
  pupil.add_to(command);
  command.add_option("--sigma", sigma_um, "Standard deviation of a Gaussian PSF along x [um]");
  command.add_option("--mtf50", mtf50_cpp,
                     "Instead of --sigma: MTF50 of upright edges, photosites included [cycles/pixel]");
  command
      .add_option("--psf-ratio", psf_ratio, "Standard deviation of a Gaussian PSF along y over that along x")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option(
          "--photosite", photosite,
          "square, none (a point), rectangle:WxH, circle:D, ellipse:WxH or polygon:x,y,x,y,... in pixels")
      ->capture_default_str();
  command.add_option("--fill-factor", fill_factor, "Area of a square photosite over that of the pixel");
  command.add_option("--low-pass", low_pass,
                     "Separation XxY of the four dots of an optical low-pass filter [pixels]");
}

void TargetOptics::validate(bool has_sensor) const {
  if ((psf == "lens") != !lens.path_or_name.empty())
    throw InputError("--psf lens and --lens LENS belong together; give both or neither");
  if (psf != "lens" && field) throw InputError("--field belongs to --psf lens");
  if (const std::vector<std::string> of_lens = lens.given_settings(); psf != "lens" && !of_lens.empty())
    throw InputError(fmt::format("{} alters a lens: --psf lens --lens LENS would be right", of_lens.front()));
  if (psf != "wavefront" && pupil.is_aberrated())
    throw InputError(fmt::format(
        "--psf {} has no aberrations; --psf wavefront takes --w020, --w040, --w060, --w080, --zernike", psf));
  if (sigma_um != 0 && mtf50_cpp != 0)
    throw InputError("--sigma and --mtf50 both say how wide a Gaussian PSF is; give one");
  if ((psf == "gaussian") != (sigma_um != 0 || mtf50_cpp != 0))
    throw InputError(
        "--psf gaussian and --sigma [um] or --mtf50 [cycles/pixel] belong together; give both or neither");
  if (psf != "gaussian" && psf_ratio != 1) throw InputError("--psf-ratio belongs to --psf gaussian");
  if ((psf == "gaussian" || psf == "lens") && pupil.is_shaped())
    throw InputError(fmt::format(
        "--psf {} brings its own pupil; --blades and --obstruction belong to airy and wavefront", psf));
  if (fill_factor != 1 && photosite != "square" && !has_sensor)
    throw InputError("--fill-factor belongs to --photosite square");
  if (!(pitch_um > 0) || !std::isfinite(pitch_um))
    throw InputError(fmt::format("--pixel-pitch {}: a positive number [um] is right", pitch_um));
}

void TargetOptics::fill(TargetRequest& request, const Shared& shared) const {
  validate(request.sensor.has_value());
  request.wavelengths_nm = wavelengths_nm;
  request.weights = weights;
  request.pitch_um = pitch_um;
  request.photosite = site();
  if (psf == "gaussian")
    request.blur = gaussian(request);
  else if (psf == "lens")
    request.blur = LensBlur{lens.read(shared), field.value_or(0)};
  else
    request.blur = PupilBlur{pupil.at(wavelengths_nm.empty() ? 0 : wavelengths_nm.front()), f_number};
}

GaussianBlur TargetOptics::gaussian(const TargetRequest& request) const {
  if (mtf50_cpp == 0) return {sigma_um, psf_ratio};
  const TargetOptions seen = target_options(request);
  GaussianBlur blur = gaussian_of_mtf50(mtf50_cpp, seen.pitch_um, seen.photosite);
  blur.ratio = psf_ratio;
  return blur;
}

Photosite TargetOptics::site() const {
  Photosite result;
  const std::size_t colon = photosite.find(':');
  const std::string kind = photosite.substr(0, colon);
  const std::string sizes = colon == std::string::npos ? "" : photosite.substr(colon + 1);
  if (photosite == "square") {
    result = Photosite::square(fill_factor);
  } else if (photosite == "none") {
    result.shape = Photosite::Shape::none;
  } else if (kind == "rectangle" || kind == "ellipse") {
    result.shape = kind == "ellipse" ? Photosite::Shape::ellipse : Photosite::Shape::rectangle;
    std::tie(result.width, result.height) = pair_of(sizes, 'x', "--photosite");
  } else if (kind == "circle") {
    result.shape = Photosite::Shape::ellipse;
    std::tie(result.width, result.height) = pair_of(sizes + "x" + sizes, 'x', "--photosite");
  } else if (kind == "polygon") {
    result.shape = Photosite::Shape::polygon;
    std::string rest = sizes;
    if (rest.empty() || rest.ends_with(','))
      throw InputError(fmt::format("--photosite {}: polygon:x,y,... would be right", quotable(photosite)));
    while (!rest.empty()) {
      std::size_t end = rest.find(',');
      end = end == std::string::npos ? end : rest.find(',', end + 1);
      result.vertices.push_back(pair_of(rest.substr(0, end), ',', "--photosite"));
      rest = end == std::string::npos ? "" : rest.substr(end + 1);
    }
  } else {
    throw InputError(fmt::format(
        "--photosite {}: square, none, rectangle:WxH, circle:D, ellipse:WxH or polygon:x,y,... is right",
        photosite));
  }
  if (!low_pass.empty())
    std::tie(result.separation_x, result.separation_y) = pair_of(low_pass, 'x', "--low-pass");
  return result;
}

}  // namespace petzval::app
