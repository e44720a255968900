// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/parallel.h>
#include <petzval/base/text_lines.h>
#include <petzval/colour/spectrum_text.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npz.h>
#include <petzval/image/formats/spectral_exr.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace petzval {

namespace {

constexpr const char* pitch_attribute = "pixelPitch_um";
constexpr const char* aperture_attribute = "pixelAperture";
const std::string photosite_prefix = "photosite: ";
constexpr const char* illuminant_attribute = "sceneIlluminant";
constexpr const char* lens_attribute = "lensName";
constexpr std::pair<const char*, double LensFacts::*> lens_numbers[] = {
    {"focalLength_mm", &LensFacts::focal_length_mm},
    {"fNumber", &LensFacts::f_number},
    {"exitPupil_mm", &LensFacts::exit_pupil_mm}};
constexpr std::pair<const char*, std::vector<double> LensFacts::*> lens_lists[] = {
    {"lensWarp", &LensFacts::warp},
    {"lensVignetting", &LensFacts::vignetting},
    {"lensFisheyeWarp", &LensFacts::fisheye_warp}};
constexpr const char* gain_map_attribute = "lensGainMap";  // columns, rows, gains
constexpr const char* provenance_attribute = "comments";   // OpenEXR's own name for it: viewers show it

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

/// All but the values.
SpectralExr description_of(const SpectralImage& image, const std::vector<ExrPlane>& layers) {
  SpectralExr exr;
  exr.others = layers;
  exr.lamps.assign(image.lamps.begin(), image.lamps.end());
  exr.width = image.columns();
  exr.height = image.rows();
  exr.wavelengths_nm = image.wavelengths_nm();
  exr.units = spectral_irradiance_units;
  exr.numbers[pitch_attribute] = image.pitch_um();
  exr.strings[aperture_attribute] = image.pixel_aperture() == PixelAperture::box ? "box"
                                    : image.pixel_aperture() == PixelAperture::point
                                        ? "point"
                                        : photosite_prefix + image.photosite;
  if (!image.provenance.empty()) exr.strings[provenance_attribute] = image.provenance;
  if (image.illuminant) exr.strings[illuminant_attribute] = spectrum_text(*image.illuminant);
  if (image.lens) {
    if (!image.lens->name.empty()) exr.strings[lens_attribute] = image.lens->name;
    for (const auto& [attribute, member] : lens_numbers)
      if ((*image.lens).*member != 0) exr.numbers[attribute] = (*image.lens).*member;
    for (const auto& [attribute, member] : lens_lists)
      if (!((*image.lens).*member).empty())
        exr.strings[attribute] = fmt::format("{}", fmt::join((*image.lens).*member, " "));
    if (const GainMap& map = image.lens->gain_map; map.rows > 0)
      exr.strings[gain_map_attribute] =
          fmt::format("{} {} {}", map.columns, map.rows, fmt::join(map.gains, " "));
  }
  return exr;
}

/// What the pixels stand for: "box", "point", or else the description of a photosite.
std::string aperture_text(const SpectralExr& exr, const std::string& path) {
  const auto found = exr.strings.find(aperture_attribute);
  if (found != exr.strings.end() &&
      (found->second == "box" || found->second == "point" || found->second.starts_with(photosite_prefix)))
    return found->second;
  throw InputError(path, fmt::format("needs the attribute {} = \"box\", \"point\" or \"photosite: …\"",
                                     aperture_attribute));
}

/// \throws InputError unless the text is numbers with spaces between them.
std::vector<double> numbers_of(const std::string& text, const std::string& path, const char* attribute) {
  std::vector<double> numbers;
  for (const std::string& word : split_words(text)) {
    const std::optional<double> number = parse_number(word);
    if (!number)
      throw InputError(path, fmt::format("the attribute {}: {} is no number", attribute, quotable(word)));
    numbers.push_back(*number);
  }
  return numbers;
}

GainMap gain_map_of(const std::string& text, const std::string& path) {
  const std::vector<double> numbers = numbers_of(text, path, gain_map_attribute);
  constexpr std::size_t sizes = 2;
  constexpr double most = 4096;  // points on a side
  const auto is_side = [](double side) { return side >= 2 && side <= most && side == std::floor(side); };
  if (numbers.size() < sizes || !is_side(numbers[0]) || !is_side(numbers[1]) ||
      static_cast<double>(numbers.size() - sizes) != numbers[0] * numbers[1])
    throw InputError(
        path, fmt::format("the attribute {}: columns, rows (2 to {:g}) and as many gains would be right",
                          gain_map_attribute, most));
  GainMap map{static_cast<int>(numbers[0]), static_cast<int>(numbers[1]), {}};
  for (std::size_t i = sizes; i < numbers.size(); ++i) map.gains.push_back(static_cast<float>(numbers[i]));
  return map;
}

std::optional<LensFacts> lens_of(const SpectralExr& exr, const std::string& path) {
  LensFacts lens;
  bool known = false;
  if (const auto name = exr.strings.find(lens_attribute); name != exr.strings.end())
    lens.name = name->second, known = true;
  for (const auto& [attribute, member] : lens_numbers) {
    const auto found = exr.numbers.find(attribute);
    if (found == exr.numbers.end()) continue;
    if (!std::isfinite(found->second))
      throw InputError(path, fmt::format("{} is {}", attribute, found->second));
    lens.*member = found->second, known = true;
  }
  for (const auto& [attribute, member] : lens_lists)
    if (const auto found = exr.strings.find(attribute); found != exr.strings.end())
      lens.*member = numbers_of(found->second, path, attribute), known = true;
  if (const auto found = exr.strings.find(gain_map_attribute); found != exr.strings.end())
    lens.gain_map = gain_map_of(found->second, path), known = true;
  return known ? std::optional(lens) : std::nullopt;
}

std::optional<Spectrum> illuminant_of(const SpectralExr& exr, const std::string& path) {
  const auto found = exr.strings.find(illuminant_attribute);
  if (found == exr.strings.end()) return {};
  try {
    return parse_spectrum_text(found->second);
  } catch (const InputError& error) {
    throw InputError(path, fmt::format("the attribute {}: {}", illuminant_attribute, error.what()));
  }
}

/// The values with the bands of a pixel side by side, and what they are of.
void write_irradiance_npz(const std::string& path, const SpectralImage& image) {
  const auto bands = static_cast<std::size_t>(image.bands());
  NpyArray light{{static_cast<std::size_t>(image.rows()), static_cast<std::size_t>(image.columns()), bands},
                 {}};
  std::vector<float> values(image.band_size() * bands);
  for (std::size_t band = 0; band < bands; ++band) {
    const std::span<const float> plane = image.band(static_cast<int>(band));
    for (std::size_t i = 0; i < plane.size(); ++i) values[i * bands + band] = plane[i];
  }
  light.values = std::move(values);
  write_npz(path, {{"irradiance", std::move(light)},
                   {"wavelengths_nm", {{bands}, image.wavelengths_nm()}},
                   {"pitch_um", {{}, std::vector<double>{image.pitch_um()}}}});
}

/// An array as an image. \param wavelengths  where they come from, for messages.
SpectralImage image_of(const NpyArray& array, const std::vector<double>& wavelengths_nm,
                       const BareIrradiance& bare, double pitch_um, const std::string& path,
                       const char* wavelengths) {
  const std::vector<std::size_t>& shape = array.shape;
  constexpr std::size_t longest = 1 << 20;
  if (shape.size() < 2 || shape.size() > 3 || shape[0] > longest || shape[1] > longest)
    throw InputError(
        path, "holds no picture; an array of (rows, columns, bands) or (rows, columns) would be right");
  const std::size_t bands = shape.size() == 3 ? shape[2] : 1;
  if (wavelengths_nm.size() != bands)
    throw InputError(path, fmt::format("has {} bands and {} wavelengths; as many {} would be right", bands,
                                       wavelengths_nm.size(), wavelengths));
  SpectralImage image(static_cast<int>(shape[1]), static_cast<int>(shape[0]), wavelengths_nm, pitch_um,
                      bare.aperture);
  image.photosite = bare.photosite;
  std::visit(
      [&](const auto& values) {
        for (std::size_t band = 0; band < bands; ++band) {
          const std::span<float> plane = image.band(static_cast<int>(band));
          for (std::size_t i = 0; i < plane.size(); ++i)
            plane[i] = static_cast<float>(values[i * bands + band]);
        }
      },
      array.values);
  image.validate();
  return image;
}

/// An image without light of what a file describes. \throws InputError for one of no irradiance.
SpectralImage image_of(const SpectralExr& exr, const std::string& path) {
  if (exr.kind != SpectralExr::Kind::emissive || exr.units != spectral_irradiance_units)
    throw InputError(path, fmt::format("holds {}, not irradiance [{}]",
                                       exr.kind == SpectralExr::Kind::reflective ? "reflectance"
                                       : exr.units.empty()                       ? "values without units"
                                                                                 : "values in " + exr.units,
                                       spectral_irradiance_units));
  const auto pitch = exr.numbers.find(pitch_attribute);
  if (pitch == exr.numbers.end())
    throw InputError(path, fmt::format("has no pixel pitch; the attribute {} must give it", pitch_attribute));
  const std::string aperture = aperture_text(exr, path);
  if (!(pitch->second > 0) || std::isinf(pitch->second))
    throw InputError(path, fmt::format("{} is {}; it must be positive", pitch_attribute, pitch->second));
  SpectralImage image(exr.width, exr.height, exr.wavelengths_nm, pitch->second,
                      aperture == "box"     ? PixelAperture::box
                      : aperture == "point" ? PixelAperture::point
                                            : PixelAperture::photosite);
  if (image.pixel_aperture() == PixelAperture::photosite)
    image.photosite = aperture.substr(photosite_prefix.size());
  return image;
}

/// \throws InputError at a value of rows [first, end) that is NaN or infinite.
void check_rows(const SpectralImage& image, int first, int end, const std::string& path) {
  const auto columns = static_cast<std::size_t>(image.columns());
  parallel_for(static_cast<std::size_t>(image.bands()), [&](std::size_t band) {
    const std::span<const float> values = image.band(static_cast<int>(band))
                                              .subspan(static_cast<std::size_t>(first) * columns,
                                                       static_cast<std::size_t>(end - first) * columns);
    const auto bad = std::ranges::find_if(values, [](float value) { return !std::isfinite(value); });
    if (bad == values.end()) return;
    const auto at = static_cast<std::size_t>(bad - values.begin());
    throw InputError(path, fmt::format("the value at {} nm, row {}, column {} is {}; it must be finite",
                                       image.wavelengths_nm()[band],
                                       static_cast<std::size_t>(first) + at / columns, at % columns, *bad));
  });
}

}  // namespace

