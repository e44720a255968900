// SPDX-License-Identifier: BSD-3-Clause
// From the numbers of a picture with a colour profile to linear sRGB.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace petzval {

/// A transform from the colours of an ICC profile to linear sRGB, relative colorimetric (its white becomes
/// (1, 1, 1)). Colours outside sRGB's gamut come out with components below 0 or above 1.
class ProfileToLinear {
 public:
  /// \param profile  the bytes of an ICC profile for grey or RGB.
  /// \throws InputError with `file` for a profile that is damaged or of another kind.
  ProfileToLinear(const std::string& profile, const std::string& file);
  ~ProfileToLinear();
  ProfileToLinear(ProfileToLinear&&) noexcept;
  ProfileToLinear& operator=(ProfileToLinear&&) = delete;

  /// What it takes of a pixel: 1 (grey) or 3 (RGB).
  std::size_t channels() const;
  /// \param stored  0 to 1, channels interleaved;  \param rgb  three times as many values as pixels.
  void operator()(std::span<const float> stored, std::span<float> rgb) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace petzval
