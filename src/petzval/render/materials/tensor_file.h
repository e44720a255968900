// SPDX-License-Identifier: BSD-3-Clause
// Files of named arrays, as in the material database of the Realistic Graphics Lab, EPFL
// (rgl.epfl.ch/materials).
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::render {

/// An array of floats, last index fastest.
struct FloatTensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

/// The fields of a file: "tensor_file" and a zero byte; version 1, 0 (one byte each); the number of fields (4
/// bytes); of each field the length of its name (2), the name, the number of its dimensions (2), its type (1:
/// 1 to 9 integers and halves, 10 float, 11 double), where its values begin (8) and its shape (8 each). All
/// little-endian.
class TensorFile {
 public:
  /// \param bytes  which must outlive this. \param name  for messages. \throws InputError "<name>: …" for
  /// anything else, and for fields that are not all in the file.
  TensorFile(std::string_view bytes, std::string name);

  bool has(const std::string& field) const { return fields_.contains(field); }
  /// \throws InputError unless there is such a field of float, with so many dimensions, at least one value
  /// and none beyond ±1e9.
  FloatTensor floats(const std::string& field, std::size_t dimensions) const;

 private:
  struct Field {
    int type;
    std::vector<std::size_t> shape;
    std::string_view values;
  };
  std::string name_;
  std::map<std::string, Field> fields_;
};

}  // namespace petzval::render
