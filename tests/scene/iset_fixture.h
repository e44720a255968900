// SPDX-License-Identifier: BSD-3-Clause
// ISET scene files as MATLAB would write them, made with matio.
#pragma once

#include <gtest/gtest.h>
#include <matio.h>
#include <petzval/base/whole_file.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace petzval::test {

/// A MATLAB struct in the making; owns what it is given.
class MatStruct {
 public:
  explicit MatStruct(const char* name) {
    std::size_t one[2] = {1, 1};
    variable_ = Mat_VarCreateStruct(name, 2, one, nullptr, 0);
  }
  MatStruct& add(const char* field, matvar_t* value) {
    Mat_VarAddStructField(variable_, field);
    Mat_VarSetStructFieldByName(variable_, field, 0, value);
    return *this;
  }
  template <typename Number>
  MatStruct& array(const char* field, matio_classes kind, matio_types type,
                   std::vector<std::size_t> dimensions, std::vector<Number> values) {
    return add(field, Mat_VarCreate(field, kind, type, static_cast<int>(dimensions.size()), dimensions.data(),
                                    values.data(), 0));
  }
  MatStruct& number(const char* field, double value) {
    return array<double>(field, MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 1}, {value});
  }
  MatStruct& text(const char* field, const std::string& value) {
    return array<char>(field, MAT_C_CHAR, MAT_T_UINT8, {1, value.size()}, {value.begin(), value.end()});
  }
  MatStruct& nested(const char* field, const MatStruct& other) { return add(field, other.variable_); }
  matvar_t* variable() const { return variable_; }

 private:
  matvar_t* variable_;
};

/// The same file with its one variable packed as MATLAB does it. (matio 1.5.23 packs too, but writes wrong
/// sizes for texts.)
inline std::string packed_mat(const std::string& plain) {
  constexpr std::size_t header = 128;
  const auto* variable = reinterpret_cast<const Bytef*>(plain.data() + header);
  uLongf size = compressBound(plain.size() - header);
  std::string packed(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, variable, plain.size() - header), Z_OK);
  const std::uint32_t tag[2] = {15, static_cast<std::uint32_t>(size)};
  return plain.substr(0, header) + std::string(reinterpret_cast<const char*>(tag), 8) +
         packed.substr(0, size);
}

/// Writes a file of one variable, and returns its bytes.
inline std::string write_mat(const std::string& path, const MatStruct& variable, bool compressed) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  EXPECT_EQ(Mat_VarWrite(file, variable.variable(), MAT_COMPRESSION_NONE), 0);
  Mat_Close(file);
  Mat_VarFree(variable.variable());
  const std::string plain = read_whole_file(path);
  if (!compressed) return plain;
  std::ofstream(path, std::ios::binary) << packed_mat(plain);
  return packed_mat(plain);
}

constexpr int iset_rows = 2, iset_columns = 3, iset_bands = 2;
constexpr double iset_least = 1e15, iset_greatest = 1e15 + 65535e11;  // a step of 1e11 photons

/// The stored number at a place: different everywhere, so that no two axes can be exchanged unseen.
constexpr std::uint16_t iset_stored(int row, int column, int band) {
  return static_cast<std::uint16_t>(1000 * band + 100 * column + 10 * row);
}

/// In MATLAB's order: rows fastest, then columns, then bands.
template <typename Number>
std::vector<Number> iset_cube() {
  std::vector<Number> cube;
  for (int band = 0; band < iset_bands; ++band)
    for (int column = 0; column < iset_columns; ++column)
      for (int row = 0; row < iset_rows; ++row) cube.push_back(iset_stored(row, column, band));
  return cube;
}

inline MatStruct iset_wave() {
  return std::move(
      MatStruct("spectrum").array<double>("wave", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 2}, {500, 600}));
}

inline MatStruct iset_data() {
  return std::move(MatStruct("data")
                       .array("photons", MAT_C_UINT16, MAT_T_UINT16, {iset_rows, iset_columns, iset_bands},
                              iset_cube<std::uint16_t>())
                       .number("dmin", iset_least)
                       .number("dmax", iset_greatest)
                       .number("bitDepth", 16));
}

inline MatStruct iset_scene_with(const MatStruct& data) {
  return std::move(MatStruct("scene")
                       .text("name", "small")
                       .nested("data", data)
                       .nested("spectrum", iset_wave())
                       .number("wAngular", 12)
                       .number("distance", 1.5));
}

inline MatStruct iset_scene() {
  return std::move(iset_scene_with(iset_data())
                       .array<double>("depthMap", MAT_C_DOUBLE, MAT_T_DOUBLE, {iset_rows, iset_columns},
                                      {1.1, 2.1, 1.2, 2.2, 1.3, 2.3}));
}

}  // namespace petzval::test
