// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/formats/npy_file.h>

#include <Imath/half.h>
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

namespace petzval {

namespace {

constexpr std::size_t block_values = 1 << 20;  // read at a time
constexpr std::uintmax_t max_bytes = std::uintmax_t{1} << 34;

/// Reads the header's Python dictionary, of which NEP 1 fixes keys and value types.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::string type;
  std::optional<bool> fortran_order;
  std::optional<std::vector<std::size_t>> shape;

  void parse() {
    expect('{');
    while (!accept('}')) {
      const std::string key = quoted();
      expect(':');
      if (key == "descr")
        type = quoted();
      else if (key == "fortran_order")
        fortran_order = boolean();
      else if (key == "shape")
        shape = tuple();
      else
        fail();
      if (!accept(',') && peek() != '}') fail();
    }
    if (type.empty() || !fortran_order || !shape) fail();
  }

 private:
  [[noreturn]] void fail() const { throw InputError(file_, "the header of this .npy file is damaged"); }

  char peek() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n')) text_.remove_prefix(1);
    return text_.empty() ? '\0' : text_.front();
  }
  bool accept(char c) {
    if (peek() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail();
  }
  std::string quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail();
    const std::size_t end = text_.find(quote, 1);
    if (end == std::string_view::npos) fail();
    const std::string word(text_.substr(1, end - 1));
    text_.remove_prefix(end + 1);
    return word;
  }
  bool boolean() {
    peek();
    for (const auto& [word, value] :
         {std::pair{std::string_view("True"), true}, {std::string_view("False"), false}})
      if (text_.starts_with(word)) {
        text_.remove_prefix(word.size());
        return value;
      }
    fail();
  }
  std::vector<std::size_t> tuple() {
    std::vector<std::size_t> sizes;
    expect('(');
    while (!accept(')')) {
      peek();
      std::size_t size = 0;
      const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), size);
      if (error != std::errc{} || sizes.size() == npy_max_dimensions) fail();
      text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
      sizes.push_back(size);
      if (!accept(',') && peek() != ')') fail();
    }
    return sizes;
  }

  std::string_view text_;
  const std::string& file_;
};

/// The header's text, leaving the file at the data.
std::string read_header(std::istream& file, const std::string& path) {
  std::array<unsigned char, 12> start{};
  const auto fill = [&](std::size_t from, std::size_t count) {
    file.read(reinterpret_cast<char*>(start.data()) + from, static_cast<std::streamsize>(count));
    return file.gcount() == static_cast<std::streamsize>(count);
  };
  if (!fill(0, 10) || std::memcmp(start.data(), npy_magic.data(), npy_magic.size()) != 0)
    throw InputError(path, "is not a .npy file");
  const int version = start[6];
  if (version < 1 || version > 3)
    throw InputError(path, fmt::format(".npy version {}; 1 to 3 can be read", version));
  if (version > 1 && !fill(10, 2)) throw InputError(path, "is not a .npy file");
  std::size_t length = start[8] | std::size_t{start[9]} << 8;
  if (version > 1) length |= std::size_t{start[10]} << 16 | std::size_t{start[11]} << 24;
  // NumPy refuses headers of more than 10,000 characters.
  constexpr std::size_t longest = 1 << 16;
  std::string header(std::min(length, longest), '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (length > longest || file.gcount() != static_cast<std::streamsize>(length))
    throw InputError(path, "ends within its header");
  return header;
}

/// Number of values, checked against the bytes that are there.
std::size_t checked_count(const std::vector<std::size_t>& shape, std::size_t value_size, std::size_t bytes,
                          const std::string& path) {
  // A zero anywhere makes the array empty, whatever the other sizes.
  std::size_t count = std::find(shape.begin(), shape.end(), std::size_t{0}) == shape.end() ? 1 : 0;
  for (const std::size_t size : shape) {
    if (count > 0 && size > std::numeric_limits<std::size_t>::max() / value_size / count)
      throw InputError(path, "its shape is larger than any file");
    count *= size;
  }
  if (count * value_size != bytes)
    throw InputError(
        path, fmt::format("its shape needs {} bytes, but the file holds {}", count * value_size, bytes));
  return count;
}

/// Sixteen bits that are a half-precision number.
struct Half {
  std::uint16_t bits;
  explicit operator float() const { return imath_half_to_float(bits); }
  explicit operator double() const { return double{imath_half_to_float(bits)}; }
};

/// NumPy's real numbers, by kind and size.
constexpr std::array<std::string_view, 11> known_kinds = {"f2", "f4", "f8", "u1", "i1", "u2",
                                                          "i2", "u4", "i4", "u8", "i8"};

template <class Stored, class Value>
void decode(const char* bytes, bool big_endian, std::span<Value> values) {
  for (Value& value : values) {
    std::array<std::byte, sizeof(Stored)> one;
    std::memcpy(one.data(), bytes, sizeof(Stored));
    bytes += sizeof(Stored);
    if (big_endian) std::reverse(one.begin(), one.end());
    value = static_cast<Value>(std::bit_cast<Stored>(one));
  }
}

template <class Value>
void decode(std::string_view kind, const char* bytes, bool big_endian, std::span<Value> values) {
  if (kind == "f8") return decode<double>(bytes, big_endian, values);
  if (kind == "f4") return decode<float>(bytes, big_endian, values);
  if (kind == "f2") return decode<Half>(bytes, big_endian, values);
  if (kind == "u1") return decode<std::uint8_t>(bytes, big_endian, values);
  if (kind == "i1") return decode<std::int8_t>(bytes, big_endian, values);
  if (kind == "u2") return decode<std::uint16_t>(bytes, big_endian, values);
  if (kind == "i2") return decode<std::int16_t>(bytes, big_endian, values);
  if (kind == "u4") return decode<std::uint32_t>(bytes, big_endian, values);
  if (kind == "i4") return decode<std::int32_t>(bytes, big_endian, values);
  if (kind == "u8") return decode<std::uint64_t>(bytes, big_endian, values);
  decode<std::int64_t>(bytes, big_endian, values);
}

}  // namespace

