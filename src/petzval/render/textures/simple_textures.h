// SPDX-License-Identifier: BSD-3-Clause
// Textures made of numbers and of other textures.
#pragma once

#include <petzval/render/spectra/wavelength_groups.h>
#include <petzval/render/textures/texture.h>

#include <algorithm>
#include <utility>

namespace petzval::render {

class ConstantFloat final : public Texture<double> {
 public:
  explicit ConstantFloat(double value) : value_(value) {}
  double at(const TexturePoint&, int) const override { return value_; }
  bool is_constant() const override { return true; }
  double fineness() const override { return 1; }

 private:
  double value_;
};

class ConstantSpectrum final : public Texture<Lanes> {
 public:
  explicit ConstantSpectrum(BandSpectrum value) : value_(std::move(value)) {}
  Lanes at(const TexturePoint&, int group) const override { return value_[static_cast<std::size_t>(group)]; }
  bool is_constant() const override { return true; }

 private:
  BandSpectrum value_;
};

class SameForAllWavelengths final : public Texture<Lanes> {
 public:
  explicit SameForAllWavelengths(FloatTexture texture) : texture_(std::move(texture)) {}
  Lanes at(const TexturePoint& point, int group) const override {
    return Lanes::all(texture_->at(point, group));
  }
  double fineness() const override { return texture_->fineness(); }

 private:
  FloatTexture texture_;
};

/// Two textures in squares of one unit of (s, t), or in cubes of one unit of the texture's space.
template <class Value>
class Checkerboard final : public Texture<Value> {
 public:
  using Part = std::shared_ptr<const Texture<Value>>;
  Checkerboard(Part first, Part second, TextureMapping mapping, bool solid)
      : first_(std::move(first)), second_(std::move(second)), mapping_(std::move(mapping)), solid_(solid) {}

  Value at(const TexturePoint& point, int group) const override {
    double sum;
    if (solid_) {
      const Vector3 p = mapping_.texture_from_world.point(point.world);
      sum = std::floor(p.x) + std::floor(p.y) + std::floor(p.z);
    } else {
      double s, t;
      mapping_.coordinates(point, s, t);
      sum = std::floor(s) + std::floor(t);
    }
    return (std::fmod(sum, 2) == 0 ? first_ : second_)->at(point, group);
  }

 private:
  Part first_, second_;
  TextureMapping mapping_;
  bool solid_;
};

/// A texture times a number that varies.
template <class Value>
class ScaledTexture final : public Texture<Value> {
 public:
  ScaledTexture(std::shared_ptr<const Texture<Value>> texture, FloatTexture scale)
      : texture_(std::move(texture)), scale_(std::move(scale)) {}
  Value at(const TexturePoint& point, int group) const override {
    return scale_->at(point, group) * texture_->at(point, group);
  }
  double fineness() const override { return std::min(texture_->fineness(), scale_->fineness()); }

 private:
  std::shared_ptr<const Texture<Value>> texture_;
  FloatTexture scale_;
};

/// (1 − amount) of the first and `amount` of the second.
template <class Value>
class MixedTexture final : public Texture<Value> {
 public:
  using Part = std::shared_ptr<const Texture<Value>>;
  MixedTexture(Part first, Part second, FloatTexture amount)
      : first_(std::move(first)), second_(std::move(second)), amount_(std::move(amount)) {}
  Value at(const TexturePoint& point, int group) const override {
    const double amount = amount_->at(point, group);
    return (1 - amount) * first_->at(point, group) + amount * second_->at(point, group);
  }
  double fineness() const override {
    return std::min({first_->fineness(), second_->fineness(), amount_->fineness()});
  }

 private:
  Part first_, second_;
  FloatTexture amount_;
};

}  // namespace petzval::render
