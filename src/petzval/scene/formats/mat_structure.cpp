// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/scene/formats/mat_structure.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

namespace petzval {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t header_size = 128;
constexpr int max_depth = 32;  // of structs within structs; ISET uses five
constexpr std::size_t max_rank = 32;
constexpr std::size_t max_name_length = 64;           // MATLAB's limit is 63 and a zero
constexpr std::size_t max_deflate_ratio = 1032;       // zlib cannot pack tighter
constexpr std::size_t max_variable_size = INT32_MAX;  // the format's own limit

enum Type : std::uint32_t { int8 = 1, int32 = 5, uint32 = 6, matrix = 14, compressed = 15, utf8 = 16 };
enum Class : std::uint32_t { cell = 1, structure = 2, character = 4, first_number = 6, last_number = 15 };
constexpr std::uint32_t complex_flag = 0x0800;

/// Bytes of one number or code unit of a data type; 0 for what is none.
std::size_t size_of(std::uint32_t type) {
  constexpr std::size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8, 0, 0, 1, 2, 4};
  return type < std::size(sizes) ? sizes[type] : 0;
}

/// A data element: its type and what it holds.
struct Element {
  std::uint32_t type = 0;
  Bytes data;
};

/// Reads one element after the other from a stretch of bytes, and complains with the name of the file.
class Walker {
 public:
  Walker(Bytes bytes, bool swapped, const std::string& file) : rest_(bytes), swapped_(swapped), file_(file) {}

  bool at_end() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }
  bool swapped() const { return swapped_; }
  const std::string& file() const { return file_; }
  Walker into(Bytes bytes) const { return {bytes, swapped_, file_}; }

  std::uint32_t word(Bytes bytes, std::size_t index) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.subspan(4 * index, 4).data(), 4);
    return swapped_ ? __builtin_bswap32(value) : value;
  }

  /// The next element; within a matrix they are padded to multiples of eight bytes, unless they are matrices.
  Element next(bool padded) {
    if (rest_.size() < 8) fail("a tag is cut off");
    const std::uint32_t first = word(rest_, 0);
    if (padded && first >> 16 != 0) return next_small(first);
    const std::uint32_t size = word(rest_, 1);
    const std::size_t padding = padded && first != matrix ? (8 - size % 8) % 8 : 0;
    if (rest_.size() - 8 < size + padding) fail("an element reaches beyond its end");
    const Element element{first, rest_.subspan(8, size)};
    rest_ = rest_.subspan(8 + size + padding);
    return element;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(file_, fmt::format("is damaged: {}; save it again with MATLAB's save -v7", message));
  }

 private:
  /// A small element: type, size and up to four bytes of data share eight bytes.
  Element next_small(std::uint32_t first) {
    const std::uint32_t size = first >> 16;
    if (size > 4) fail("a small element claims more than four bytes");
    const Element element{first & 0xffff, rest_.subspan(4, size)};
    rest_ = rest_.subspan(8);
    return element;
  }

  Bytes rest_;
  bool swapped_;
  const std::string& file_;
};

void check_array(Walker walker, int depth);

/// Number of values of an array of these dimensions.
std::size_t checked_count(const Walker& walker, const Element& dimensions) {
  const std::size_t rank = dimensions.data.size() / 4;
  if (dimensions.type != int32 || dimensions.data.size() % 4 != 0 || rank < 2 || rank > max_rank)
    walker.fail("an array's dimensions are no list of whole numbers");
  std::size_t count = 1;
  for (std::size_t i = 0; i < rank; ++i) {
    const std::uint32_t dimension = walker.word(dimensions.data, i);
    if (dimension > INT32_MAX) walker.fail("a dimension is negative");
    count *= dimension;  // below 2^32 · 2^31
    if (count > UINT32_MAX) walker.fail("an array has more values than a file can hold");
  }
  return count;
}

void check_numbers(Walker& walker, std::size_t count, int parts) {
  for (int part = 0; part < parts; ++part) {
    const Element numbers = walker.next(true);
    const std::size_t size = size_of(numbers.type);
    if (size == 0 || numbers.type >= utf8) walker.fail("an array of numbers holds something else");
    if (numbers.data.size() != count * size) walker.fail("an array's dimensions do not match its data");
  }
}

void check_characters(Walker& walker, std::size_t count) {
  if (count == 0 && walker.at_end()) return;
  const Element text = walker.next(true);
  const std::size_t size = size_of(text.type);
  const std::size_t units = size == 0 ? 0 : text.data.size() / size;
  // A character takes up to four code units of UTF-8.
  if (size == 0 || (text.type == utf8 ? units < count || units > 4 * count : units != count))
    walker.fail("a text's dimensions do not match its data");
}

void check_arrays(Walker& walker, std::size_t count, int depth) {
  if (count > walker.left() / 8) walker.fail("a struct or cell array has fewer elements than it says");
  for (std::size_t i = 0; i < count; ++i) {
    const Element array = walker.next(true);
    if (array.type != matrix) walker.fail("a struct or cell array holds something that is no array");
    if (!array.data.empty()) check_array(walker.into(array.data), depth + 1);
  }
}