NpyFile::NpyFile(const std::string& path)
    : path_(path), file_(std::make_unique<std::ifstream>(path, std::ios::binary)) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path, "is a folder, not a file");
  if (!*file_) throw InputError(path, "cannot be read; is it there?");
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error || bytes > max_bytes) throw InputError(path, "is no file, or larger than 16 GiB");
  open(static_cast<std::size_t>(bytes));
}

NpyFile::NpyFile(std::string bytes, const std::string& name) : path_(name) {
  const std::size_t size = bytes.size();
  file_ = std::make_unique<std::istringstream>(std::move(bytes), std::ios::binary);
  open(size);
}

void NpyFile::open(std::size_t bytes) {
  const std::string text = read_header(*file_, path_);
  HeaderParser header(text, path_);
  header.parse();
  // "<f4": byte order ('|' where there is none), kind, size.
  const std::string& type = header.type;
  kind_ = type.size() == 3 ? type.substr(1) : std::string();
  const bool known = std::find(known_kinds.begin(), known_kinds.end(), kind_) != known_kinds.end();
  if (!known || (type[0] != '<' && type[0] != '>' && type[0] != '|'))
    throw InputError(path_,
                     fmt::format("has values of type '{}'; save it as float32 or float64", quotable(type)));
  fortran_order_ = *header.fortran_order && header.shape->size() > 1;
  shape_ = std::move(*header.shape);
  value_bytes_ = static_cast<std::size_t>(kind_[1] - '0');
  big_endian_ = type[0] == '>';
  start_ = static_cast<std::size_t>(file_->tellg());
  size_ = checked_count(shape_, value_bytes_, bytes - start_, path_);
}

bool NpyFile::needs_double() const {
  return value_bytes_ == 8 || kind_ == "u4" || kind_ == "i4";
}

template <class Value>
void NpyFile::read_values(std::size_t first, std::span<Value> values) const {
  file_->clear();
  file_->seekg(static_cast<std::streamoff>(start_ + first * value_bytes_));
  for (std::size_t done = 0; done < values.size();) {
    const std::span<Value> block = values.subspan(done, std::min(block_values, values.size() - done));
    buffer_.resize(block.size() * value_bytes_);
    file_->read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (file_->gcount() != static_cast<std::streamsize>(buffer_.size()))
      throw InputError(path_, "became shorter while it was read");
    decode(kind_, buffer_.data(), big_endian_, block);
    done += block.size();
  }
}

void NpyFile::read(std::size_t first, std::span<float> values) const {
  read_values(first, values);
}

void NpyFile::read(std::size_t first, std::span<double> values) const {
  read_values(first, values);
}

}  // namespace petzval
