// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/render/lights/environment.h>
#include <petzval/render/lights/light_pattern.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval::render {

namespace {

std::array<double, 3> colour_of(const PictureFile& picture, int column, int row) {
  const float* p = picture.pixel(column, row);
  std::array<double, 3> rgb;
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = std::max(0.0, static_cast<double>(p[picture.channels == 1 ? 0 : c]));
  return rgb;
}

/// Which of `count` pixels holds a place from 0 to 1.
int pixel_at(double place, int count) {
  return std::clamp(static_cast<int>(place * count), 0, count - 1);
}

class Projected final : public LightPattern {
 public:
  Projected(const PictureFile& picture, double field_of_view_deg, const WavelengthGroups& groups,
            const Transform& world_from_light)
      : width_(picture.width), height_(picture.height), groups_(groups), world_from_light_(world_from_light) {
    const double half = std::tan(radians(field_of_view_deg) / 2);
    const int shorter = std::min(width_, height_);
    half_width_ = half * width_ / shorter, half_height_ = half * height_ / shorter;
    const ReflectanceTable table;
    for (int row = 0; row < height_; ++row) {
      check_stop();
      for (int column = 0; column < width_; ++column) {
        const auto [r, g, b] = colour_of(picture, column, row);
        const double scale = 2 * std::max({r, g, b});
        Pixel pixel{{}, static_cast<float>(scale)};
        if (scale > 0) pixel.shape = table({r / scale, g / scale, b / scale});
        pixels_.push_back(pixel);
        emitted_sr_ +=
            luminance({r, g, b}) * solid_angle(through(column * 1.0 / width_, row * 1.0 / height_),
                                               through((column + 1.0) / width_, (row + 1.0) / height_));
        mean_ += (r + g + b) / 3 / (static_cast<double>(width_) * height_);
      }
    }
  }

  Lanes share(Vector3 direction, int group) const override {
    const Vector3 way = world_from_light_.inverse_direction(direction);
    if (!(way.z > 0)) return Lanes::all(0);
    const double x = (way.x / way.z / half_width_ + 1) / 2, y = (1 - way.y / way.z / half_height_) / 2;
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return Lanes::all(0);
    const Pixel& pixel =
        pixels_[static_cast<std::size_t>(pixel_at(y, height_)) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(pixel_at(x, width_))];
    Lanes result;
    for (int i = 0; i < lane_count; ++i)
      result[i] = pixel.scale * static_cast<float>(pixel.shape.at(groups_.wavelength_nm(group, i)));
    return result;
  }

  double emitted_sr() const override { return emitted_sr_; }

  LightBounds bounds() const override {
    LightBounds bounds;
    bounds.axis = normalised(world_from_light_.direction({0, 0, 1}));
    for (const double x : {0.0, 1.0})
      for (const double y : {0.0, 1.0}) {
        const Vector3 corner = normalised(world_from_light_.direction(through(x, y)));
        bounds.spread = std::max(bounds.spread, std::acos(std::clamp(dot(corner, bounds.axis), -1.0, 1.0)));
      }
    constexpr double roundings = 1e-6;
    bounds.spread = std::min(bounds.spread + roundings, pi);
    bounds.strength = mean_;
    return bounds;
  }

 private:
  struct Pixel {
    SigmoidReflectance shape;
    float scale;
  };
  static double luminance(const std::array<double, 3>& rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];  // IEC 61966-2-1
  }
  /// Of a rectangle at z = 1 between two corners.
  static double solid_angle(Vector3 a, Vector3 b) {
    const auto from_axis = [](double x, double y) { return std::atan(x * y / std::sqrt(1 + x * x + y * y)); };
    return std::abs(from_axis(b.x, b.y) - from_axis(a.x, b.y) - from_axis(b.x, a.y) + from_axis(a.x, a.y));
  }
  /// The direction, with z = 1, through a place of the slide, from 0 to 1, from its top left corner.
  Vector3 through(double x, double y) const {
    return {(2 * x - 1) * half_width_, (1 - 2 * y) * half_height_, 1};
  }

  int width_, height_;
  double half_width_, half_height_;  ///< of the slide at distance 1
  std::vector<Pixel> pixels_;
  WavelengthGroups groups_;
  Transform world_from_light_;
  double emitted_sr_ = 0, mean_ = 0;
};

class Goniometric final : public LightPattern {
 public:
  Goniometric(const PictureFile& picture, const Transform& world_from_light)
      : side_(picture.width), world_from_light_(world_from_light) {
    for (int row = 0; row < side_; ++row)
      for (int column = 0; column < side_; ++column) {
        const auto [r, g, b] = colour_of(picture, column, row);
        values_.push_back(static_cast<float>((r + g + b) / 3));
        mean_ += (r + g + b) / 3 / (static_cast<double>(side_) * side_);
      }
  }

  Lanes share(Vector3 direction, int) const override {
    const Vector3 way = normalised(world_from_light_.inverse_direction(direction));
    double u, v;
    square_from_sphere({way.x, way.z, way.y}, u, v);
    return Lanes::all(static_cast<double>(
        values_[static_cast<std::size_t>(pixel_at(v, side_)) * static_cast<std::size_t>(side_) +
                static_cast<std::size_t>(pixel_at(u, side_))]));
  }

  double emitted_sr() const override { return 4 * pi * mean_; }

  LightBounds bounds() const override {
    LightBounds bounds;
    bounds.spread = pi;
    bounds.strength = mean_;
    return bounds;
  }

 private:
  int side_;
  std::vector<float> values_;
  Transform world_from_light_;
  double mean_ = 0;
};

}  // namespace

std::shared_ptr<const LightPattern> projected_pattern(const PictureFile& picture, double field_of_view_deg,
                                                      const WavelengthGroups& groups,
                                                      const Transform& world_from_light) {
  return std::make_shared<const Projected>(picture, field_of_view_deg, groups, world_from_light);
}

std::shared_ptr<const LightPattern> goniometric_pattern(const PictureFile& picture,
                                                        const Transform& world_from_light) {
  return std::make_shared<const Goniometric>(picture, world_from_light);
}

}  // namespace petzval::render
