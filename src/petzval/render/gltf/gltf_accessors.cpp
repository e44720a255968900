// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/gltf/gltf_accessors.h>

#include <algorithm>
#include <cstring>

namespace petzval::render {

namespace {

/// Where numbers lie in a buffer view.
struct Rows {
  std::span<const unsigned char> bytes;
  std::size_t offset = 0, stride = 0, count = 0, components = 0;
  int component_type = 0;
  bool normalised = false;
};

template <class Number>
double read_as(const unsigned char* bytes, bool normalised) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);  // little-endian, as every machine that this runs on
  const auto number = static_cast<double>(value);
  if constexpr (std::is_integral_v<Number>)
    if (normalised) return std::max(number / static_cast<double>(std::numeric_limits<Number>::max()), -1.0);
  return number;
}

double read_number(const unsigned char* bytes, int type, bool normalised) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return read_as<std::int8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return read_as<std::uint8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return read_as<std::int16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read_as<std::uint16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return read_as<std::uint32_t>(bytes, normalised);
    default:
      return read_as<float>(bytes, false);
  }
}

/// \throws InputError unless all rows lie in the bytes. \param path  of the accessor.
void check(const GltfFile& file, Rows& rows, const std::string& path) {
  switch (rows.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      break;
    default:
      throw scene_error(file.at(path + ".componentType"),
                        fmt::format("{} is no type of numbers in glTF 2.0", rows.component_type));
  }
  const std::size_t row = rows.components * static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(
                                                static_cast<std::uint32_t>(rows.component_type)));
  if (rows.stride == 0) rows.stride = row;
  const std::size_t size = rows.bytes.size();
  if (rows.stride < row)
    throw scene_error(file.at(path),
                      fmt::format("its rows are {} bytes long, and {} apart", row, rows.stride));
  const bool fits = rows.offset <= size &&
                    (rows.count == 0 || (row <= size - rows.offset &&
                                         rows.count - 1 <= (size - rows.offset - row) / rows.stride));
  if (!fits)
    throw scene_error(file.at(path),
                      fmt::format("{} rows of {} bytes from byte {} are more than the {} of its view",
                                  rows.count, row, rows.offset, size));
}

GltfNumbers read_rows(const Rows& rows) {
  GltfNumbers numbers{rows.count, rows.components, {}};
  numbers.values.reserve(rows.count * rows.components);
  const auto size = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(rows.component_type)));
  for (std::size_t i = 0; i < rows.count; ++i)
    for (std::size_t c = 0; c < rows.components; ++c)
      numbers.values.push_back(read_number(rows.bytes.data() + rows.offset + i * rows.stride + c * size,
                                           rows.component_type, rows.normalised));
  return numbers;
}

std::size_t unsigned_of(const GltfFile& file, int value, const std::string& path) {
  if (value < 0) throw scene_error(file.at(path), fmt::format("{}; 0 or more would be right", value));
  return static_cast<std::size_t>(value);
}

/// Rows that stand in for others.
void substitute(const GltfFile& file, const tinygltf::Accessor& accessor, const std::string& path,
                GltfNumbers& numbers) {
  const auto& sparse = accessor.sparse;
  const std::string place = path + ".sparse";
  Rows where{file.view(sparse.indices.bufferView, place + ".indices.bufferView"),
             unsigned_of(file, sparse.indices.byteOffset, place + ".indices.byteOffset"),
             0,
             unsigned_of(file, sparse.count, place + ".count"),
             1,
             sparse.indices.componentType,
             false};
  check(file, where, place + ".indices");
  Rows what{file.view(sparse.values.bufferView, place + ".values.bufferView"),
            unsigned_of(file, sparse.values.byteOffset, place + ".values.byteOffset"),
            0,
            where.count,
            numbers.components,
            accessor.componentType,
            accessor.normalized};
  check(file, what, place + ".values");
  const GltfNumbers indices = read_rows(where), values = read_rows(what);
  for (std::size_t i = 0; i < where.count; ++i) {
    if (!(indices.values[i] >= 0 && indices.values[i] < static_cast<double>(numbers.count)))
      throw scene_error(file.at(place + ".indices"), fmt::format("names row {}; there are {}, counted from 0",
                                                                 indices.values[i], numbers.count));
    std::copy_n(
        values.values.begin() + static_cast<std::ptrdiff_t>(i * numbers.components), numbers.components,
        numbers.values.begin() +
            static_cast<std::ptrdiff_t>(static_cast<std::size_t>(indices.values[i]) * numbers.components));
  }
}

}  // namespace

GltfNumbers read_accessor(const GltfFile& file, int index, std::size_t components, const std::string& path) {
  const tinygltf::Accessor& accessor = file.entry(file.model.accessors, index, "accessors", path);
  const std::string place = fmt::format("accessors[{}]", index);
  const int given = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (given != static_cast<int>(components))
    throw scene_error(file.at(path), fmt::format("accessors[{}] has {} numbers a row; {} would be right",
                                                 index, given, components));
  if (accessor.bufferView < 0)
    throw scene_error(file.at(place),
                      "has no bufferView, so all its numbers would be 0; a bufferView would be right");
  const std::span<const unsigned char> bytes = file.view(accessor.bufferView, place + ".bufferView");
  Rows rows{bytes,
            accessor.byteOffset,
            file.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride,
            accessor.count,
            components,
            accessor.componentType,
            accessor.normalized};
  check(file, rows, place);
  GltfNumbers numbers = read_rows(rows);
  if (accessor.sparse.isSparse) substitute(file, accessor, place, numbers);
  return numbers;
}

}  // namespace petzval::render
