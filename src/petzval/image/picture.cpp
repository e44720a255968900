// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/colour_map.h>
#include <petzval/image/picture.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Each band's share of X, Y and Z in lx per W·m⁻²·nm⁻¹; without visible light, its width in all three.
std::vector<Xyz> level_weights(const std::vector<double>& wavelengths_nm, bool& visible) {
  std::vector<Xyz> weights = Observer::cie_1931().weights(wavelengths_nm);
  visible = std::any_of(weights.begin(), weights.end(), [](Xyz weight) { return weight.y > 0; });
  for (Xyz& weight : weights) weight = lumens_per_watt * weight;
  if (visible) return weights;
  const std::vector<double> widths = band_widths_nm(wavelengths_nm);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = {widths[i], widths[i], widths[i]};
  return weights;
}

Xyz scene_white_xyz(const Spectrum& white, const std::vector<double>& wavelengths_nm,
                    const std::vector<Xyz>& weights) {
  Xyz sum;
  for (std::size_t i = 0; i < weights.size(); ++i) sum = sum + white.at(wavelengths_nm[i]) * weights[i];
  if (!(sum.y > 0))
    throw InputError("the light of the scene has no visible power at the wavelengths of the image");
  return (1 / sum.y) * sum;
}

void check(const PictureOptions& options) {
  using Exposure = PictureOptions::Exposure;
  if (options.exposure == Exposure::percentile && !(options.percentile > 0 && options.percentile <= 100))
    throw InputError(
        fmt::format("an exposure percentile of {}; it must be above 0 and at most 100", options.percentile));
  if (options.exposure == Exposure::mean_grey && !(options.grey > 0 && options.grey <= 1))
    throw InputError(fmt::format("a mean grey of {}; it must be above 0 and at most 1", options.grey));
  if (options.exposure == Exposure::fixed && !(options.white_level > 0 && std::isfinite(options.white_level)))
    throw InputError(fmt::format("a white level of {}; it must be positive", options.white_level));
}

/// The levels that are metered.
std::vector<float> without_lamps(const std::vector<float>& levels, const std::vector<std::uint8_t>& lamps) {
  std::vector<float> metered;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (lamps.empty() || lamps[i] == 0) metered.push_back(levels[i]);
  const bool dark = std::ranges::none_of(metered, [](float level) { return level > 0; });
  return dark ? levels : metered;
}

/// The smallest level that at least `percent` % of the levels do not exceed; if that is no light, the largest
/// level.
double percentile_of(std::vector<float>& levels, double percent) {
  const double rank = std::ceil(percent / 100 * static_cast<double>(levels.size()));
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(levels.begin(), levels.begin() + index, levels.end());
  const float level = levels[static_cast<std::size_t>(index)];
  return level > 0 ? level : *std::max_element(levels.begin(), levels.end());
}

/// The largest level that `percent` % of the levels and no more do not reach.
double level_not_reached(std::vector<float>& levels, double percent) {
  const auto index = static_cast<std::ptrdiff_t>(percent / 100 * static_cast<double>(levels.size() - 1));
  std::nth_element(levels.begin(), levels.begin() + index, levels.end());
  return levels[static_cast<std::size_t>(index)];
}

/// Whether three quarters of a picture are dark beside its brightest pixel: lights in darkness. Then the
/// levels of the lights are left, a thousandth of the brightest and more.
bool leave_lights(std::vector<float>& levels, double dark) {
  constexpr double most_percent = 75;
  constexpr float lit = 1e-3F;
  const float brightest = *std::max_element(levels.begin(), levels.end());
  if (level_not_reached(levels, most_percent) > dark * double(brightest)) return false;
  std::erase_if(levels, [&](float level) { return level < lit * brightest; });
  return true;
}

/// Linear sRGB of a map's colours, by place from 0 to 1.
LinearRgb false_colour(double place) {
  static const std::array<LinearRgb, 256> colours = [] {
    std::array<LinearRgb, 256> linear{};
    const std::array<Rgb8, 256> table = colour_table(ColourMap::inferno);
    std::transform(table.begin(), table.end(), linear.begin(), [](Rgb8 colour) {
      return LinearRgb{srgb_decoded(colour.r / 255.0), srgb_decoded(colour.g / 255.0),
                       srgb_decoded(colour.b / 255.0)};
    });
    return linear;
  }();
  return colours[static_cast<std::size_t>(std::lround(255 * std::clamp(place, 0.0, 1.0)))];
}

const char* display_text(PictureOptions::Display display) {
  return display == PictureOptions::Display::gamma ? "; square roots of levels are shown"
         : display == PictureOptions::Display::log ? "; three decades are shown evenly"
                                                   : "";
}

