// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/cell_psf.h>
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/psf_tails.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace petzval {

namespace {

/// 1 to half of the radius, 0 from the radius on, with two continuous derivatives.
double window_at(double distance, double radius) {
  const double x = std::clamp(2 * distance / radius - 1, 0.0, 1.0);
  return std::clamp(1 - x * x * x * (10 + x * (6 * x - 15)), 0.0, 1.0);
}

/// A PSF in two, each of sum 1. \returns the share of the light within the window.
double split(const Psf& whole, double radius_um, Psf& sharp, Psf& tail) {
  sharp = tail = whole;
  double within = 0, beyond = 0;
  for (int i = 0; i < whole.size; ++i)
    for (int j = 0; j < whole.size; ++j) {
      const double distance_um = std::hypot(i - whole.size / 2, j - whole.size / 2) * whole.spacing_um;
      const auto at =
          static_cast<std::size_t>(i) * static_cast<std::size_t>(whole.size) + static_cast<std::size_t>(j);
      const double share = window_at(distance_um, radius_um), light = static_cast<double>(whole.values[at]);
      sharp.values[at] = static_cast<float>(share * light);
      tail.values[at] = static_cast<float>((1 - share) * light);
      within += share * light;
      beyond += (1 - share) * light;
    }
  const auto normalise = [](Psf& psf, double sum, const Psf& instead) {
    if (!(sum > 0)) return void(psf = instead);
    for (float& value : psf.values) value = static_cast<float>(static_cast<double>(value) / sum);
  };
  normalise(sharp, within, whole);
  normalise(tail, beyond, whole);
  return within + beyond > 0 ? within / (within + beyond) : 1;
}

bool reaches_beyond(const LensDataTable& table, double reach_um) {
  return std::ranges::any_of(table.psf, [&](const Psf& psf) {
    return psf.size > 0 && std::sqrt(2.0) * psf.half_width_um() > reach_um &&
           extent_of(psf, 0, 0).reach_um > reach_um;
  });
}

/// Shares of the light at places without a PSF, as PSFs go between those that have one: by the cubics through
/// them, over the frame by the spline.
void fill_shares(const LensDataTable& table, std::vector<double>& shares) {
  const auto inside = [](double share) { return std::clamp(share, 0.0, 1.0); };
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
    std::vector<double> height_mm, known;
    std::optional<LatticeSpline> over_frame;
    if (table.frame)
      over_frame = spline_of_psfs(*table.frame, psf_lattice(table, w),
                                  [&](std::size_t place) { return shares[table.index(place, w)]; });
    for (std::size_t place = 0; !table.frame && place < table.places(); ++place)
      if (const std::size_t entry = table.index(place, w); table.has_psf(entry)) {
        height_mm.push_back(table.real_image_height_mm[entry]);
        known.push_back(shares[entry]);
      }
    for (std::size_t place = 0; place < table.places(); ++place) {
      const std::size_t entry = table.index(place, w);
      if (table.has_psf(entry)) continue;
      if (over_frame) {
        const FramePlaces& frame = *table.frame;
        const std::size_t columns = frame.x_mm.size();
        shares[entry] = inside((*over_frame)(frame.x_mm[place % columns], frame.y_mm[place / columns]));
        continue;
      }
      double share = 0;
      for (const FieldShare& part : field_shares(height_mm, table.real_image_height_mm[entry]))
        share += part.weight * known[part.field];
      shares[entry] = inside(share);
    }
  }
}

/// Where a part has no light, its PSF is that of the next place outwards that has some: between the two,
/// light is spread as there.
void borrow_tails(LensDataTable& tails, const std::vector<double>& shares) {
  constexpr double no_light = 1e-8;
  for (std::size_t w = 0; w < tails.wavelengths_nm.size(); ++w) {
    const Psf* last = nullptr;
    for (std::size_t place = tails.places(); place-- > 0;) {
      const std::size_t entry = tails.index(place, w);
      if (!tails.has_psf(entry)) continue;
      if (1 - shares[entry] > no_light)
        last = &tails.psf[entry];
      else if (last)
        tails.psf[entry] = *last;
    }
  }
}

/// A parabola's weights of a coarse pixel and its neighbours in its mean over a part of the coarse pixel.
/// \param t  the part's middle, from −½ to ½. \param width  of the part, at most 1.
std::array<double, 3> parabola(double t, double width) {
  const double bend = (t * t - (1 - width * width) / 12) / 2;
  return {bend - t / 2, 1 - 2 * bend, bend + t / 2};
}

/// By which coarse pixels, from the first of three on, a pixel's light goes along one side; beyond the border
/// light goes on straight.
struct Share {
  std::size_t first = 0;
  std::array<double, 3> weights{};
};

std::vector<Share> shares_along(int pixels, int coarse, int of_pixels) {
  std::vector<Share> shares;
  const double margin = 0.5 * (double(coarse) * of_pixels - pixels);
  for (int i = 0; i < pixels; ++i) {
    const double place = (i + 0.5 + margin) / of_pixels;
    const int pixel = std::clamp(static_cast<int>(place), 0, coarse - 1);
    std::array<double, 3> w = parabola(place - pixel - 0.5, 1.0 / of_pixels);
    if (coarse < 3) {
      shares.push_back({0, {}});
      shares.back().weights[static_cast<std::size_t>(pixel)] = 1;
      continue;
    }
    // Beyond the border the next value is twice the last less the one before.
    if (pixel == 0) w = {w[1] + 2 * w[0], w[2] - w[0], 0};
    if (pixel == coarse - 1) w = {0, w[0] - w[2], w[1] + 2 * w[2]};
    shares.push_back({static_cast<std::size_t>(std::clamp(pixel - 1, 0, coarse - 3)), w});
  }
  return shares;
}

}  // namespace

