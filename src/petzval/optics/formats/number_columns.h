// SPDX-License-Identifier: BSD-3-Clause
// CSV files of numbers: comment lines `# key: value`, a line of column names, lines of numbers.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

class NumberColumns {
 public:
  /// Commas, semicolons or tabs part the columns. \param file  for messages.
  /// \throws InputError with file and line: no column names, a line of another length, what is no finite
  /// number.
  NumberColumns(std::string_view text, std::string file);

  const std::string& file() const { return file_; }
  std::size_t rows() const { return lines_.size(); }
  bool has(const std::string& column) const;
  /// \throws InputError naming the columns that are wanted, if this one is missing.
  const std::vector<double>& column(const std::string& name) const;
  /// What a comment line says behind "key:"; empty if there is none.
  std::string text(const std::string& key) const;
  /// \throws InputError if it is no number.
  std::optional<double> number(const std::string& key) const;

  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail(std::size_t row, const std::string& what) const;

 private:
  std::string file_;
  std::map<std::string, std::string> keys_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  std::vector<int> lines_;
};

}  // namespace petzval
