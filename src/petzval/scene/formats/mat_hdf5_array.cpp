// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/scene/formats/mat_hdf5_array.h>

#include <algorithm>
#include <array>

namespace petzval {

namespace {

constexpr std::size_t max_hdf5_rank = 32;  // of HDF5
constexpr hsize_t max_ratio = 1032 * 4;    // zlib's limit, and some more
constexpr hsize_t piece_bytes = 1 << 26, max_chunk_bytes = 1 << 30;

const MatArrayClass array_classes[] = {
    {"double", [] { return H5T_NATIVE_DOUBLE; }, 8, MAT_C_DOUBLE, MAT_T_DOUBLE},
    {"single", [] { return H5T_NATIVE_FLOAT; }, 4, MAT_C_SINGLE, MAT_T_SINGLE},
    {"int8", [] { return H5T_NATIVE_INT8; }, 1, MAT_C_INT8, MAT_T_INT8},
    {"uint8", [] { return H5T_NATIVE_UINT8; }, 1, MAT_C_UINT8, MAT_T_UINT8},
    {"int16", [] { return H5T_NATIVE_INT16; }, 2, MAT_C_INT16, MAT_T_INT16},
    {"uint16", [] { return H5T_NATIVE_UINT16; }, 2, MAT_C_UINT16, MAT_T_UINT16},
    {"int32", [] { return H5T_NATIVE_INT32; }, 4, MAT_C_INT32, MAT_T_INT32},
    {"uint32", [] { return H5T_NATIVE_UINT32; }, 4, MAT_C_UINT32, MAT_T_UINT32},
    {"int64", [] { return H5T_NATIVE_INT64; }, 8, MAT_C_INT64, MAT_T_INT64},
    {"uint64", [] { return H5T_NATIVE_UINT64; }, 8, MAT_C_UINT64, MAT_T_UINT64},
    {"logical", [] { return H5T_NATIVE_UINT8; }, 1, MAT_C_UINT8, MAT_T_UINT8},
    {"char", [] { return H5T_NATIVE_UINT16; }, 2, MAT_C_CHAR, MAT_T_UINT16},
};

/// Writes one array after the other.
class ArrayWriter {
 public:
  ArrayWriter(const std::string& path, MatRecordWriter& writer) : path_(path), writer_(writer) {}

  void write(hid_t data, const MatArrayClass& kind, const std::string& name, const std::string& full) {
    const std::vector<hsize_t> sides = checked_sides(data, kind, full);
    MatRecord record;
    record.kind = kind.is_text() ? MatRecordKind::text : MatRecordKind::numbers;
    record.name = name;
    record.class_type = kind.class_type;
    record.data_type = kind.data_type;
    record.dimensions.assign(sides.rbegin(), sides.rend());
    // A scalar or a list in HDF5 is what MATLAB calls 1 x 1 or n x 1.
    record.dimensions.resize(std::max<std::size_t>(2, sides.size()), 1);
    record.bytes = kind.size;
    for (const hsize_t side : sides) record.bytes *= side;
    writer_.begin(record);
    write_pieces(data, kind, sides, full);
    writer_.end();
  }

 private:
  [[noreturn]] void refuse(const std::string& message) const { throw InputError(path_, message); }
  [[noreturn]] void damaged(const std::string& message) const { refuse_damaged_mat(path_, message); }

  /// The sides of an array that can be what it says it is.
  std::vector<hsize_t> checked_sides(hid_t data, const MatArrayClass& kind, const std::string& full) const {
    const Hdf5Handle space(H5Dget_space(data), H5Sclose), plan(H5Dget_create_plist(data), H5Pclose);
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (!plan || rank < 0 || rank > static_cast<int>(max_hdf5_rank)) damaged(full + " has no size");
    std::vector<hsize_t> sides(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.id(), sides.data(), nullptr);
    double bytes = static_cast<double>(kind.size);
    for (const hsize_t side : sides) bytes *= static_cast<double>(side);
    constexpr double gib = 1024.0 * 1024 * 1024;
    if (bytes > static_cast<double>(most_mat_array_bytes))
      refuse(fmt::format("{} would take {:.1f} GiB; up to {:.0f} GiB fit", full, bytes / gib,
                         static_cast<double>(most_mat_array_bytes) / gib));
    check_storage(data, plan.id(), bytes, full);
    return sides;
  }

