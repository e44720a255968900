// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/render/materials/tensor_file.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace petzval::render {

namespace {

using namespace std::literals;

constexpr int float_type = 10;
/// No density of facets that is worth a table comes near to it, and products of a few stay floats.
constexpr float largest_value = 1e9f;
constexpr std::array<std::size_t, 12> bytes_of_type{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

/// Takes numbers from the front of bytes.
class TensorHeader {
 public:
  TensorHeader(std::string_view bytes, const std::string& name) : left_(bytes), name_(name) {}
  std::string_view text(std::size_t size) {
    if (size > left_.size()) throw InputError(name_, "ends within the list of its fields");
    const std::string_view result = left_.substr(0, size);
    left_.remove_prefix(size);
    return result;
  }
  std::uint64_t number(std::size_t size) {
    std::uint64_t result = 0;
    const std::string_view digits = text(size);
    for (std::size_t i = 0; i < size; ++i)
      result |= static_cast<std::uint64_t>(static_cast<unsigned char>(digits[i])) << (8 * i);
    return result;
  }

 private:
  std::string_view left_;
  const std::string& name_;
};

}  // namespace

TensorFile::TensorFile(std::string_view bytes, std::string name) : name_(std::move(name)) {
  if (!bytes.starts_with("tensor_file\0"sv))
    throw InputError(name_,
                     "is no tensor file; .bsdf files of measured materials begin with \"tensor_file\"");
  TensorHeader header(bytes.substr(12), name_);
  if (header.number(2) != 1) throw InputError(name_, "is a tensor file of a version other than 1.0");
  for (std::uint64_t left = header.number(4); left > 0; --left) {
    const std::string field(header.text(header.number(2)));
    const std::uint64_t dimensions = header.number(2);
    Field read{static_cast<int>(header.number(1)), {}, {}};
    if (read.type < 1 || read.type >= static_cast<int>(bytes_of_type.size()))
      throw InputError(name_,
                       fmt::format("field {} is of type {}, which there is not", fields_.size(), read.type));
    const std::uint64_t offset = header.number(8);
    std::uint64_t size = bytes_of_type[static_cast<std::size_t>(read.type)];
    bool fits = offset <= bytes.size();
    for (std::uint64_t i = 0; i < dimensions; ++i) {
      const std::uint64_t each = header.number(8);
      read.shape.push_back(each);
      fits = fits && (each == 0 || size <= bytes.size() / each);
      size = fits ? size * each : 0;
    }
    if (!fits || size > bytes.size() - offset)
      throw InputError(name_,
                       fmt::format("the values of field {} go beyond the end of the file", fields_.size()));
    read.values = bytes.substr(offset, size);
    fields_.insert_or_assign(field, std::move(read));
  }
}

FloatTensor TensorFile::floats(const std::string& field, std::size_t dimensions) const {
  const auto found = fields_.find(field);
  if (found == fields_.end()) throw InputError(name_, fmt::format("has no field \"{}\"", field));
  const Field& read = found->second;
  if (read.type != float_type || read.shape.size() != dimensions || read.values.empty())
    throw InputError(name_, fmt::format("field \"{}\" must hold floats along {} dimension{}", field,
                                        dimensions, dimensions == 1 ? "" : "s"));
  FloatTensor result{read.shape, std::vector<float>(read.values.size() / sizeof(float))};
  std::memcpy(result.values.data(), read.values.data(), read.values.size());
  for (const float each : result.values)
    if (!(std::abs(each) <= largest_value))
      throw InputError(name_,
                       fmt::format("field \"{}\" holds a number that is not finite or beyond 1e9", field));
  return result;
}

}  // namespace petzval::render