/// What a level is shown as; 1 is white before and after.
double displayed(double level, PictureOptions::Display display) {
  constexpr double decades = 3;
  if (display == PictureOptions::Display::linear || !(level > 0)) return level;
  if (display == PictureOptions::Display::gamma) return std::sqrt(level);
  return srgb_decoded(std::clamp(1 + std::log10(level) / decades, 0.0, 1.0));
}

double mean_of(const std::vector<float>& levels) {
  double sum = 0;
  for (const float level : levels) sum += level;
  return sum / static_cast<double>(levels.size());
}

void encode_row(std::span<const LinearRgb> pixels, int bits, std::span<std::uint16_t> samples) {
  const auto code = [bits](double linear) {
    const double encoded = srgb_encoded(linear);
    return bits == 8 ? std::uint16_t{quantised_8(encoded)} : quantised_16(encoded);
  };
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    samples[3 * i] = code(pixels[i].r);
    samples[3 * i + 1] = code(pixels[i].g);
    samples[3 * i + 2] = code(pixels[i].b);
  }
}

/// The picture and its insets beside it, on white paper.
PngImage with_insets(const PngImage& picture, const std::vector<PictureInset>& insets) {
  const InsetSheet sheet(picture.columns, picture.rows, insets);
  PngImage beside;
  static_cast<PngLayout&>(beside) = picture;
  beside.columns = sheet.columns();
  beside.rows = sheet.rows();
  const auto white = static_cast<std::uint16_t>(picture.bits == 8 ? 255 : 65535);
  beside.samples.assign(beside.row_samples() * static_cast<std::size_t>(beside.rows), white);
  const std::array<LinearRgb, 1> yellow{{{frame_colour[0], frame_colour[1], frame_colour[2]}}};
  std::array<std::uint16_t, 3> frame{};
  encode_row(yellow, picture.bits, frame);
  auto sample = beside.samples.begin();
  for (int row = 0; row < beside.rows; ++row)
    for (int column = 0; column < beside.columns; ++column, sample += 3) {
      const InsetSheet::Source source = sheet.at(column, row);
      if (source.kind == InsetSheet::Source::Kind::frame) std::ranges::copy(frame, sample);
      if (source.kind != InsetSheet::Source::Kind::picture) continue;
      const auto from =
          picture.samples.begin() +
          static_cast<std::ptrdiff_t>(static_cast<std::size_t>(source.row) * picture.row_samples() +
                                      static_cast<std::size_t>(source.column) * 3);
      std::copy(from, from + 3, sample);
    }
  return beside;
}

/// Rows whose memory is kept before that of all is given back.
constexpr std::size_t rows_kept = 64;

PngLayout layout_of(const SpectralImage& image, const PictureRenderer& renderer, int bits) {
  if (bits != 8 && bits != 16)
    throw InputError(fmt::format("a picture of {} bits; it can have 8 or 16", bits));
  PngLayout layout;
  layout.columns = image.columns();
  layout.rows = image.rows();
  layout.bits = bits;
  layout.text["Software"] = "Petzval";
  layout.text["Exposure"] = renderer.description();
  if (!image.provenance.empty()) layout.text["Description"] = image.provenance;
  return layout;
}

}  // namespace

PictureRenderer::PictureRenderer(const SpectralImage& image, const PictureOptions& options) : image_(image) {
  check(options);
  if (image.bands() == 0) throw InputError("an image without bands cannot be shown");
  image.validate();
  weights_ = level_weights(image.wavelengths_nm(), visible_);
  false_colour_ = !visible_ && options.false_colour;
  display_ = options.display;
  frames_ = options.frames;
  grey_ = !visible_ || (image.bands() == 1 && !options.monochrome_in_colour);
  display_from_xyz_ = srgb_from_xyz();
  if (options.scene_white && !grey_ && image.bands() > 1)
    display_from_xyz_ =
        display_from_xyz_ *
        bradford_adaptation(scene_white_xyz(*options.scene_white, image.wavelengths_nm(), weights_),
                            display_white());

  const auto columns = static_cast<std::size_t>(image.columns());
  std::vector<float> levels(image.band_size());
  parallel_for(static_cast<std::size_t>(image.rows()), [&](std::size_t row) {
    level_row(static_cast<int>(row), std::span<float>(levels).subspan(row * columns, columns));
    if (row % rows_kept == 0) image.release_memory();
  });
  white_level_ = level_for(options, std::move(levels));
}