std::optional<TailSplit> split_tails(const LensDataTable& table, double radius_um) {
  if (!reaches_beyond(table, 2 * radius_um)) return {};
  TailSplit parts{table, table};
  std::vector<double> shares(table.psf.size(), 1);
  for (std::size_t entry = 0; entry < table.psf.size(); ++entry)
    if (table.has_psf(entry))
      shares[entry] = split(table.psf[entry], radius_um, parts.sharp.psf[entry], parts.tails.psf[entry]);
  fill_shares(table, shares);
  // A table is dark nowhere on the axis.
  constexpr double least_tail = 1e-9;
  for (double& share : shares) share = std::min(share, 1 - least_tail);
  for (std::size_t entry = 0; entry < table.psf.size(); ++entry) {
    parts.sharp.g_source_sr[entry] *= shares[entry];
    parts.sharp.g_sensor_sr[entry] *= shares[entry];
    parts.tails.g_source_sr[entry] *= 1 - shares[entry];
    parts.tails.g_sensor_sr[entry] *= 1 - shares[entry];
  }
  borrow_tails(parts.tails, shares);
  return parts;
}

double tail_strength(const TailSplit& split) {
  const auto& [sharp, tails] = split;
  double strength = 0;
  for (std::size_t w = 0; w < tails.wavelengths_nm.size(); ++w) {
    double of_tails = 0, of_all = 0;
    for (std::size_t place = 0; place < tails.places(); ++place) {
      const std::size_t entry = tails.index(place, w);
      // Of a centred lens, places of equal steps in height stand for rings.
      const double area = tails.frame ? 1 : tails.real_image_height_mm[entry];
      const double tail = tails.g_source_sr[entry], all = tail + sharp.g_source_sr[entry];
      of_tails += area * tail * tail;
      of_all += area * all * all;
    }
    if (of_all > 0) strength = std::max(strength, std::sqrt(of_tails / of_all));
  }
  return strength;
}

std::optional<TailSplit> split_table(const LensDataTable& table, const SensorGeometry& sensor,
                                     const ImagingOptions& options) {
  if (options.method != BlurMethod::product || options.tail_pixels == 0) return {};
  return split_tails(table, options.tail_pixels * sensor.pitch_um);
}

int tail_coarseness(int tail_pixels) {
  return std::max(2, tail_pixels / 16);
}

SensorGeometry coarse_frame(const SensorGeometry& frame, int of_pixels) {
  const auto covering = [&](int pixels) { return (pixels + of_pixels - 1) / of_pixels; };
  return {covering(frame.columns), covering(frame.rows), frame.pitch_um * of_pixels};
}

void add_coarse(std::span<const float> coarse, const SensorGeometry& coarse_grid, int of_pixels,
                RowRange rows, const SensorGeometry& frame, std::span<float> pixels) {
  const std::vector<Share> across = shares_along(frame.columns, coarse_grid.columns, of_pixels),
                           down = shares_along(frame.rows, coarse_grid.rows, of_pixels);
  const auto columns = static_cast<std::size_t>(coarse_grid.columns);
  std::vector<double> line(std::max<std::size_t>(columns, 3));
  for (int row = std::max(0, rows.first); row < std::min(frame.rows, rows.end); ++row) {
    const Share& y = down[static_cast<std::size_t>(row)];
    std::ranges::fill(line, 0.0);
    for (std::size_t k = 0; k < 3; ++k)
      if (y.weights[k] != 0)
        for (std::size_t i = 0; i < columns; ++i)
          line[i] += y.weights[k] * static_cast<double>(coarse[(y.first + k) * columns + i]);
    for (std::size_t column = 0; column < across.size(); ++column) {
      const auto& [first, weights] = across[column];
      double light = 0;
      for (std::size_t k = 0; k < 3; ++k) light += weights[k] * line[first + k];
      float& pixel = pixels[static_cast<std::size_t>(row) * across.size() + column];
      pixel += static_cast<float>(std::max(0.0, light));
    }
  }
}

}  // namespace petzval
