// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/render/media/nanovdb_file.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace petzval::render {

namespace {

constexpr std::string_view nanovdb_magic = "NanoVDB0";
constexpr int nanovdb_version = 32, floats_of_32_bits = 1;
constexpr double most_voxels = 0x1p28;
/// Deflate makes nothing smaller than by a thousand.
constexpr std::uint64_t most_inflated = 1032;

/// Bytes, each access to which is checked.
class NanovdbBytes {
 public:
  NanovdbBytes(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::string_view part(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at)
      throw InputError(file_, "ends before what it announces, or points beyond its end");
    return bytes_.substr(at, size);
  }
  template <class Value>
  Value number(std::uint64_t at) const {
    Value value;
    std::memcpy(&value, part(at, sizeof value).data(), sizeof value);
    return value;
  }
  const std::string& file() const { return file_; }
  std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  const std::string& file_;
};

struct ListedGrid {
  std::string name;
  std::uint32_t type;
  std::uint64_t size, stored_size, at;
  int codec;
};

/// The grids of all segments of a file.
std::vector<ListedGrid> listed_grids(const NanovdbBytes& bytes) {
  std::vector<ListedGrid> all;
  for (std::uint64_t at = 0; at < bytes.size();) {
    if (bytes.part(at, 8) != nanovdb_magic)
      throw InputError(bytes.file(), "is no file of NanoVDB, whose parts begin with \"NanoVDB0\"");
    const int major = static_cast<int>(bytes.number<std::uint32_t>(at + 8) >> 21);
    if (major != nanovdb_version)
      throw InputError(bytes.file(),
                       fmt::format("is of version {} of NanoVDB; {} would be right (nanovdb_convert "
                                   "of OpenVDB 8 to 10 writes it)",
                                   major, nanovdb_version));
    const int grids = bytes.number<std::uint16_t>(at + 12), codec = bytes.number<std::uint16_t>(at + 14);
    at += 16;
    const std::size_t first = all.size();
    for (int i = 0; i < grids; ++i) {
      const auto name_size = bytes.number<std::uint32_t>(at + 136);
      std::string_view name = bytes.part(at + 176, name_size);
      name = name.substr(0, name.find('\0'));
      all.push_back({std::string(name), bytes.number<std::uint32_t>(at + 32), bytes.number<std::uint64_t>(at),
                     bytes.number<std::uint64_t>(at + 8), 0, codec});
      at += 176 + name_size;
    }
    for (std::size_t i = first; i < all.size(); ++i) {
      all[i].at = at;
      bytes.part(at, all[i].stored_size);
      at += all[i].stored_size;
    }
  }
  return all;
}

std::string inflated_grid(const NanovdbBytes& bytes, const ListedGrid& grid) {
  const auto size = bytes.number<std::uint64_t>(grid.at);
  const std::string_view stored = bytes.part(grid.at + 8, size);
  if (grid.size / most_inflated > size) throw InputError(bytes.file(), "states a size that it cannot have");
  std::string result(grid.size, '\0');
  uLongf got = grid.size;
  if (uncompress(reinterpret_cast<Bytef*>(result.data()), &got, reinterpret_cast<const Bytef*>(stored.data()),
                 size) != Z_OK ||
      got != grid.size)
    throw InputError(bytes.file(), "is compressed with ZIP and damaged");
  return result;
}

/// Takes the values out of the tree of a grid, from the root down.
class VoxelTree {
 public:
  VoxelTree(const NanovdbBytes& bytes, VoxelGrid& grid) : bytes_(bytes), grid_(grid) {
    constexpr std::uint64_t tree = 672, root_offset = 24, tiles_offset = 64, tile_size = 32;
    const std::uint64_t root = tree + bytes.number<std::uint64_t>(tree + root_offset);
    make_room(root);
    const auto tiles = bytes.number<std::uint32_t>(root + 24);
    bytes.part(root + tiles_offset, tile_size * std::uint64_t{tiles});
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const std::uint64_t tile = root + tiles_offset + tile_size * i;
      const auto key = bytes.number<std::uint64_t>(tile);
      const Place from{of_key(key >> 42), of_key(key >> 21), of_key(key)};
      if (is_outside(from, upper_side)) continue;
      if (const auto child = bytes.number<std::int64_t>(tile + 8))
        node(root + static_cast<std::uint64_t>(child), from, upper);
      else
        fill(from, upper_side, bytes.number<float>(tile + 20));
    }
  }

 private:
  using Place = std::array<std::int64_t, 3>;
  /// Nodes of (2^bits)³ parts of 2^bits_below voxels on a side.
  struct Level {
    int bits, bits_below;
    std::uint64_t child_mask, table;  ///< offsets
  };
  static constexpr Level upper{5, 7, 32 + 4096, 8256}, lower{4, 3, 32 + 512, 1088};
  static constexpr std::int64_t upper_side = 4096;