SpectralImage read_irradiance(const std::string& path, const BareIrradiance& bare) {
  if (extension_of(path) == ".npy")
    return image_of(read_npy(path), bare.wavelengths_nm, bare, bare.pitch_um, path, "`wavelengths_nm`");
  if (extension_of(path) != ".npz") return read_irradiance(path);
  const std::vector<NamedArray> arrays = read_npz(path);
  double pitch_um = bare.pitch_um;
  for (const NamedArray& each : arrays)
    if (each.name == "pitch_um") {
      const std::vector<double> values = double_values(each.array);
      if (values.size() != 1) throw InputError(path, "pitch_um is one number");
      pitch_um = values[0];
    }
  const NpyArray& light = find_array(arrays, "irradiance", path);
  return image_of(light, double_values(find_array(arrays, "wavelengths_nm", path)), bare, pitch_um, path,
                  "in `wavelengths_nm`");
}

void write_irradiance(const std::string& path, const SpectralImage& image,
                      const std::vector<ExrPlane>& layers) {
  const std::string extension = extension_of(path);
  if (extension == ".exr")
    return write_spectral_exr(path, description_of(image, layers), image.values(),
                              [&] { image.release_memory(); });
  if (extension == ".npy") return write_npy(path, image);
  if (extension == ".npz") return write_irradiance_npz(path, image);
  throw InputError(path, "irradiance is written as .exr, .npy or .npz");
}

void write_irradiance(const std::string& path, SpectralImage&& image, const std::vector<ExrPlane>& layers) {
  if (extension_of(path) == ".npy") return write_npy(path, std::move(image));
  write_irradiance(path, std::as_const(image), layers);
}

SpectralImage read_irradiance(const std::string& path) {
  if (extension_of(path) == ".npy")
    throw InputError(path,
                     "a .npy file carries neither wavelengths nor pixel pitch; give the irradiance as .exr");
  SpectralImage image;
  SpectralExr exr = read_spectral_exr_into(path, [&](const SpectralExr& header) {
    image = image_of(header, path);
    SpectralPlanes planes;
    for (int band = 0; band < image.bands(); ++band) planes.bands.push_back(image.band(band));
    planes.after_rows = [&image, &path](int first, int end) {
      check_rows(image, first, end, path);
      image.release_memory();
    };
    return planes;
  });
  image.provenance = exr.strings[provenance_attribute];
  image.lens = lens_of(exr, path);
  image.illuminant = illuminant_of(exr, path);
  image.lamps.resize(exr.lamps.size());
  std::ranges::transform(exr.lamps, image.lamps.begin(), [](float lamp) { return lamp > 0 ? 1 : 0; });
  return image;
}

}  // namespace petzval