  void check_storage(hid_t data, hid_t plan, double bytes, const std::string& full) const {
    const H5D_layout_t layout = H5Pget_layout(plan);
    if (H5Pget_external_count(plan) != 0 || layout == H5D_VIRTUAL || layout < 0)
      refuse(full + " is kept in another file; only data within this one are read");
    if (static_cast<double>(H5Dget_storage_size(data)) * static_cast<double>(max_ratio) < bytes)
      damaged(fmt::format("{} claims to hold more than there is", full));
    for (int i = 0; i < H5Pget_nfilters(plan); ++i) {
      unsigned flags = 0;
      std::size_t values = 0;
      const H5Z_filter_t filter =
          H5Pget_filter2(plan, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, nullptr);
      if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32)
        refuse(full + " is packed as MATLAB does not pack; deflate would be right");
    }
    if (layout != H5D_CHUNKED) return;
    std::array<hsize_t, max_hdf5_rank> chunk{};
    const int rank = H5Pget_chunk(plan, max_hdf5_rank, chunk.data());
    double chunk_bytes = 8;
    for (int i = 0; i < rank; ++i) chunk_bytes *= static_cast<double>(chunk[static_cast<std::size_t>(i)]);
    if (rank < 0 || chunk_bytes > static_cast<double>(max_chunk_bytes))
      refuse(full + " is stored in pieces of more than 1 GiB");
  }

  /// Pieces along the first side that need not be whole: all sides behind it fit into a piece.
  void write_pieces(hid_t data, const MatArrayClass& kind, const std::vector<hsize_t>& sides,
                    const std::string& full) {
    const Hdf5Handle space(H5Dget_space(data), H5Sclose);
    if (sides.empty()) return write_piece(data, space.id(), kind, {}, {}, full);
    std::size_t cut = sides.size() - 1;
    hsize_t behind = kind.size;
    while (cut > 0 && behind * sides[cut] <= piece_bytes) behind *= sides[cut--];
    const hsize_t step = std::clamp<hsize_t>(piece_bytes / behind, 1, sides[cut]);
    std::vector<hsize_t> start(sides.size(), 0), count = sides;
    std::fill(count.begin(), count.begin() + static_cast<std::ptrdiff_t>(cut), 1);
    for (bool more = true; more;) {
      for (start[cut] = 0; start[cut] < sides[cut]; start[cut] += step) {
        count[cut] = std::min(step, sides[cut] - start[cut]);
        write_piece(data, space.id(), kind, start, count, full);
      }
      more = false;
      for (std::size_t axis = cut; axis-- > 0 && !more;) {
        more = ++start[axis] < sides[axis];
        if (!more) start[axis] = 0;
      }
    }
  }

  void write_piece(hid_t data, hid_t space, const MatArrayClass& kind, const std::vector<hsize_t>& start,
                   const std::vector<hsize_t>& count, const std::string& full) {
    std::size_t values = 1;
    for (const hsize_t side : count) values *= side;
    piece_.resize(values * kind.size);
    const hsize_t flat = values;
    const Hdf5Handle memory(H5Screate_simple(1, &flat, nullptr), H5Sclose);
    const bool chosen = start.empty() || H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr,
                                                             count.data(), nullptr) >= 0;
    if (!chosen || H5Dread(data, kind.type(), memory.id(), space, H5P_DEFAULT, piece_.data()) < 0)
      damaged(full + " cannot be read");
    writer_.data(piece_);
  }

  const std::string& path_;
  MatRecordWriter& writer_;
  std::vector<std::byte> piece_;
};

}  // namespace

const MatArrayClass* find_mat_array_class(const std::string& word) {
  const auto found = std::find_if(std::begin(array_classes), std::end(array_classes),
                                  [&](const MatArrayClass& known) { return word == known.word; });
  return found == std::end(array_classes) ? nullptr : found;
}

[[noreturn]] void refuse_damaged_mat(const std::string& path, const std::string& message) {
  throw InputError(path, fmt::format("is damaged: {}; save it again with MATLAB's save -v7.3", message));
}

void write_mat_array(hid_t data, const MatArrayClass& kind, const std::string& name, const std::string& full,
                     const std::string& path, MatRecordWriter& writer) {
  ArrayWriter(path, writer).write(data, kind, name, full);
}

}  // namespace petzval
