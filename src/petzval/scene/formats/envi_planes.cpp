// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/scene/formats/envi_planes.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace petzval {

namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 24;

/// Numbers of a band as they are meant: what they are multiplied with and what is added.
struct Calibration {
  double gain = 1, offset = 0;
};

Calibration calibration(const EnviHeader& header, std::size_t band) {
  const auto of = [band](const std::vector<double>& values, double otherwise) {
    return values.empty() ? otherwise : values[band];
  };
  if (header.reflectance_scale) return {1 / *header.reflectance_scale, 0};
  if (!header.reflectance_gains.empty() || !header.reflectance_offsets.empty())
    return {of(header.reflectance_gains, 1), of(header.reflectance_offsets, 0)};
  return {of(header.gains, 1), of(header.offsets, 0)};
}

/// NaN, which equals nothing, may stand for "no data" too.
bool is_ignored(const EnviHeader& header, double number) {
  return header.ignored && (number == *header.ignored || (std::isnan(number) && std::isnan(*header.ignored)));
}

/// Numbers of one row and band: where the first lies in a block, how far apart they are [bytes].
struct Run {
  const char* first;
  std::size_t step;
};

template <typename Number>
void take(const Run& run, const EnviHeader& header, const Calibration& meant, std::span<float> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::array<std::byte, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), run.first + i * run.step, sizeof(Number));
    if (header.big_endian) std::reverse(bytes.begin(), bytes.end());
    const auto number = static_cast<double>(std::bit_cast<Number>(bytes));
    out[i] = is_ignored(header, number) ? 0.0F : static_cast<float>(meant.gain * number + meant.offset);
  }
}

void take_run(const Run& run, const EnviHeader& header, const Calibration& meant, std::span<float> out) {
  switch (header.data_type) {
    case 1:
      return take<std::uint8_t>(run, header, meant, out);
    case 2:
      return take<std::int16_t>(run, header, meant, out);
    case 3:
      return take<std::int32_t>(run, header, meant, out);
    case 4:
      return take<float>(run, header, meant, out);
    case 5:
      return take<double>(run, header, meant, out);
    case 12:
      return take<std::uint16_t>(run, header, meant, out);
    case 13:
      return take<std::uint32_t>(run, header, meant, out);
    case 14:
      return take<std::int64_t>(run, header, meant, out);
    default:
      return take<std::uint64_t>(run, header, meant, out);
  }
}

/// Rows of the file that are in memory, and how the numbers of a row and band lie in them.
class Block {
 public:
  Block(const EnviHeader& header, const EnviBytes& bytes) : header_(header), bytes_(bytes) {}

  /// Rows that fit, of one band where bands lie one behind the other, else of all bands.
  std::size_t rows_at_a_time() const { return std::max<std::size_t>(1, block_bytes / row_bytes()); }

  void fetch(std::size_t band, std::size_t first_row, std::size_t rows) {
    const std::size_t before = by_band() ? band * static_cast<std::size_t>(header_.rows) : 0;
    buffer_.resize(rows * row_bytes());
    bytes_(header_.offset + (before + first_row) * row_bytes(), buffer_);
  }

  Run run(std::size_t band, std::size_t row) const {
    const std::size_t size = header_.value_bytes(), columns = static_cast<std::size_t>(header_.columns);
    const char* const start = buffer_.data() + row * row_bytes();
    switch (header_.interleave) {
      case EnviInterleave::bil:
        return {start + band * columns * size, size};
      case EnviInterleave::bip:
        return {start + band * size, static_cast<std::size_t>(header_.bands) * size};
      default:
        return {start, size};
    }
  }

  bool by_band() const { return header_.interleave == EnviInterleave::bsq; }

 private:
  std::size_t row_bytes() const {
    return header_.value_bytes() * static_cast<std::size_t>(header_.columns) *
           (by_band() ? 1 : static_cast<std::size_t>(header_.bands));
  }

  const EnviHeader& header_;
  const EnviBytes& bytes_;
  std::vector<char> buffer_;
};

}  // namespace

void read_envi_planes(const EnviHeader& header, std::span<const std::size_t> order, const EnviBytes& bytes,
                      SpectralCube& cube) {
  Block block(header, bytes);
  const auto rows = static_cast<std::size_t>(header.rows), columns = static_cast<std::size_t>(header.columns);
  // Planes that come from one fetch: one, or all.
  const std::size_t together = block.by_band() ? 1 : order.size();
  for (std::size_t plane = 0; plane < order.size(); plane += together)
    for (std::size_t row = 0; row < rows; row += block.rows_at_a_time()) {
      const std::size_t count = std::min(block.rows_at_a_time(), rows - row);
      block.fetch(order[plane], row, count);
      parallel_for(together * count, [&](std::size_t i) {
        const std::size_t to = plane + i / count, at = i % count;
        take_run(block.run(order[to], at), header, calibration(header, order[to]),
                 cube.plane(to).subspan((row + at) * columns, columns));
      });
      cube.values.release_memory();
    }
}

}  // namespace petzval
