// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/render/textures/picture_texture.h>

#include <algorithm>

namespace petzval::render {

void TextureMapping::coordinates(const TexturePoint& point, double& s, double& t) const {
  if (kind == Kind::planar) {
    const Vector3 p = texture_from_world.point(point.world);
    s = dot(p, axis_s) + offset_u;
    t = dot(p, axis_t) + offset_v;
    return;
  }
  if (kind == Kind::spherical || kind == Kind::cylindrical) {
    const Vector3 p = texture_from_world.point(point.world);
    const double azimuth = std::atan2(p.y, p.x);
    if (kind == Kind::cylindrical) {
      s = (pi + azimuth) / (2 * pi), t = p.z;
      return;
    }
    s = std::atan2(std::hypot(p.x, p.y), p.z) / pi;
    t = (azimuth < 0 ? azimuth + 2 * pi : azimuth) / (2 * pi);
    return;
  }
  s = scale_u * point.u + s_from_v * point.v + offset_u;
  t = scale_v * point.v + t_from_u * point.u + offset_v;
}

namespace {

/// Every second picture the other way round.
std::int64_t mirrored(std::int64_t at, int size) {
  const std::int64_t within = (at % (2 * size) + 2 * size) % (2 * size);
  return within < size ? within : 2 * size - 1 - within;
}

}  // namespace

void PictureSampler::add_pixel(double weight, std::int64_t column, std::int64_t row,
                               std::array<double, 3>& sum) const {
  const int width = picture_->width, height = picture_->height;
  if (wrap_ == PictureWrap::repeat) {
    column = (column % width + width) % width;
    row = (row % height + height) % height;
  } else if (wrap_ == PictureWrap::clamp) {
    column = std::clamp<std::int64_t>(column, 0, width - 1);
    row = std::clamp<std::int64_t>(row, 0, height - 1);
  } else if (wrap_ == PictureWrap::mirror) {
    column = mirrored(column, width);
    row = mirrored(row, height);
  } else if (column < 0 || column >= width || row < 0 || row >= height) {
    return;
  }
  const float* pixel = picture_->pixel(static_cast<int>(column), static_cast<int>(row));
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] += weight * static_cast<double>(pixel[picture_->channels == 3 ? c : 0]);
}

std::array<double, 3> PictureSampler::at(double s, double t) const {
  std::array<double, 3> sum{};
  // Far outside, the place in the picture is lost to rounding anyway.
  if (!(std::abs(s) < 1e6 && std::abs(t) < 1e6)) return sum;
  const double x = s * picture_->width, y = (1 - t) * picture_->height;
  if (!linear_) {
    add_pixel(1, static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y)), sum);
    return sum;
  }
  const double column = std::floor(x - 0.5), row = std::floor(y - 0.5);
  const double dx = x - 0.5 - column, dy = y - 0.5 - row;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      add_pixel((i ? dx : 1 - dx) * (j ? dy : 1 - dy), static_cast<std::int64_t>(column) + i,
                static_cast<std::int64_t>(row) + j, sum);
  return sum;
}

namespace {

std::array<double, 3> colour_at(const PictureSampler& picture, const PictureTextureOptions& options,
                                const TexturePoint& point) {
  double s, t;
  options.mapping.coordinates(point, s, t);
  std::array<double, 3> rgb = picture.at(s, t);
  for (double& value : rgb) {
    value *= options.scale;
    if (options.invert) value = std::max(0.0, 1 - value);
  }
  return rgb;
}

}  // namespace

double FloatPicture::at(const TexturePoint& point, int) const {
  const std::array<double, 3> rgb = colour_at(picture_, options_, point);
  return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

double FloatPicture::fineness() const {
  const TextureMapping& mapping = options_.mapping;
  if (mapping.kind != TextureMapping::Kind::uv) return Texture::fineness();
  const double columns = picture_.width() * std::hypot(mapping.scale_u, mapping.s_from_v),
               rows = picture_.height() * std::hypot(mapping.scale_v, mapping.t_from_u);
  // Not so fine that differences of u are lost in it, nor coarser than a tenth of the surface.
  return std::clamp(0.5 / std::max(columns, rows), 1e-6, 0.1);
}

Lanes SpectrumPicture::at(const TexturePoint& point, int group) const {
  const std::array<double, 3> rgb = colour_at(picture_, options_, point);
  const auto& tint = point.tint;
  const SigmoidReflectance reflectance = (*table_)({rgb[0] * tint[0], rgb[1] * tint[1], rgb[2] * tint[2]});
  Lanes result;
  for (int i = 0; i < lane_count; ++i)
    result[i] = static_cast<float>(reflectance.at(groups_.wavelength_nm(group, i)));
  return result;
}

}  // namespace petzval::render
