// SPDX-License-Identifier: BSD-3-Clause
// NumPy's array files, read piece by piece.
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

inline constexpr std::string_view npy_magic{"\x93NUMPY", 6};
inline constexpr std::size_t npy_max_dimensions = 32;  ///< NumPy's own limit

/// An open .npy file of floating-point numbers of 16 to 64 bits or whole numbers of 8 to 64 bits, of either
/// byte order, in C or Fortran order, whose header and size are right.
class NpyFile {
 public:
  /// \throws InputError as read_npy().
  explicit NpyFile(const std::string& path);
  /// The same bytes out of something else. \param name  for messages.
  NpyFile(std::string bytes, const std::string& name);

  const std::vector<std::size_t>& shape() const { return shape_; }
  /// Of all values.
  std::size_t size() const { return size_; }
  /// Whether single precision does not hold all numbers of this type.
  bool needs_double() const;
  /// Whether values lie with the first index running fastest; else the last one does.
  bool fortran_order() const { return fortran_order_; }

  /// The values from `first` on, as they lie, which must be there. Not from two threads at once. \throws
  /// InputError for a file that has become shorter.
  void read(std::size_t first, std::span<float> values) const;
  void read(std::size_t first, std::span<double> values) const;

 private:
  void open(std::size_t bytes);
  template <class Value>
  void read_values(std::size_t first, std::span<Value> values) const;

  std::string path_;
  std::unique_ptr<std::istream> file_;
  mutable std::vector<char> buffer_;
  std::vector<std::size_t> shape_;
  std::string kind_;  ///< "f4", "u2" ...
  std::size_t value_bytes_ = 0, start_ = 0, size_ = 0;
  bool big_endian_ = false, fortran_order_ = false;
};

}  // namespace petzval
