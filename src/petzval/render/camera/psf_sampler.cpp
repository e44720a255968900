// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/camera/psf_sampler.h>

#include <algorithm>
#include <span>

namespace petzval::render {

namespace {

/// What a box of one spacing takes is its second moment, 1/12, halved by Taylor's series: values less 1/24 of
/// their second difference along each axis.
constexpr float box_moment = 1.0F / 24;

std::vector<float> sharpened(const Psf& psf) {
  std::vector<float> result = psf.values;
  const int last = psf.size - 1;
  for (int i = 0; i <= last; ++i)
    for (int j = 0; j <= last; ++j) {
      const float around = psf.at(std::max(i - 1, 0), j) + psf.at(std::min(i + 1, last), j) +
                           psf.at(i, std::max(j - 1, 0)) + psf.at(i, std::min(j + 1, last));
      float& value = result[static_cast<std::size_t>(i * psf.size + j)];
      value = std::max(0.0F, value - box_moment * (around - 4 * psf.at(i, j)));
    }
  return result;
}

/// Sums up to the end of each entry, over the last of them. \returns that one.
double accumulate(std::span<float> values) {
  double sum = 0;
  for (float& value : values) {
    sum += static_cast<double>(value);
    value = static_cast<float>(sum);
  }
  if (sum > 0)
    for (float& value : values) value = static_cast<float>(static_cast<double>(value) / sum);
  return sum;
}

/// The entry that a number falls into and how far, counted in entries.
double inverted(std::span<const float> sums, double number) {
  const auto above = std::upper_bound(sums.begin(), sums.end() - 1, static_cast<float>(number));
  const double low = above == sums.begin() ? 0 : static_cast<double>(*(above - 1));
  const double share = static_cast<double>(*above) - low;
  const double within = share > 0 ? std::clamp((number - low) / share, 0.0, 1.0) : 0.5;
  return static_cast<double>(above - sums.begin()) + within;
}

}  // namespace

PsfSampler::PsfSampler(const Psf& psf, bool samples)
    : size_(psf.size),
      spacing_um_(psf.spacing_um),
      rows_(static_cast<std::size_t>(psf.size)),
      columns_(samples ? sharpened(psf) : psf.values) {
  const auto size = static_cast<std::size_t>(size_);
  for (std::size_t row = 0; row < size; ++row)
    rows_[row] = static_cast<float>(accumulate(std::span(columns_).subspan(row * size, size)));
  accumulate(rows_);
}

std::array<double, 2> PsfSampler::place(double u, double v) const {
  const auto size = static_cast<std::size_t>(size_);
  const double t = inverted(rows_, v);
  const std::size_t row = std::min(static_cast<std::size_t>(t), size - 1);
  const double s = inverted(std::span(columns_).subspan(row * size, size), u);
  // Sample size/2 is the middle of its cell.
  const double middle = size_ / 2 + 0.5;
  return {(s - middle) * spacing_um_, (t - middle) * spacing_um_};
}

}  // namespace petzval::render
