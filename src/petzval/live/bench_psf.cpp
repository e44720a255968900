// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/live/bench_psf.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace petzval {

namespace {

/// Where the colour of a wavelength goes.
std::size_t shown_channel(double wavelength_nm) {
  constexpr double red_from_nm = 590, blue_to_nm = 500;
  return wavelength_nm > red_from_nm ? 0 : wavelength_nm < blue_to_nm ? 2 : 1;
}

/// Adds one PSF to a channel, moved by a part of a cell along the field.
void add_shifted(const PsfStack& stack, std::size_t wavelength, double shift_cells, std::size_t channel,
                 std::vector<float>& rgb) {
  const int size = stack.size;
  const float* const cells = stack.values.data() + wavelength * stack.psf_cells();
  const double whole = std::floor(shift_cells);
  const auto part = static_cast<float>(shift_cells - whole);
  for (int t = 0; t < size; ++t) {
    for (int s = 0; s < size; ++s) {
      const float value = cells[t * size + s];
      for (const int step : {0, 1}) {
        const int to = t + static_cast<int>(whole) + step;
        if (to < 0 || to >= size) continue;
        const int row = size - 1 - to;  // t grows upwards
        const std::size_t at = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                                    static_cast<std::size_t>(s)) +
                               channel;
        rgb[at] += value * (step == 0 ? 1 - part : part);
      }
    }
  }
}

}  // namespace

FieldTableRequest field_at(const CoatedLens& coated, const std::array<double, 2>& place_mm) {
  FieldTableRequest at;
  at.field_kind = Fields::Kind::real_image_height_mm;
  at.fields = {std::hypot(place_mm[0], place_mm[1])};
  at.wavelengths_nm = coated.lens.wavelengths_nm;
  at.losses = coated.losses;
  // The real image is the upright picture turned by half a turn; its azimuth counts from +y anticlockwise.
  at.azimuth_deg = at.fields[0] > 0 ? std::atan2(place_mm[0], -place_mm[1]) * 180 / std::numbers::pi : 0;
  return at;
}

BenchPsf bench_psf(const CoatedLens& coated, const std::array<double, 2>& place_mm, const Context& context) {
  const Lens& lens = coated.lens;
  const FieldTableRequest at = field_at(coated, place_mm);
  BenchPsf result;
  result.height_mm = at.fields[0];
  result.azimuth_deg = at.azimuth_deg;
  PsfOptions options;
  options.largest_size = 96;
  const PsfStack stack = psf_stack(lens, at, options, context);
  result.size = stack.size;
  result.spacing_um = stack.spacing_um;
  result.captured = *std::ranges::min_element(stack.captured);
  result.rgb.assign(3 * stack.psf_cells(), 0);
  std::size_t counts[3] = {0, 0, 0}, reference = 0;
  for (std::size_t w = 0; w < stack.wavelengths_nm.size(); ++w) {
    ++counts[shown_channel(stack.wavelengths_nm[w])];
    if (std::abs(stack.wavelengths_nm[w] - lens.reference_wavelength_nm) <
        std::abs(stack.wavelengths_nm[reference] - lens.reference_wavelength_nm))
      reference = w;
  }
  constexpr double um_per_mm = 1000;
  const bool grey = std::ranges::count(counts, std::size_t{0}) > 0;
  for (std::size_t w = 0; w < stack.wavelengths_nm.size(); ++w) {
    const double shift =
        (stack.image_height_mm[w] - stack.image_height_mm[reference]) * um_per_mm / stack.spacing_um;
    for (std::size_t channel = 0; channel < 3; ++channel)
      if (grey || channel == shown_channel(stack.wavelengths_nm[w]))
        add_shifted(stack, w, shift, channel, result.rgb);
  }
  if (!grey)
    for (std::size_t i = 0; i < result.rgb.size(); ++i) result.rgb[i] /= static_cast<float>(counts[i % 3]);
  return result;
}

std::vector<std::uint8_t> float_bytes(const std::vector<float>& values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * sizeof(float));
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
  return bytes;
}

}  // namespace petzval
