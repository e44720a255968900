// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/version.h>
#include <petzval/image/formats/jpeg_output.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace petzval {

namespace {

// Types of TIFF 6.0 and tags of EXIF 2.32.
enum ExifType : std::uint16_t {
  exif_ascii = 2,
  exif_short = 3,
  exif_long = 4,
  exif_rational = 5,
  exif_bytes = 7
};

void put(std::string& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> 8 * i & 0xff);
}

/// A directory of entries, in the order of their tags, whose longer values follow it.
class ExifDirectory {
 public:
  void text(std::uint16_t tag, const std::string& value) {
    if (value.empty()) return;
    constexpr std::size_t longest = 1000;
    const std::string cut = value.substr(0, longest) + '\0';
    entries_.push_back({tag, exif_ascii, static_cast<std::uint32_t>(cut.size()), cut});
  }
  void number(std::uint16_t tag, ExifType type, std::uint32_t value) {
    std::string bytes;
    put(bytes, value, type == exif_short ? 2 : 4);
    entries_.push_back({tag, type, 1, bytes});
  }
  /// Nothing for a value that is not known.
  void rational(std::uint16_t tag, double value) {
    constexpr double most = 4e9;
    if (!(value > 0 && value < most)) return;
    // Short times as one over, the rest in as fine steps as fit.
    double above = 1, below = 1 / value;
    if (std::abs(below - std::round(below)) > 1e-3 * below || below < 1) {
      below = std::min(1e6, std::pow(10, std::floor(std::log10(most / value))));
      above = value * below;
    }
    std::string bytes;
    put(bytes, static_cast<std::uint32_t>(std::round(above)), 4);
    put(bytes, static_cast<std::uint32_t>(std::round(below)), 4);
    entries_.push_back({tag, exif_rational, 1, bytes});
  }
  void bytes(std::uint16_t tag, const std::string& value) {
    entries_.push_back({tag, exif_bytes, static_cast<std::uint32_t>(value.size()), value});
  }

  /// \param at  where it stands, from the beginning of the TIFF header.
  std::string placed(std::size_t at) const {
    constexpr std::size_t entry_bytes = 12, inside = 4;
    std::string head, values;
    const std::size_t behind = at + 2 + entry_bytes * entries_.size() + 4;
    put(head, static_cast<std::uint32_t>(entries_.size()), 2);
    for (const Entry& entry : entries_) {
      put(head, entry.tag, 2);
      put(head, entry.type, 2);
      put(head, entry.count, 4);
      if (entry.value.size() <= inside) {
        head += entry.value + std::string(inside - entry.value.size(), '\0');
        continue;
      }
      put(head, static_cast<std::uint32_t>(behind + values.size()), 4);
      values += entry.value;
      if (values.size() % 2) values += '\0';
    }
    put(head, 0, 4);  // no further directory
    return head + values;
  }

 private:
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
  };
  std::vector<Entry> entries_;
};

}  // namespace

std::string exif_of(int columns, int rows, const JpegOptions& options) {
  const CameraFacts& facts = options.facts;
  const auto main_directory = [&](std::uint32_t exif_at) {
    ExifDirectory directory;
    directory.text(0x010e, options.description);
    directory.text(0x0110, facts.camera);
    directory.rational(0x011a, 72);
    directory.rational(0x011b, 72);
    directory.number(0x0128, exif_short, 2);  // inches
    directory.text(0x0131, std::string("petzval ") + version());
    if (facts.date_time) directory.text(0x0132, exif_date_time(*facts.date_time));
    directory.number(0x0213, exif_short, 1);
    directory.number(0x8769, exif_long, exif_at);
    return directory;
  };
  constexpr std::size_t header_bytes = 8;
  // Its size does not depend on the number that it holds.
  const auto exif_at =
      static_cast<std::uint32_t>(header_bytes + main_directory(0).placed(header_bytes).size());
  ExifDirectory exif;
  exif.rational(0x829a, facts.exposure_s);
  exif.rational(0x829d, facts.lens.f_number);
  constexpr double most_iso = 65535;
  if (facts.iso >= 1)
    exif.number(0x8827, exif_short, static_cast<std::uint32_t>(std::min(most_iso, std::round(facts.iso))));
  exif.bytes(0x9000, "0232");
  if (facts.date_time) exif.text(0x9003, exif_date_time(*facts.date_time));
  exif.bytes(0x9101, std::string("\1\2\3\0", 4));
  exif.rational(0x920a, facts.lens.focal_length_mm);
  if (facts.date_time) exif.text(0x9291, exif_subseconds(*facts.date_time));
  exif.bytes(0xa000, "0100");
  constexpr std::uint32_t is_srgb = 1, uncalibrated = 0xffff;
  exif.number(0xa001, exif_short, options.srgb ? is_srgb : uncalibrated);
  exif.number(0xa002, exif_long, static_cast<std::uint32_t>(columns));
  exif.number(0xa003, exif_long, static_cast<std::uint32_t>(rows));
  exif.text(0xa434, facts.lens.name);
  std::string header("II");
  put(header, 42, 2);
  put(header, header_bytes, 4);
  return header + main_directory(exif_at).placed(header_bytes) + exif.placed(exif_at);
}

}  // namespace petzval
