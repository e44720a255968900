// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/sensor/formats/dng_opcodes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

namespace petzval::dng {

namespace {

enum Opcode : std::uint32_t {
  warp_rectilinear = 1,
  warp_fisheye = 2,
  fix_vignette_radial = 3,
  fix_bad_pixels_list = 5,
  gain_map = 9
};
constexpr std::uint32_t since_dng_1_3 = 0x01030000, optional_flag = 1;
constexpr std::size_t vignetting_terms = 5, warp_terms = 4, tangential_terms = 2, centre_terms = 2;

/// Numbers with the high byte first, as opcode lists have them whatever the file's order.
class BigEndian {
 public:
  void add(std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes_ += static_cast<char>(value >> shift & 0xff);
  }
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    add(static_cast<std::uint32_t>(bits >> 32));
    add(static_cast<std::uint32_t>(bits & 0xffffffff));
  }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add_opcode(Opcode opcode, const BigEndian& parameters) {
    add(std::uint32_t{opcode});
    add(since_dng_1_3);
    add(optional_flag);
    add(static_cast<std::uint32_t>(parameters.bytes_.size()));
    bytes_ += parameters.bytes_;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class BigEndianReader {
 public:
  explicit BigEndianReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
  std::uint32_t whole() {
    std::uint32_t value = 0;
    for (const std::uint8_t byte : take(4)) value = value << 8 | byte;
    return value;
  }
  double real() {
    const std::uint64_t high = whole();
    const auto value = std::bit_cast<double>(high << 32 | whole());
    if (!std::isfinite(value)) throw InputError("an opcode with a number that is none");
    return value;
  }
  float narrow_real() {
    const auto value = std::bit_cast<float>(whole());
    if (!std::isfinite(value)) throw InputError("an opcode with a number that is none");
    return value;
  }
  std::vector<double> reals(std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = real();
    return values;
  }
  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > rest_.size()) throw InputError("an opcode list that ends too early");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Calls visit(opcode, parameters) for each of a list.
template <typename Visit>
void for_opcodes(std::span<const std::uint8_t> list, const Visit& visit) {
  BigEndianReader reader(list);
  const std::uint32_t count = reader.whole();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t opcode = reader.whole();
    reader.take(2 * sizeof(std::uint32_t));  // version and flags
    const std::uint32_t size = reader.whole();
    visit(opcode, BigEndianReader(reader.take(size)));
  }
}

/// Which of a Bayer mosaic's cells the first pixel is: 0 red, 1 green beside red, 2 green beside blue, 3
/// blue.
std::optional<std::uint32_t> bayer_phase(const RawImage& raw) {
  if (raw.mosaic.rows != 2 || raw.mosaic.columns != 2) return {};
  std::string colours;
  for (const int cell : raw.mosaic.cells) colours += raw.channels[static_cast<std::size_t>(cell)] + " ";
  const char* const phases[] = {"red green green blue ", "green red blue green ", "green blue red green ",
                                "blue green green red "};
  const auto found = std::find(std::begin(phases), std::end(phases), colours);
  if (found == std::end(phases)) return {};
  return static_cast<std::uint32_t>(found - std::begin(phases));
}

void take_bad_pixels(BigEndianReader& parameters, RawImage& raw) {
  parameters.whole();  // the phase, which the mosaic tells
  const std::uint32_t points = parameters.whole(), rectangles = parameters.whole();
  constexpr std::size_t point_bytes = 8, rectangle_bytes = 16;
  if (parameters.left() != point_bytes * points + rectangle_bytes * std::size_t{rectangles})
    throw InputError("a list of bad pixels of another length than it states");
  for (std::uint32_t i = 0; i < points; ++i) {
    const std::uint32_t row = parameters.whole(), column = parameters.whole();
    if (row >= static_cast<std::uint32_t>(raw.rows) || column >= static_cast<std::uint32_t>(raw.columns))
      throw InputError(
          fmt::format("a bad pixel in row {}, column {} of {} x {}", row, column, raw.columns, raw.rows));
    raw.bad_pixels.push_back({static_cast<int>(row), static_cast<int>(column)});
  }
}

/// What is centred and alike for all planes is taken.
void take_warp(BigEndianReader& parameters, RawImage& raw) {
  const std::uint32_t planes = parameters.whole();
  if (parameters.left() !=
      sizeof(double) * (std::size_t{planes} * (warp_terms + tangential_terms) + centre_terms))
    throw InputError("a warp of another length than it states");
  if (planes != 1) return;
  const std::vector<double> terms = parameters.reals(warp_terms);
  const std::vector<double> rest = parameters.reals(tangential_terms + centre_terms);
  if (rest == std::vector<double>{0, 0, 0.5, 0.5}) raw.lens.warp = terms;
}

void take_fisheye_warp(BigEndianReader& parameters, RawImage& raw) {
  const std::uint32_t planes = parameters.whole();
  if (parameters.left() != sizeof(double) * (std::size_t{planes} * warp_terms + centre_terms))
    throw InputError("a warp of another length than it states");
  if (planes != 1) return;
  const std::vector<double> terms = parameters.reals(warp_terms);
  if (parameters.reals(centre_terms) == std::vector<double>{0.5, 0.5}) raw.lens.fisheye_warp = terms;
}

/// Of maps over the whole frame, alike for all planes, the first.
void take_gain_map(BigEndianReader& parameters, RawImage& raw) {
  const std::uint32_t top = parameters.whole(), left = parameters.whole();
  const std::uint32_t bottom = parameters.whole(), right = parameters.whole();
  for (int skipped = 0; skipped < 4; ++skipped) parameters.whole();  // planes, pitches
  const std::uint32_t rows = parameters.whole(), columns = parameters.whole();
  const std::vector<double> places = parameters.reals(4);
  const std::uint32_t planes = parameters.whole();
  constexpr std::uint32_t most = 4096;  // points on a side
  if (rows < 1 || columns < 1 || planes < 1 || rows > most || columns > most || planes > most ||
      parameters.left() != sizeof(float) * std::size_t{rows} * columns * planes)
    throw InputError("a map of gains of another length than it states");
  const auto spacing = [](std::uint32_t points) { return 1.0 / (points - 1.0); };
  const bool whole = top < 2 && left < 2 && bottom == static_cast<std::uint32_t>(raw.rows) &&
                     right == static_cast<std::uint32_t>(raw.columns) && planes == 1 && rows > 1 &&
                     columns > 1 && places == std::vector<double>{spacing(rows), spacing(columns), 0, 0};
  if (!whole || raw.lens.gain_map.rows > 0) return;
  raw.lens.gain_map = {static_cast<int>(columns), static_cast<int>(rows), {}};
  for (std::size_t i = 0; i < std::size_t{rows} * columns; ++i)
    raw.lens.gain_map.gains.push_back(parameters.narrow_real());
}

void take_vignetting(BigEndianReader& parameters, RawImage& raw) {
  const std::vector<double> terms = parameters.reals(vignetting_terms);
  if (parameters.reals(centre_terms) == std::vector<double>{0.5, 0.5}) raw.lens.vignetting = terms;
}

}  // namespace

std::string opcodes_of_samples(const RawImage& raw) {
  const std::optional<std::uint32_t> phase = bayer_phase(raw);
  if (!phase || raw.bad_pixels.empty()) return {};
  BigEndian parameters, list;
  parameters.add(*phase);
  parameters.add(static_cast<std::uint32_t>(raw.bad_pixels.size()));
  parameters.add(std::uint32_t{0});  // rectangles
  for (const PixelPlace& place : raw.bad_pixels) {
    parameters.add(static_cast<std::uint32_t>(place.row));
    parameters.add(static_cast<std::uint32_t>(place.column));
  }
  list.add(std::uint32_t{1});
  list.add_opcode(fix_bad_pixels_list, parameters);
  return list.bytes();
}

std::string opcodes_of_values(const RawImage& raw) {
  const GainMap& map = raw.lens.gain_map;
  if (map.rows < 2 || map.columns < 2) return {};
  const std::uint32_t pitch = raw.mosaic.rows == 2 && raw.mosaic.columns == 2 ? 2 : 1;
  BigEndian list;
  list.add(pitch * pitch);
  for (std::uint32_t kind = 0; kind < pitch * pitch; ++kind) {
    BigEndian parameters;
    const auto planes = static_cast<std::uint32_t>(raw.mosaic.is_uniform() ? raw.channels.size() : 1);
    for (const std::uint32_t value :
         {kind / pitch, kind % pitch, static_cast<std::uint32_t>(raw.rows),
          static_cast<std::uint32_t>(raw.columns), std::uint32_t{0}, planes, pitch, pitch,
          static_cast<std::uint32_t>(map.rows), static_cast<std::uint32_t>(map.columns)})
      parameters.add(value);
    for (const double place : {1.0 / (map.rows - 1), 1.0 / (map.columns - 1), 0.0, 0.0})
      parameters.add(place);
    parameters.add(std::uint32_t{1});  // for all planes
    for (const float gain : map.gains) parameters.add(gain);
    list.add_opcode(gain_map, parameters);
  }
  return list.bytes();
}

std::string opcodes_of_picture(const LensFacts& lens) {
  BigEndian list;
  const bool even = lens.vignetting.size() == vignetting_terms, straight = lens.warp.size() == warp_terms,
             fisheye = !straight && lens.fisheye_warp.size() == warp_terms;
  if (!even && !straight && !fisheye) return {};
  list.add(static_cast<std::uint32_t>(even + (straight || fisheye)));
  const auto add_centre = [](BigEndian& parameters) { parameters.add(0.5), parameters.add(0.5); };
  if (even) {
    BigEndian parameters;
    for (const double term : lens.vignetting) parameters.add(term);
    add_centre(parameters);
    list.add_opcode(fix_vignette_radial, parameters);
  }
  if (straight || fisheye) {
    BigEndian parameters;
    parameters.add(std::uint32_t{1});  // planes
    for (const double term : straight ? lens.warp : lens.fisheye_warp) parameters.add(term);
    for (std::size_t i = 0; straight && i < tangential_terms; ++i) parameters.add(0.0);
    add_centre(parameters);
    list.add_opcode(straight ? warp_rectilinear : warp_fisheye, parameters);
  }
  return list.bytes();
}

void take_sample_opcodes(std::span<const std::uint8_t> list, RawImage& raw) {
  for_opcodes(list, [&](std::uint32_t opcode, BigEndianReader parameters) {
    if (opcode == fix_bad_pixels_list) take_bad_pixels(parameters, raw);
  });
}

void take_value_opcodes(std::span<const std::uint8_t> list, RawImage& raw) {
  for_opcodes(list, [&](std::uint32_t opcode, BigEndianReader parameters) {
    if (opcode == gain_map) take_gain_map(parameters, raw);
  });
}

void take_picture_opcodes(std::span<const std::uint8_t> list, RawImage& raw) {
  for_opcodes(list, [&](std::uint32_t opcode, BigEndianReader parameters) {
    if (opcode == warp_rectilinear) take_warp(parameters, raw);
    if (opcode == warp_fisheye) take_fisheye_warp(parameters, raw);
    if (opcode == fix_vignette_radial) take_vignetting(parameters, raw);
  });
}

}  // namespace petzval::dng
