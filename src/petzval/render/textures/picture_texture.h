// SPDX-License-Identifier: BSD-3-Clause
// Textures from pictures.
#pragma once

#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/render/spectra/wavelength_groups.h>
#include <petzval/render/textures/picture_file.h>
#include <petzval/render/textures/texture.h>

#include <array>
#include <cstdint>

namespace petzval::render {

/// What happens outside of the picture.
enum class PictureWrap { repeat, black, clamp, mirror };

/// A picture that is asked at (s, t) in [0, 1]², t upwards; linear between pixel centres.
class PictureSampler {
 public:
  PictureSampler(std::shared_ptr<const PictureFile> picture, PictureWrap wrap, bool linear)
      : picture_(std::move(picture)), wrap_(wrap), linear_(linear) {}
  int channels() const { return picture_->channels; }
  int width() const { return picture_->width; }
  int height() const { return picture_->height; }
  /// The first is repeated for a picture of one channel.
  std::array<double, 3> at(double s, double t) const;

 private:
  void add_pixel(double weight, std::int64_t column, std::int64_t row, std::array<double, 3>& sum) const;

  std::shared_ptr<const PictureFile> picture_;
  PictureWrap wrap_;
  bool linear_;
};

struct PictureTextureOptions {
  TextureMapping mapping;
  double scale = 1;
  bool invert = false;
};

class FloatPicture final : public Texture<double> {
 public:
  FloatPicture(PictureSampler picture, PictureTextureOptions options)
      : picture_(std::move(picture)), options_(std::move(options)) {}
  double at(const TexturePoint& point, int group) const override;
  /// Half a pixel: slopes then change steadily between pixels.
  double fineness() const override;

 private:
  PictureSampler picture_;
  PictureTextureOptions options_;
};

/// Colours become reflectances by Jakob & Hanika's sigmoids, which lie in [0, 1].
class SpectrumPicture final : public Texture<Lanes> {
 public:
  SpectrumPicture(PictureSampler picture, PictureTextureOptions options, const WavelengthGroups& groups,
                  std::shared_ptr<const ReflectanceTable> table)
      : picture_(std::move(picture)),
        options_(std::move(options)),
        groups_(groups),
        table_(std::move(table)) {}
  Lanes at(const TexturePoint& point, int group) const override;

 private:
  PictureSampler picture_;
  PictureTextureOptions options_;
  WavelengthGroups groups_;
  std::shared_ptr<const ReflectanceTable> table_;
};

}  // namespace petzval::render
