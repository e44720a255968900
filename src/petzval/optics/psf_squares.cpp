// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/optics/psf_squares.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace petzval {

namespace {

constexpr std::size_t checksum_bytes = 4;

bool is_stored_as_written(const Hdf5Handle& data, hsize_t side) {
  const Hdf5Handle type(H5Dget_type(data.id()), H5Tclose);
  const Hdf5Handle properties(H5Dget_create_plist(data.id()), H5Pclose);
  if (!type || !properties || H5Tequal(type.id(), H5T_IEEE_F32LE) <= 0 ||
      H5Pget_layout(properties.id()) != H5D_CHUNKED)
    return false;
  std::array<hsize_t, 4> chunk{};
  if (H5Pget_chunk(properties.id(), 4, chunk.data()) != 4 ||
      chunk != std::array<hsize_t, 4>{1, 1, side, side})
    return false;
  const std::array filters{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32};
  if (H5Pget_nfilters(properties.id()) != static_cast<int>(filters.size())) return false;
  for (unsigned i = 0; i < filters.size(); ++i) {
    unsigned flags = 0, settings = 0;
    std::size_t no_settings = 0;
    if (H5Pget_filter2(properties.id(), i, &flags, &no_settings, nullptr, 0, nullptr, &settings) !=
        filters[i])
      return false;
  }
  return true;
}

}  // namespace

PsfSquares::PsfSquares(const Hdf5Handle& data, hsize_t side, bool sealed)
    : data_(data), side_(side), own_chunks_(sealed && is_stored_as_written(data, side)) {}

bool PsfSquares::read(hsize_t field, hsize_t wavelength, hsize_t own, std::vector<float>& values) const {
  values.resize(own * own);
  if (own_chunks_ && read_chunk(field, wavelength, own, values)) return true;
  const std::lock_guard lock(mutex_);
  const hsize_t offset = side_ / 2 - own / 2;
  const std::array<hsize_t, 4> start{field, wavelength, offset, offset}, count{1, 1, own, own};
  const Hdf5Handle source(H5Dget_space(data_.id()), H5Sclose);
  const Hdf5Handle memory(H5Screate_simple(4, count.data(), nullptr), H5Sclose);
  return H5Sselect_hyperslab(source.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >=
             0 &&
         H5Dread(data_.id(), H5T_NATIVE_FLOAT, memory.id(), source.id(), H5P_DEFAULT, values.data()) >= 0;
}

bool PsfSquares::read_chunk(hsize_t field, hsize_t wavelength, hsize_t own,
                            std::vector<float>& values) const {
  const std::size_t samples = side_ * side_;
  std::vector<unsigned char> stored;
  {
    const std::lock_guard lock(mutex_);
    const std::array<hsize_t, 4> start{field, wavelength, 0, 0};
    hsize_t bytes = 0;
    if (H5Dget_chunk_storage_size(data_.id(), start.data(), &bytes) < 0 || bytes <= checksum_bytes ||
        bytes > compressBound(samples * sizeof(float)) + checksum_bytes)
      return false;
    stored.resize(bytes);
    std::uint32_t skipped_filters = 0;
    if (H5Dread_chunk(data_.id(), H5P_DEFAULT, start.data(), &skipped_filters, stored.data()) < 0 ||
        skipped_filters != 0)
      return false;
  }
  std::vector<unsigned char> shuffled(samples * sizeof(float));
  uLongf bytes = shuffled.size();
  if (uncompress(shuffled.data(), &bytes, stored.data(), stored.size() - checksum_bytes) != Z_OK ||
      bytes != shuffled.size())
    return false;
  // The first bytes of all samples, then the second ones, the lowest first.
  const std::size_t offset = side_ / 2 - own / 2;
  for (std::size_t row = 0; row < own; ++row) {
    const unsigned char* lowest = shuffled.data() + (offset + row) * side_ + offset;
    float* out = values.data() + row * own;
    for (std::size_t i = 0; i < own; ++i) {
      const std::uint32_t bits = std::uint32_t{lowest[i]} | std::uint32_t{lowest[samples + i]} << 8U |
                                 std::uint32_t{lowest[2 * samples + i]} << 16U |
                                 std::uint32_t{lowest[3 * samples + i]} << 24U;
      out[i] = std::bit_cast<float>(bits);
    }
  }
  return true;
}

}  // namespace petzval
