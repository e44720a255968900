// SPDX-License-Identifier: BSD-3-Clause
// A .zmx file as records, before any of them is understood.
#pragma once

#include <string>
#include <vector>

namespace petzval {

struct ZmxRecord {
  int line = 0;
  std::string keyword;
  std::vector<std::string> values;
  std::string rest;  ///< the values as they stand in the file

  bool has(std::size_t i) const { return i < values.size(); }
};

struct ZmxBlock {
  int number = -1;  ///< of the surface; −1: the header
  int line = 0;
  std::vector<ZmxRecord> records;

  /// The last record with this keyword, which is the one that counts.
  const ZmxRecord* find(const char* keyword) const;
};

struct ZmxFile {
  std::string name;
  ZmxBlock header;
  std::vector<ZmxBlock> surfaces;   ///< 0 is the object, the last one the image
  std::vector<ZmxRecord> operands;  ///< behind MNUM: what the configurations set, one value each

  /// "SURF 5: " and so on before the message. \throws InputError with file and line.
  [[noreturn]] void fail(const ZmxBlock& block, int line, const std::string& message) const;
  /// The i-th value of a record as a number. \throws InputError unless it is finite.
  double number(const ZmxBlock& block, const ZmxRecord& record, std::size_t i) const;
  double number_or(const ZmxBlock& block, const ZmxRecord& record, std::size_t i, double otherwise) const;
};

/// Records of surfaces are indented; what follows the last surface without indent (merit function,
/// tolerances) says nothing about the lens as it stands and is left out, but for the configurations: their
/// number, MNUM, joins the header, and what stands behind it are their operands. \throws InputError unless
/// the surfaces are numbered from 0 on and there are at least three.
ZmxFile zmx_records(const std::string& text, const std::string& file);

}  // namespace petzval