double PictureRenderer::level_for(const PictureOptions& options, std::vector<float> levels) {
  const char* unit = visible_ ? "lx" : "W/m2";
  const std::size_t all = levels.size();
  levels = without_lamps(levels, image_.lamps);
  const char* beside = levels.size() < all ? " of what is no lamp" : "";
  double level = options.white_level;
  std::string rule = "as asked for";
  if (options.exposure == PictureOptions::Exposure::percentile) {
    std::vector<float> metered = levels;
    const bool lights = leave_lights(metered, options.dark_share);
    level = percentile_of(metered, options.percentile);
    rule = fmt::format("the {}th percentile{}", options.percentile, lights ? " of what is lit" : beside);
  } else if (options.exposure == PictureOptions::Exposure::mean_grey) {
    level = mean_of(levels) / options.grey;
    rule = fmt::format("the mean{} is {} of it", beside, options.grey);
  }
  level *= std::exp2(-options.compensation_ev);
  if (options.compensation_ev != 0) rule += fmt::format(", {:+g} EV", options.compensation_ev);
  if (!(level > 0)) {
    description_ = "no light";
    return 1;
  }
  description_ = fmt::format("white is {:.4g} {}, {}{}", level, unit, rule, display_text(display_));
  if (!false_colour_) return level;
  if (options.exposure == PictureOptions::Exposure::percentile) {
    const double low = level_not_reached(levels, 100 - options.percentile);
    black_level_ = low < level ? low : 0;
  }
  description_ = fmt::format("false colours from {:.4g} to {:.4g} {}, {}", black_level_, level, unit, rule);
  return level;
}

void PictureRenderer::level_row(int row, std::span<float> levels) const {
  std::vector<double> sums(levels.size(), 0.0);
  for (int band = 0; band < image_.bands(); ++band) {
    const double weight = weights_[static_cast<std::size_t>(band)].y;
    const std::span<const float> values =
        image_.band(band).subspan(static_cast<std::size_t>(row) * levels.size(), levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) sums[i] += weight * static_cast<double>(values[i]);
  }
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = static_cast<float>(sums[i]);
}

void PictureRenderer::linear_row(int row, std::span<LinearRgb> pixels) const {
  std::vector<Xyz> sums(pixels.size());
  for (int band = 0; band < image_.bands(); ++band) {
    const Xyz weight = (1 / white_level_) * weights_[static_cast<std::size_t>(band)];
    const std::span<const float> values =
        image_.band(band).subspan(static_cast<std::size_t>(row) * pixels.size(), pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
      sums[i] = sums[i] + static_cast<double>(values[i]) * weight;
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (false_colour_) {
      pixels[i] = false_colour((white_level_ * sums[i].y - black_level_) / (white_level_ - black_level_));
      continue;
    }
    if (sums[i].y > 0) sums[i] = (displayed(sums[i].y, display_) / sums[i].y) * sums[i];
    const Xyz rgb = grey_ ? Xyz{sums[i].y, sums[i].y, sums[i].y} : display_from_xyz_ * sums[i];
    pixels[i] = {rgb.x, rgb.y, rgb.z};
  }
  for (const PictureFrame& frame : frames_)
    for (int column = frame.left; column < std::min(frame.right, image_.columns()); ++column)
      if (frame.is_on_rim(column, row))
        pixels[static_cast<std::size_t>(column)] = {frame_colour[0], frame_colour[1], frame_colour[2]};
}

PngImage srgb_picture(const SpectralImage& image, const PictureOptions& options, int bits) {
  const PictureRenderer renderer(image, options);
  PngImage picture;
  static_cast<PngLayout&>(picture) = layout_of(image, renderer, bits);
  const std::size_t row_samples = picture.row_samples();
  picture.samples.resize(row_samples * static_cast<std::size_t>(picture.rows));
  parallel_for(static_cast<std::size_t>(picture.rows), [&](std::size_t row) {
    std::vector<LinearRgb> pixels(static_cast<std::size_t>(image.columns()));
    renderer.linear_row(static_cast<int>(row), pixels);
    encode_row(pixels, bits,
               std::span<std::uint16_t>(picture.samples).subspan(row * row_samples, row_samples));
  });
  if (!options.insets.empty()) return with_insets(picture, options.insets);
  return picture;
}

std::string write_picture(const std::string& path, const SpectralImage& image, const PictureOptions& options,
                          int bits) {
  if (!options.insets.empty()) {
    const PngImage picture = srgb_picture(image, options, bits);
    write_png(path, picture);
    return picture.text.at("Exposure");
  }
  const PictureRenderer renderer(image, options);
  std::vector<LinearRgb> pixels(static_cast<std::size_t>(image.columns()));
  write_png(path, layout_of(image, renderer, bits), [&](int row, std::span<std::uint16_t> samples) {
    renderer.linear_row(row, pixels);
    encode_row(pixels, bits, samples);
    if (static_cast<std::size_t>(row) % rows_kept == 0) image.release_memory();
  });
  return renderer.description();
}

}  // namespace petzval
