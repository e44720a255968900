// SPDX-License-Identifier: BSD-3-Clause
// The packed catalogue file (data/glass/README.md describes its bytes).
#pragma once

#include <petzval/glass/material.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// A packed catalogue in memory: its names are read at once, a glass when it is asked for. Nothing in the
/// file is believed: the checksum guards against damage, and every count and offset is held against the size
/// all the same.
class PackedCatalogue {
 public:
  /// A name of a glass; a glass may have several, one of them proper.
  struct Name {
    std::string full;    ///< "SCHOTT:N-BK7"
    std::string folded;  ///< upper case, for comparison
    std::size_t glass;   ///< number of the glass
    bool proper = false;

    std::string_view folded_catalogue() const { return std::string_view(folded).substr(0, folded.find(':')); }
    std::string_view folded_bare() const { return std::string_view(folded).substr(folded.find(':') + 1); }
  };

  /// \param file  what to call it in errors. \throws InputError if the bytes are not a whole packed
  /// catalogue.
  PackedCatalogue(std::string bytes, std::string file);

  std::size_t glass_count() const { return records_.size(); }
  /// Sorted by `folded`, which are unique.
  const std::vector<Name>& names() const { return names_; }
  /// \throws InputError if the record makes no sense.
  Glass glass(std::size_t number) const;

 private:
  void read_names(class ByteReader& reader, std::size_t count, std::size_t glass_count);
  void read_records(class ByteReader& reader, std::size_t count);

  struct Record {
    std::size_t offset, size, name;
  };
  std::string bytes_, file_;
  std::vector<Name> names_;
  std::vector<Record> records_;
};

/// A to Z for a to z; other bytes stay.
std::string upper_case(std::string_view text);

}  // namespace petzval
