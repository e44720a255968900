// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <matio.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/scene/formats/mat_writer.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

namespace petzval {

namespace {

constexpr std::size_t text_header_size = 128, tag_size = 8;
constexpr std::uint32_t compressed_type = 15;
constexpr double bytes_per_gib = 1 << 30;

struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

Variable checked(matvar_t* variable) {
  if (!variable) throw Failure("matio cannot put the variable together");
  return Variable(variable);
}

Variable variable_of(const std::string& name, const MatItem& item);

// matio takes data that it may alter, and copies them.
Variable variable_of(const std::string& name, const std::string& text) {
  std::size_t dimensions[2] = {text.empty() ? 0U : 1U, text.size()};
  return checked(
      Mat_VarCreate(name.c_str(), MAT_C_CHAR, MAT_T_UINT8, 2, dimensions, const_cast<char*>(text.data()), 0));
}

Variable variable_of(const std::string& name, const MatDoubles& numbers) {
  std::vector<std::size_t> dimensions = numbers.dimensions;
  return checked(Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, static_cast<int>(dimensions.size()),
                               dimensions.data(), const_cast<double*>(numbers.values.data()), 0));
}

Variable variable_of(const std::string& name, const MatItem::Fields& fields) {
  std::vector<const char*> names;
  for (const auto& field : fields) names.push_back(field.first.c_str());
  std::size_t one[2] = {1, 1};
  Variable variable =
      checked(Mat_VarCreateStruct(name.c_str(), 2, one, names.data(), static_cast<unsigned>(names.size())));
  for (const auto& [field, item] : fields)
    Mat_VarSetStructFieldByName(variable.get(), field.c_str(), 0, variable_of(field, item).release());
  return variable;
}

Variable variable_of(const std::string& name, const MatItem& item) {
  return std::visit([&](const auto& value) { return variable_of(name, value); }, item.value);
}

double bytes_of(const MatItem& item) {
  if (const auto* numbers = std::get_if<MatDoubles>(&item.value)) return 8.0 * double(numbers->values.size());
  if (const auto* text = std::get_if<std::string>(&item.value)) return double(text->size());
  double sum = 0;
  for (const auto& field : std::get<MatItem::Fields>(item.value)) sum += bytes_of(field.second);
  return sum;
}

/// The variable deflated as MATLAB does it. matio packs too, but writes wrong sizes for texts.
std::string packed(std::string_view plain) {
  const std::string_view variable = plain.substr(text_header_size);
  uLongf size = compressBound(variable.size());
  std::string bytes(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(variable.data()),
               variable.size()) != Z_OK)
    throw Failure("the variable cannot be packed");
  const std::uint32_t tag[2] = {compressed_type, static_cast<std::uint32_t>(size)};
  std::string file(plain.substr(0, text_header_size));
  file.append(reinterpret_cast<const char*>(tag), tag_size).append(bytes, 0, size);
  return file;
}

}  // namespace

void write_mat(const std::string& path, const std::string& name, const MatItem& item) {
  constexpr double most_bytes = 0.99 * INT32_MAX;
  if (const double bytes = bytes_of(item); bytes > most_bytes)
    throw InputError(path, fmt::format("would hold {:.3g} GiB of numbers; a MAT file of version 5 holds 2",
                                       bytes / bytes_per_gib));
  WholeFile whole(path);
  {
    const Variable variable = variable_of(name, item);
    const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(
        Mat_CreateVer(whole.temporary_path().c_str(), "MATLAB 5.0 MAT-file, written by Petzval", MAT_FT_MAT5),
        &Mat_Close);
    if (!file || Mat_VarWrite(file.get(), variable.get(), MAT_COMPRESSION_NONE) != 0)
      throw Failure(path + ": cannot be written");
  }
  const std::string bytes = packed(read_whole_file(whole.temporary_path()));
  write_whole_file(path, bytes);
}

}  // namespace petzval
