// SPDX-License-Identifier: BSD-3-Clause
// MATLAB variables, as matio hands them over.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct matvar_t;

namespace petzval {

/// A full real array of numbers of any MATLAB type, in MATLAB's order (the first index runs fastest).
class MatNumbers {
 public:
  std::size_t size() const { return size_; }
  const std::vector<std::size_t>& dimensions() const { return dimensions_; }
  double operator[](std::size_t index) const { return read_(data_, index); }
  /// Bits of an unsigned integer type, 0 for all others.
  int unsigned_bits() const { return unsigned_bits_; }
  std::vector<double> values() const;

 private:
  friend class MatValue;
  const void* data_ = nullptr;
  double (*read_)(const void*, std::size_t) = nullptr;
  std::size_t size_ = 0;
  std::vector<std::size_t> dimensions_;
  int unsigned_bits_ = 0;
};

/// A variable or a field of one, with its full name ("scene.data.photons") for messages. Valid as long as the
/// MatFile that it comes from.
class MatValue {
 public:
  MatValue(const matvar_t* variable, std::string name, const std::string& file)
      : variable_(variable), name_(std::move(name)), file_(&file) {}

  const std::string& name() const { return name_; }
  bool is_struct() const;
  /// A field of a 1 × 1 struct, if it is there and not empty. \throws InputError if this is no struct.
  std::optional<MatValue> find(const std::string& field) const;
  /// \throws InputError if the field is missing or empty.
  MatValue at(const std::string& field) const;

  /// \throws InputError unless it is a real, full array of numbers.
  MatNumbers numbers() const;
  /// \throws InputError unless it is one number.
  double number() const;
  /// Printable ASCII; other characters become '?'. Empty if this is no text.
  std::string text() const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  const matvar_t* variable_;
  std::string name_;
  const std::string* file_;
};

/// The variables of a MAT file: of version 5 or 7, read by matio after check_mat_structure has seen all of
/// it; of version 7.3, read through HDF5 in a process of its own (write_mat_hdf5_records), their numbers kept
/// in a file without a name that is mapped into memory.
class MatFile {
 public:
  /// Reads those of these variables that are there. \throws InputError for a damaged file.
  MatFile(const std::string& path, const std::vector<std::string>& variables);

  /// A variable that was asked for, if it is there and not empty.
  std::optional<MatValue> find(const std::string& variable) const;
  /// \throws InputError if it is not.
  MatValue at(const std::string& variable) const;
  /// The first of those that were asked for. \throws InputError if there is none of them.
  MatValue first() const;
  const std::string& path() const { return path_; }

 private:
  void read_matio();
  void read_hdf5();

  struct Free {
    void operator()(matvar_t* variable) const;
  };
  std::string path_;
  std::vector<std::string> names_;
  std::shared_ptr<void> records_;  ///< of version 7.3: where the numbers of the variables lie
  std::map<std::string, std::unique_ptr<matvar_t, Free>> variables_;
};

/// What the variables of a file of version 5 or 7 are called. Empty for one of version 7.3.
/// \throws InputError for a damaged file.
std::vector<std::string> mat_variable_names(const std::string& path);

}  // namespace petzval
