// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/filters.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

std::vector<float> gaussian(double sigma) {
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  std::vector<float> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    sum += static_cast<double>(weights.back());
  }
  for (float& weight : weights) weight /= static_cast<float>(sum);
  return weights;
}

/// Blurs along columns or along rows; the edge pixel is repeated.
std::vector<float> blurred(const std::vector<float>& plane, int columns, int rows,
                           const std::vector<float>& weights, bool across) {
  std::vector<float> result(plane.size());
  const int radius = static_cast<int>(weights.size()) / 2;
  parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
    for (int c = 0; c < columns; ++c) {
      float sum = 0;
      for (int k = -radius; k <= radius; ++k) {
        const int r = across ? static_cast<int>(row) : std::clamp(static_cast<int>(row) + k, 0, rows - 1);
        const int from = across ? std::clamp(c + k, 0, columns - 1) : c;
        sum += weights[static_cast<std::size_t>(k + radius)] *
               plane[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(from)];
      }
      result[row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)] = sum;
    }
  });
  return result;
}

}  // namespace

void sharpen(Planes& planes, double amount, double sigma_px) {
  constexpr double greatest_px = 50;
  if (!(sigma_px > 0 && sigma_px <= greatest_px))
    throw InputError(fmt::format("a sharpening radius of {:g} pixels; above 0 and up to {:g} would be right",
                                 sigma_px, greatest_px));
  const std::vector<float> weights = gaussian(sigma_px);
  for (std::vector<float>& plane : planes.values) {
    const std::vector<float> smooth = blurred(blurred(plane, planes.columns, planes.rows, weights, true),
                                              planes.columns, planes.rows, weights, false);
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] += static_cast<float>(amount) * (plane[i] - smooth[i]);
  }
}

double automatic_exposure_ev(const Planes& rgb) {
  constexpr int side = 4;
  constexpr double share = 0.99, most_ev = 16;
  const int across = std::max(1, rgb.columns / side), down = std::max(1, rgb.rows / side);
  std::vector<float> levels(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  parallel_for(static_cast<std::size_t>(down), [&](std::size_t block_row) {
    for (int block = 0; block < across; ++block) {
      const int top = static_cast<int>(block_row) * side, left = block * side;
      const int bottom = std::min(top + side, rgb.rows), right = std::min(left + side, rgb.columns);
      float most = 0;
      for (const std::vector<float>& plane : rgb.values) {
        float sum = 0;
        for (int r = top; r < bottom; ++r)
          for (int c = left; c < right; ++c)
            sum += plane[static_cast<std::size_t>(r) * static_cast<std::size_t>(rgb.columns) +
                         static_cast<std::size_t>(c)];
        most = std::max(most, sum / static_cast<float>((bottom - top) * (right - left)));
      }
      levels[block_row * static_cast<std::size_t>(across) + static_cast<std::size_t>(block)] = most;
    }
  });
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(levels.size()))) - 1;
  const auto nth = levels.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(levels.begin(), nth, levels.end());
  if (!(*nth > 0)) return 0;
  return std::clamp(-std::log2(static_cast<double>(*nth)), -most_ev, most_ev);
}

void apply_tone(Planes& rgb, double exposure_ev, ToneCurve curve) {
  const auto gain = static_cast<float>(std::exp2(exposure_ev));
  const auto columns = static_cast<std::size_t>(rgb.columns);
  constexpr float knee = 0.5f;
  const float white = std::max(1.0f, gain), steepness = (white - knee) / (1 - knee);
  parallel_for(static_cast<std::size_t>(rgb.rows), [&](std::size_t row) {
    float* p[3] = {rgb.values[0].data() + row * columns, rgb.values[1].data() + row * columns,
                   rgb.values[2].data() + row * columns};
    for (std::size_t c = 0; c < columns; ++c) {
      for (float* plane : p) plane[c] = std::max(0.0f, gain * plane[c]);
      const float most = std::max({p[0][c], p[1][c], p[2][c]});
      if (curve == ToneCurve::none || most <= knee) continue;
      // Slope 1 at the knee, 1 where white has come to.
      const float t = std::min(1.0f, (most - knee) / (white - knee));
      const float out = knee + (1 - knee) * steepness * t / (1 + (steepness - 1) * t);
      for (float* plane : p) plane[c] *= out / most;
    }
  });
}

}  // namespace petzval
