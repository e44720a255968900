// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/denoise_picture.h>
#include <petzval/render/film/denoise.h>

namespace petzval::render {

namespace {

/// Means of one half from the sums of all samples and of the second half.
class HalfMeans {
 public:
  /// \param samples  of the half, in each group of wavelengths.
  HalfMeans(const Film& film, bool second, double samples, std::size_t groups)
      : film_(film), second_(second), samples_(samples), groups_(groups), pixels_(film.window.size()) {}

  std::vector<float> light() const {
    const std::size_t bands = film_.light.size() / pixels_;
    std::vector<float> result(film_.light.size());
    for (std::size_t band = 0; band < bands; ++band)
      for (std::size_t i = 0; i < pixels_; ++i)
        result[i * bands + band] = mean(film_.light, film_.half, 0, band * pixels_ + i);
    return result;
  }

  /// In the order of PictureHalves::feature_count; rays that meet nothing count as 0.
  std::vector<float> features() const {
    const std::size_t bands = film_.albedo.size() / pixels_, ranges = 3;
    const std::size_t depths = groups_ * pixels_, normals = depths + pixels_, albedos = normals + 3 * pixels_;
    std::vector<float> result(PictureHalves::feature_count * pixels_, 0.0f);
    for (std::size_t i = 0; i < pixels_; ++i) {
      for (std::size_t range = 0; range < ranges; ++range) {
        const std::size_t from = bands * range / ranges, to = bands * (range + 1) / ranges;
        for (std::size_t band = from; band < to; ++band)
          result[range * pixels_ + i] += mean(film_.albedo, film_.half_first, albedos, band * pixels_ + i) /
                                         static_cast<float>(to - from);
      }
      for (std::size_t axis = 0; axis < 3; ++axis)
        result[(ranges + axis) * pixels_ + i] =
            mean(film_.normal, film_.half_first, normals, axis * pixels_ + i) / static_cast<float>(groups_);
      float met = 0;
      for (std::size_t group = 0; group < groups_; ++group)
        met += mean(film_.met, film_.half_first, 0, group * pixels_ + i);
      const float depth = mean(film_.depth, film_.half_first, depths, i);
      if (depth > 0) result[(ranges + 3) * pixels_ + i] = met * met / (depth * static_cast<float>(groups_));
    }
    return result;
  }

 private:
  float mean(const std::vector<ExactSum>& all, const std::vector<ExactSum>& half, std::size_t first,
             std::size_t at) const {
    const double second = half[first + at].value();
    return static_cast<float>((second_ ? second : all[at].value() - second) / samples_);
  }

  const Film& film_;
  bool second_;
  double samples_;
  std::size_t groups_, pixels_;
};

}  // namespace

void denoise_picture(const Film& film, const WavelengthGroups& groups, const Passes& passes,
                     Rendering& picture) {
  if (film.passes < 2) return;
  SpectralImage& light = picture.irradiance;
  PictureHalves halves{light.columns(), light.rows(), light.bands(), {}};
  const auto count = static_cast<std::size_t>(groups.count());
  for (int second = 0; second < 2; ++second) {
    const int taken = second == 1 ? film.passes / 2 : film.passes - film.passes / 2;
    const HalfMeans means(film, second == 1, taken * passes.samples_a_pass() / groups.count(), count);
    halves.halves[static_cast<std::size_t>(second)] = {means.light(), means.features()};
  }
  const std::vector<float> smooth = denoised(halves);
  const auto bands = static_cast<std::size_t>(light.bands());
  for (std::size_t band = 0; band < bands; ++band) {
    const std::span<float> plane = light.band(static_cast<int>(band));
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = smooth[i * bands + band];
  }
  picture.denoised = true;
}

}  // namespace petzval::render
