// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/render/media/colour_grid.h>

#include <algorithm>
#include <optional>

namespace petzval::render {

namespace {

/// Up to so many cells a fit for each is sooner done than the table.
constexpr std::size_t few = 30000;

}  // namespace

ColourSamples::ColourSamples(const std::array<int, 3>& cells, const std::vector<double>& rgb,
                             BandSpectrum white, const WavelengthGroups& groups)
    : size_{cells}, white_(std::move(white)), wavelengths_nm_(groups.sampled([](double nm) { return nm; })) {
  std::optional<ReflectanceTable> table;
  if (rgb.size() / 3 > few) table.emplace();
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    if (i % 3072 == 0) check_stop();
    Colour colour{{}, 2 * std::max({rgb[i], rgb[i + 1], rgb[i + 2]})};
    if (colour.scale > 0) {
      const LinearRgb of_one{rgb[i] / colour.scale, rgb[i + 1] / colour.scale, rgb[i + 2] / colour.scale};
      colour.shape = table ? (*table)(of_one) : reflectance_of(of_one);
    }
    colours_.push_back(colour);
  }
}

Lanes ColourSamples::of(const Colour& colour, int group) const {
  const auto at = static_cast<std::size_t>(group);
  Lanes result;
  for (int lane = 0; lane < lane_count; ++lane)
    result[lane] =
        white_[at][lane] *
        static_cast<float>(colour.scale * colour.shape.at(static_cast<double>(wavelengths_nm_[at][lane])));
  return result;
}

Lanes ColourSamples::at(const UnitPlace& place, int group) const {
  Lanes sum = Lanes::all(0);
  size_.each_about(place, [&](std::size_t index, double weight) {
    if (colours_[index].scale > 0) sum += weight * of(colours_[index], group);
  });
  return sum;
}

double ColourSamples::greatest(std::size_t cell) const {
  float most = 0;
  for (std::size_t group = 0; group < white_.size(); ++group)
    most = std::max(most, of(colours_[cell], static_cast<int>(group)).largest());
  return static_cast<double>(most);
}

}  // namespace petzval::render
