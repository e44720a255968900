// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/version.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/image/picture.h>
#include <petzval/isp/display_picture.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/simulate/develop.h>

#include <algorithm>
#include <string_view>

namespace petzval {

namespace {

/// "0.5,1,0.7", or nothing.
std::optional<std::vector<double>> list_of_numbers(std::string_view text) {
  std::vector<double> values;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::optional<double> value = parse_number(text.substr(from, to - from));
    if (!value) return {};
    values.push_back(*value);
    from = to + 1;
  }
  return values;
}

/// The matrix of the light, fitted to the very sensor.
CameraMatrix fitted_matrix(const Sensor& sensor, const Spectrum& light) {
  CameraMatrix matrix;
  matrix.pcs_from_balanced = calibration(sensor, light, 0, 0).pcs_from_balanced;
  matrix.temperature_k = correlated_temperature_k(chromaticity(Observer::cie_1931().xyz(light)));
  return matrix;
}

void set_white(DevelopOptions& options, const WhiteBalance& white, const RawImage& raw) {
  switch (white.kind) {
    case WhiteBalance::Kind::as_shot:
      return;
    case WhiteBalance::Kind::grey_world:
      options.grey_world = true;
      return;
    case WhiteBalance::Kind::neutral:
      options.neutral = white.neutral;
      return;
    case WhiteBalance::Kind::light:
      if (!white.light) throw InputError("`white_balance` by a light names none; D65 would be one");
      if (!white.sensor) {
        options.neutral = neutral_of_white(raw, Observer::cie_1931().xyz(*white.light));
        return;
      }
      options.neutral = neutral_of(*white.sensor, *white.light);
      options.matrix = fitted_matrix(*white.sensor, *white.light);
      return;
  }
}

}  // namespace

WhiteBalance WhiteBalance::parse(const std::string& text) {
  if (text == "as-shot") return {};
  if (text == "grey-world") return {.kind = Kind::grey_world};
  if (auto numbers = list_of_numbers(text)) return {.kind = Kind::neutral, .neutral = *std::move(numbers)};
  return {.kind = Kind::light, .light = illuminant(text)};
}

Picture develop(const RawImage& raw, const Development& development, const Context& context,
                const DevelopStep& step) {
  DevelopOptions options = development.options;
  if (development.flat) options.flat = &*development.flat;
  if (development.white_balance.sensor && development.white_balance.kind != WhiteBalance::Kind::light)
    throw InputError(
        "`sensor` needs a light to fit the colour matrix to; `white_balance` D65 would be one, for example");
  return result_within(context, [&](const ProgressCallback&) {
    if (raw.channels.size() > 1) set_white(options, development.white_balance, raw);
    Picture picture;
    picture.space = options.space;
    picture.planes = develop_planes(raw, options, &picture.report, step);
    picture.provenance = fmt::format("petzval {} develop: {}", version(), raw.provenance);
    picture.facts = camera_facts(raw);
    return picture;
  });
}

Picture with_insets(const Picture& picture, const std::vector<PictureInset>& insets) {
  const InsetSheet sheet(picture.planes.columns, picture.planes.rows, insets);
  Picture beside = picture;
  beside.facts.lens.warp.clear(), beside.facts.lens.vignetting.clear();  // are those of the frame
  beside.planes.columns = sheet.columns();
  beside.planes.rows = sheet.rows();
  const std::size_t pixels =
      static_cast<std::size_t>(sheet.columns()) * static_cast<std::size_t>(sheet.rows());
  for (std::size_t channel = 0; channel < picture.planes.values.size(); ++channel) {
    const std::vector<float>& from = picture.planes.values[channel];
    std::vector<float>& to = beside.planes.values[channel];
    to.assign(pixels, 1);
    std::size_t at = 0;
    for (int row = 0; row < sheet.rows(); ++row)
      for (int column = 0; column < sheet.columns(); ++column, ++at) {
        const InsetSheet::Source source = sheet.at(column, row);
        if (source.kind == InsetSheet::Source::Kind::picture)
          to[at] =
              from[static_cast<std::size_t>(source.row) * static_cast<std::size_t>(picture.planes.columns) +
                   static_cast<std::size_t>(source.column)];
        else if (source.kind == InsetSheet::Source::Kind::frame)
          to[at] = frame_colour[std::min<std::size_t>(channel, 2)];
      }
  }
  return beside;
}

void write_picture(const std::string& path, const Picture& picture, int bits) {
  write_display_picture(path, picture.planes, picture.space, bits, picture.provenance, picture.facts);
}

}  // namespace petzval
