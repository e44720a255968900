// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/output_file.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

namespace petzval {

static_assert(std::endian::native == std::endian::little, "the .npy writer writes memory as it is");

namespace {

constexpr std::string_view magic{"\x93NUMPY", 6};
constexpr std::size_t max_dimensions = 32;  // NumPy's own limit

// ---- writing

/// Magic, version 1.0 and the header, padded with spaces so that the data start at a multiple of 64.
std::string header_bytes(std::string_view type, std::span<const std::size_t> shape) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}, ", size);
  if (shape.size() > 1) sizes.resize(sizes.size() - 2);
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  constexpr std::size_t before = 10;  // magic, two bytes of version, two of length
  dictionary.append(63 - (before + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  std::string bytes(magic);
  bytes += '\x01';
  bytes += '\x00';
  bytes += static_cast<char>(dictionary.size() & 0xff);
  bytes += static_cast<char>(dictionary.size() >> 8);
  return bytes + dictionary;
}

template <class Value>
void write_array(const std::string& path, std::string_view type, std::span<const std::size_t> shape,
                 std::span<const Value> values) {
  if (shape.size() > max_dimensions) throw InputError(path, "a .npy file has at most 32 dimensions");
  std::size_t count = 1;
  for (const std::size_t size : shape) count *= size;
  if (count != values.size())
    throw InputError(path, fmt::format("{} values for an array of {}", values.size(), count));
  OutputFile file(path);
  const std::string header = header_bytes(type, shape);
  file.write(header.data(), header.size());
  file.write(values.data(), values.size_bytes());
  file.commit();
}

// ---- reading

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
      if (error != std::errc{} || sizes.size() == max_dimensions) fail();
      text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
      sizes.push_back(size);
      if (!accept(',') && peek() != ')') fail();
    }
    return sizes;
  }

  std::string_view text_;
  const std::string& file_;
};

/// Splits a file into header text and data; `rest` is left at the data.
std::string_view take_header(std::string_view& rest, const std::string& path) {
  if (!rest.starts_with(magic) || rest.size() < 12) throw InputError(path, "is not a .npy file");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(rest[i]));
  };
  const std::size_t version = byte(6);
  if (version < 1 || version > 3)
    throw InputError(path, fmt::format(".npy version {}; 1 to 3 can be read", version));
  const std::size_t start = version == 1 ? 10 : 12;
  std::size_t length = byte(8) | byte(9) << 8;
  if (version > 1) length |= byte(10) << 16 | byte(11) << 24;
  if (length > rest.size() - start) throw InputError(path, "ends within its header");
  const std::string_view header = rest.substr(start, length);
  rest.remove_prefix(start + length);
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

template <class Value>
std::vector<Value> decoded(std::string_view data, std::size_t count, bool big_endian) {
  std::vector<Value> values(count);
  if (count > 0) std::memcpy(values.data(), data.data(), count * sizeof(Value));
  if (!big_endian || sizeof(Value) == 1) return values;
  for (Value& value : values) {
    auto bytes = std::bit_cast<std::array<std::byte, sizeof(Value)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    value = std::bit_cast<Value>(bytes);
  }
  return values;
}

/// Whole numbers become the smallest floating-point type that holds them all.
template <class Whole, class Value>
std::vector<Value> converted(std::string_view data, std::size_t count, bool big_endian) {
  const std::vector<Whole> whole = decoded<Whole>(data, count, big_endian);
  return {whole.begin(), whole.end()};
}

std::variant<std::vector<float>, std::vector<double>> any_decoded(std::string_view data, std::size_t count,
                                                                  std::string_view kind, bool big_endian) {
  if (kind == "f8") return decoded<double>(data, count, big_endian);
  if (kind == "f4") return decoded<float>(data, count, big_endian);
  if (kind == "u1") return converted<std::uint8_t, float>(data, count, big_endian);
  if (kind == "i1") return converted<std::int8_t, float>(data, count, big_endian);
  if (kind == "u2") return converted<std::uint16_t, float>(data, count, big_endian);
  if (kind == "i2") return converted<std::int16_t, float>(data, count, big_endian);
  if (kind == "u4") return converted<std::uint32_t, double>(data, count, big_endian);
  return converted<std::int32_t, double>(data, count, big_endian);
}

}  // namespace

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const float> values) {
  write_array(path, "<f4", shape, values);
}

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const double> values) {
  write_array(path, "<f8", shape, values);
}

void write_npy(const std::string& path, const SpectralImage& image) {
  const auto rows = static_cast<std::size_t>(image.rows()),
             columns = static_cast<std::size_t>(image.columns());
  const auto bands = static_cast<std::size_t>(image.bands());
  const std::size_t shape[] = {rows, columns, bands};
  OutputFile file(path);
  const std::string header = header_bytes("<f4", shape);
  file.write(header.data(), header.size());
  std::vector<float> line(columns * bands);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t band = 0; band < bands; ++band) {
      const std::span<const float> source =
          image.band(static_cast<int>(band)).subspan(row * columns, columns);
      for (std::size_t column = 0; column < columns; ++column) line[column * bands + band] = source[column];
    }
    file.write(line.data(), line.size() * sizeof(float));
    constexpr std::size_t rows_kept = 64;
    if (row % rows_kept == 0) image.release_memory();
  }
  file.commit();
}

NpyArray read_npy(const std::string& path) {
  const std::string bytes = read_whole_file(path, std::size_t{1} << 34);
  std::string_view data = bytes;
  HeaderParser header(take_header(data, path), path);
  header.parse();
  // "<f4": byte order ('|' where there is none), kind, size.
  const std::string_view type = header.type;
  const std::string_view kind = type.size() == 3 ? type.substr(1) : std::string_view();
  const bool known = kind == "f4" || kind == "f8" || kind == "u1" || kind == "i1" || kind == "u2" ||
                     kind == "i2" || kind == "u4" || kind == "i4";
  if (!known || (type[0] != '<' && type[0] != '>' && type[0] != '|'))
    throw InputError(path,
                     fmt::format("has values of type '{}'; save it as float32 or float64", quotable(type)));
  if (*header.fortran_order && header.shape->size() > 1)
    throw InputError(path, "is in Fortran order; save numpy.ascontiguousarray(a) instead");
  NpyArray array{std::move(*header.shape), {}};
  const auto size = static_cast<std::size_t>(kind[1] - '0');
  array.values = any_decoded(data, checked_count(array.shape, size, data.size(), path), kind, type[0] == '>');
  return array;
}

}  // namespace petzval
