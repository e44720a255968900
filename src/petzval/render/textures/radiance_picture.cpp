// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/textures/radiance_picture.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace petzval::render {

namespace {

constexpr int most_radiance_side = 1 << 16;
constexpr double most_radiance_pixels = 1 << 28;

class RadianceReader {
 public:
  RadianceReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  PictureFile read() {
    if (line().substr(0, 2) != "#?") refuse("is no Radiance picture");
    double exposure = 1;
    for (std::string_view each = line(); !each.empty(); each = line()) {
      if (each.starts_with("FORMAT=") && each != "FORMAT=32-bit_rle_rgbe")
        refuse("is a Radiance picture that is not of RGBE; 32-bit_rle_rgbe would be right");
      if (!each.starts_with("EXPOSURE=")) continue;
      const std::optional<double> one = parse_scene_number(trimmed(each.substr(9)));
      if (!one || !(*one > 1e-30 && *one < 1e30)) refuse("has an exposure that is no number above 0");
      exposure *= *one;
    }
    if (!(exposure > 1e-30 && exposure < 1e30)) refuse("has an exposure that is out of range");
    read_size();
    std::vector<std::uint8_t> row(static_cast<std::size_t>(picture_.width) * 4);
    for (int i = 0; i < picture_.height; ++i) {
      check_stop();
      read_row(row);
      for (std::size_t at = 0; at < row.size(); at += 4)
        for (std::size_t c = 0; c < 3; ++c)
          picture_.values.push_back(value(row[at + c], row[at + 3], exposure));
    }
    return std::move(picture_);
  }

 private:
  [[noreturn]] void refuse(const char* what) const { throw InputError(name_, what); }

  float value(int mantissa, int exponent, double exposure) const {
    constexpr int bias = 128 + 8;
    const double light = exponent ? (mantissa + 0.5) * std::ldexp(1.0, exponent - bias) / exposure : 0;
    if (!std::isfinite(static_cast<float>(light))) refuse("holds a value that is out of range");
    return static_cast<float>(light);
  }

  static std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
    return text;
  }

  std::string_view line() {
    const std::size_t end = bytes_.find('\n');
    if (end == std::string_view::npos) refuse("is a damaged Radiance picture: it ends early");
    const std::string_view result = trimmed(bytes_.substr(0, end));
    bytes_.remove_prefix(end + 1);
    return result;
  }

  std::uint8_t byte() {
    if (bytes_.empty()) refuse("is a damaged Radiance picture: it ends early");
    const auto result = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return result;
  }

  void read_size() {
    const std::string text(line());
    int used = 0;
    if (std::sscanf(text.c_str(), "-Y %9d +X %9d%n", &picture_.height, &picture_.width, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size())
      refuse("is a Radiance picture that lies otherwise than by rows from the top (-Y … +X …)");
    const double pixels = static_cast<double>(picture_.width) * picture_.height;
    if (picture_.width < 1 || picture_.height < 1 || picture_.width > most_radiance_side ||
        picture_.height > most_radiance_side || pixels > most_radiance_pixels)
      refuse("is a Radiance picture whose size is out of range");
    // Two bytes make runs of 127 at most in each of four planes; old runs are refused beyond that.
    if (pixels > 64.0 * static_cast<double>(bytes_.size()))
      refuse("is a damaged Radiance picture: it ends early");
    picture_.values.reserve(3 * static_cast<std::size_t>(pixels));
  }

  void read_row(std::vector<std::uint8_t>& row) {
    std::array<std::uint8_t, 4> pixel;
    for (std::uint8_t& each : pixel) each = byte();
    if (pixel[0] == 2 && pixel[1] == 2 && pixel[2] < 128 && pixel[2] * 256 + pixel[3] == picture_.width)
      return read_planes(row);
    // Plain pixels; (1, 1, 1, n) repeats the one before.
    std::size_t at = 0;
    int shift = 0;
    for (;;) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1 && at > 0 && shift < 32) {
        std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
        if (count > (row.size() - at) / 4) refuse("is a damaged Radiance picture: a run leaves its row");
        for (; count > 0; --count, at += 4)
          for (std::size_t c = 0; c < 4; ++c) row[at + c] = row[at + c - 4];
        shift += 8;
      } else {
        for (std::size_t c = 0; c < 4; ++c) row[at + c] = pixel[c];
        at += 4, shift = 0;
      }
      if (at == row.size()) return;
      for (std::uint8_t& each : pixel) each = byte();
    }
  }

  void read_planes(std::vector<std::uint8_t>& row) {
    const auto width = static_cast<std::size_t>(picture_.width);
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t at = 0; at < width;) {
        const std::size_t code = byte(), count = code > 128 ? code - 128 : code;
        if (count == 0 || count > width - at) refuse("is a damaged Radiance picture: a run leaves its row");
        const std::uint8_t same = code > 128 ? byte() : std::uint8_t{0};
        for (std::size_t i = 0; i < count; ++i, ++at) row[4 * at + c] = code > 128 ? same : byte();
      }
  }

  std::string_view bytes_;
  const std::string& name_;
  PictureFile picture_;
};

}  // namespace

PictureFile parse_radiance_picture(std::string_view bytes, const std::string& name) {
  return RadianceReader(bytes, name).read();
}

}  // namespace petzval::render
