// SPDX-License-Identifier: BSD-3-Clause
// MATLAB variables on their way from one process to another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

struct matvar_t;

namespace petzval {

/// What a record holds: numbers and texts with their data, a 1 × 1 struct with the records of its fields
/// behind it, an empty array, or something that is not read.
enum class MatRecordKind : std::uint64_t { numbers = 1, text, structure, nothing, other };

/// One record of a file of records. Every part of it fills multiples of eight bytes.
struct MatRecord {
  MatRecordKind kind = MatRecordKind::other;
  std::string name;
  std::uint64_t class_type = 0, data_type = 0;  ///< matio's matio_classes and matio_types
  std::vector<std::uint64_t> dimensions;        ///< of numbers and texts, in MATLAB's order
  std::uint64_t bytes = 0;                      ///< of the data that follow, without padding
  std::uint64_t fields = 0;                     ///< records of a structure that follow
};

/// Writes records, and data in the order of the file. \throws Failure when the disk is full.
class MatRecordWriter {
 public:
  explicit MatRecordWriter(int descriptor) : descriptor_(descriptor) {}
  void begin(const MatRecord& record);
  void data(std::span<const std::byte> bytes);
  void end();  ///< of the data of a record

 private:
  int descriptor_;
  std::size_t written_ = 0;
};

/// The variable of the next record and of those that belong to it, which `rest` then lies behind. Its numbers
/// stay where they are, and must live as long as it does. Null, with `rest` as it was, if the records are not
/// sound.
matvar_t* variable_of_records(std::span<std::byte>& rest);

}  // namespace petzval