void check_struct(Walker& walker, std::size_t count, int depth) {
  const Element length = walker.next(true);
  if (length.type != int32 || length.data.size() != 4) walker.fail("a struct has no field name length");
  const std::size_t name_length = walker.word(length.data, 0);
  const Element names = walker.next(true);
  if (name_length < 1 || name_length > max_name_length || names.type != int8 ||
      names.data.size() % name_length != 0)
    walker.fail("a struct's field names are unreadable");
  const std::size_t fields = names.data.size() / name_length;
  for (std::size_t field = 0; field < fields; ++field) {
    const Bytes name = names.data.subspan(field * name_length, name_length);
    if (std::find(name.begin(), name.end(), std::byte{0}) == name.end())
      walker.fail("a field name does not end");
  }
  if (fields == 0 && count > 1) walker.fail("a struct array has no fields");
  check_arrays(walker, count * fields, depth);
}

void check_array(Walker walker, int depth) {
  if (depth > max_depth) walker.fail(fmt::format("structs are nested more than {} deep", max_depth));
  const Element flags = walker.next(true);
  if (flags.type != uint32 || flags.data.size() != 8) walker.fail("an array has no flags");
  const std::uint32_t what = walker.word(flags.data, 0);
  const std::uint32_t array_class = what & 0xff;
  const bool is_number = array_class >= first_number && array_class <= last_number;
  if (!is_number && array_class != cell && array_class != structure && array_class != character)
    throw InputError(walker.file(),
                     fmt::format("holds an object, function or sparse array (class {}), which is not read; "
                                 "save the scene, or the optics without it, alone",
                                 array_class));
  const std::size_t count = checked_count(walker, walker.next(true));
  if (walker.next(true).type != int8) walker.fail("an array has no name");

  if (is_number) check_numbers(walker, count, (what & complex_flag) != 0 ? 2 : 1);
  if (array_class == character) check_characters(walker, count);
  if (array_class == cell) check_arrays(walker, count, depth);
  if (array_class == structure) check_struct(walker, count, depth);
  if (!walker.at_end()) walker.fail("an array is followed by something that does not belong to it");
}

/// A zlib stream that is closed whatever happens.
class Inflation {
 public:
  Inflation(const Walker& walker, Bytes packed) : walker_(walker) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
    stream_.avail_in = static_cast<uInt>(packed.size());
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  /// The next bytes, just as many as asked for, with more to come.
  void fill(std::span<std::byte> out) {
    if (inflate_into(out) != Z_OK || stream_.avail_out != 0) fail();
  }
  /// All the rest, which must leave the last byte of `out` unused; the checksum must be right.
  void fill_to_end(std::span<std::byte> out) {
    if (inflate_into(out) != Z_STREAM_END || stream_.avail_out != 1 || stream_.avail_in != 0) fail();
  }

 private:
  int inflate_into(std::span<std::byte> out) {
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    return inflate(&stream_, Z_SYNC_FLUSH);
  }
  [[noreturn]] void fail() const { walker_.fail("a compressed variable is broken"); }

  const Walker& walker_;
  z_stream stream_{};
};

/// Unpacks what one variable holds, having seen from its tag how much that is.
std::vector<std::byte> unpacked(const Walker& walker, Bytes packed) {
  Inflation inflation(walker, packed);
  std::array<std::byte, 8> tag;
  inflation.fill(tag);
  const std::size_t size = walker.word(tag, 1);
  if (walker.word(tag, 0) != matrix) walker.fail("a compressed variable is no array");
  if (size > max_variable_size || size > packed.size() * max_deflate_ratio)
    walker.fail("a compressed variable claims to be too large");
  std::vector<std::byte> bytes(size + 1);
  inflation.fill_to_end(bytes);
  bytes.pop_back();
  return bytes;
}

void check_variable(const Walker& walker, const Element& variable) {
  if (variable.type == compressed) {
    const std::vector<std::byte> bytes = unpacked(walker, variable.data);
    return check_array(walker.into(bytes), 0);
  }
  if (variable.type != matrix)
    walker.fail(fmt::format("data of type {} where a variable should be", variable.type));
  check_array(walker.into(variable.data), 0);
}

}  // namespace

void check_mat_structure(std::span<const std::byte> bytes, const std::string& file) {
  const auto text_at = [&](std::size_t from, std::size_t size) {
    return std::string_view(reinterpret_cast<const char*>(bytes.data()) + from, size);
  };
  if (bytes.size() < header_size || !text_at(0, 6).starts_with("MATLAB"))
    throw InputError(file, "is no MAT file of version 5 or 7; save it with MATLAB's save -v7");
  const std::string_view order = text_at(126, 2);
  if (order != "IM" && order != "MI") throw InputError(file, "is damaged: its header names no byte order");
  const bool swapped = (order == "IM") != (std::endian::native == std::endian::little);
  const int version = std::to_integer<int>(bytes[order == "IM" ? 125 : 124]);
  if (version != 1) throw InputError(file, fmt::format("is a MAT file of unknown version {}", version));

  Walker walker(bytes.subspan(header_size), swapped, file);
  if (walker.at_end()) throw InputError(file, "is a MAT file without variables");
  while (!walker.at_end()) check_variable(walker, walker.next(false));
}

}  // namespace petzval