  /// 20 bits that count in 4096 voxels.
  static std::int64_t of_key(std::uint64_t key) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(key) << 12);
  }

  void make_room(std::uint64_t root) {
    double count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t low = bytes_.number<std::int32_t>(root + 4 * axis),
                         high = bytes_.number<std::int32_t>(root + 12 + 4 * axis);
      if (low > high) throw InputError(bytes_.file(), "has a grid without an active voxel");
      count *= static_cast<double>(high - low + 3);
      if (std::abs(low) > 1 << 30) throw InputError(bytes_.file(), "has voxels that are too far out");
      if (!(count <= most_voxels))
        throw InputError(bytes_.file(),
                         fmt::format("has a grid of more than {:g} voxels from the first to the last, "
                                     "which all must be held; a coarser one would be right",
                                     most_voxels));
      grid_.first[axis] = static_cast<int>(low) - 1;
      grid_.size[axis] = static_cast<int>(high - low) + 3;
    }
    left_ = count;
    grid_.values.assign(static_cast<std::size_t>(count), bytes_.number<float>(root + 28));
  }

  /// Calls with the index and the place in the box of each voxel of a cube that is in it.
  template <class Visit>
  void each_voxel(const Place& from, std::int64_t side, Visit&& visit) {
    Place low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max<std::int64_t>(0, from[axis] - grid_.first[axis]);
      high[axis] = std::min<std::int64_t>(grid_.size[axis], from[axis] - grid_.first[axis] + side);
      if (low[axis] >= high[axis]) return;
    }
    // No voxel is in two places.
    left_ -= static_cast<double>((high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]));
    if (left_ < 0) throw InputError(bytes_.file(), "has a tree whose parts overlap");
    for (std::int64_t z = low[2]; z < high[2]; ++z)
      for (std::int64_t y = low[1]; y < high[1]; ++y)
        for (std::int64_t x = low[0]; x < high[0]; ++x)
          visit(static_cast<std::size_t>((z * grid_.size[1] + y) * grid_.size[0] + x), x, y, z);
  }

  void fill(const Place& from, std::int64_t side, float value) {
    each_voxel(from, side, [&](std::size_t at, auto...) { grid_.values[at] = value; });
  }

  void node(std::uint64_t at, const Place& from, const Level& level) {
    const std::int64_t side = std::int64_t{1} << level.bits_below;
    const std::uint64_t parts = std::uint64_t{1} << (3 * level.bits);
    bytes_.part(at, level.table + 8 * parts);
    constexpr std::uint64_t least_size = lower.table + 8 * 4096;
    if (++nodes_ > bytes_.size() / least_size)
      throw InputError(bytes_.file(), "has a tree whose parts overlap");
    for (std::uint64_t n = 0; n < parts; ++n) {
      const std::int64_t mask = (std::int64_t{1} << level.bits) - 1;
      const auto index = static_cast<std::int64_t>(n);
      const Place part{from[0] + side * (index >> (2 * level.bits)),
                       from[1] + side * ((index >> level.bits) & mask), from[2] + side * (index & mask)};
      const std::uint64_t entry = at + level.table + 8 * n;
      const bool has_child = bytes_.number<std::uint8_t>(at + level.child_mask + n / 8) >> (n % 8) & 1;
      if (!has_child)
        fill(part, side, bytes_.number<float>(entry));
      else if (is_outside(part, side))
        continue;
      else if (level.bits == upper.bits)
        node(at + static_cast<std::uint64_t>(bytes_.number<std::int64_t>(entry)), part, lower);
      else
        leaf(at + static_cast<std::uint64_t>(bytes_.number<std::int64_t>(entry)), part);
    }
  }

  bool is_outside(const Place& from, std::int64_t side) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (from[axis] + side <= grid_.first[axis] ||
          from[axis] >= std::int64_t{grid_.first[axis]} + grid_.size[axis])
        return true;
    return false;
  }

  void leaf(std::uint64_t at, const Place& from) {
    constexpr std::uint64_t values_offset = 96;
    const std::string_view values = bytes_.part(at + values_offset, 512 * sizeof(float));
    each_voxel(from, 8, [&](std::size_t index, std::int64_t x, std::int64_t y, std::int64_t z) {
      const std::int64_t n = ((x + grid_.first[0] - from[0]) << 6) + ((y + grid_.first[1] - from[1]) << 3) +
                             (z + grid_.first[2] - from[2]);
      std::memcpy(&grid_.values[index], values.data() + sizeof(float) * static_cast<std::size_t>(n),
                  sizeof(float));
    });
  }

  const NanovdbBytes& bytes_;
  VoxelGrid& grid_;
  std::uint64_t nodes_ = 0;
  double left_ = 0;  ///< voxels that have not been told yet
};

}  // namespace

bool has_nanovdb_grid(std::string_view bytes, const std::string& file, const std::string& grid) {
  return std::ranges::any_of(listed_grids(NanovdbBytes(bytes, file)),
                             [&](const ListedGrid& each) { return each.name == grid; });
}

VoxelGrid read_nanovdb(std::string_view bytes, const std::string& file, const std::string& grid) {
  const NanovdbBytes all(bytes, file);
  const std::vector<ListedGrid> list = listed_grids(all);
  const auto found = std::ranges::find(list, grid, &ListedGrid::name);
  if (found == list.end()) {
    std::vector<std::string> names;
    for (const ListedGrid& each : list) names.push_back(each.name);
    throw InputError(file,
                     fmt::format("has no grid \"{}\"; it has \"{}\"", grid, fmt::join(names, "\", \"")));
  }
  if (found->type != floats_of_32_bits)
    throw InputError(file, fmt::format("has a grid \"{}\" that is not of floats of 32 bits", grid));
  if (found->codec > 1) throw InputError(file, "is compressed with Blosc; plain or with ZIP would be right");
  const std::string plain = found->codec == 1 ? inflated_grid(all, *found) : std::string();
  const NanovdbBytes data(found->codec == 1 ? plain : all.part(found->at, found->size), file);
  VoxelGrid result;
  VoxelTree(data, result);
  constexpr std::uint64_t matrix = 384, translation = 528;
  for (std::size_t i = 0; i < 9; ++i) result.world_from_index[i] = data.number<double>(matrix + 8 * i);
  for (std::size_t i = 0; i < 3; ++i) result.origin[i] = data.number<double>(translation + 8 * i);
  return result;
}

}  // namespace petzval::render
