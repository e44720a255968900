// SPDX-License-Identifier: BSD-3-Clause
// What a CODE V file says of the use of a lens: unit, aperture, fields, wavelengths.
#pragma once

#include <petzval/lens/formats/seq_commands.h>
#include <petzval/lens/lens.h>

#include <string>
#include <vector>

namespace petzval {

/// A command of a named file, with the complaints about it.
struct SeqContext {
  const std::string& file;
  std::vector<std::string>& notes;

  /// \param where  "S3: " and so on. \throws InputError with file and line.
  [[noreturn]] void fail(const SeqCommand& command, const std::string& message,
                         const std::string& where = "") const;
  /// The i-th word as a number. \throws InputError unless it is a finite one.
  double number(const SeqCommand& command, std::size_t i, const std::string& where = "") const;
  /// All words as numbers.
  std::vector<double> numbers(const SeqCommand& command) const;
};

struct SeqSystem {
  std::string title;
  double mm_per_unit = 1;
  std::optional<SeqCommand> aperture;  ///< EPD, FNO, NA or NAO
  Fields::Kind field_kind = Fields::Kind::angle_deg;
  std::vector<double> field_x, field_y;
  std::optional<SeqCommand> wavelengths, reference;

  /// Takes over a command if it is one of these; false: it is another's.
  bool apply(const SeqCommand& command, const SeqContext& context);

  /// Lengths become mm; the lens's object distance must be set.
  void put_into(Lens& lens, const SeqContext& context) const;

 private:
  bool apply_field(const SeqCommand& command, const SeqContext& context);
  void put_aperture(Lens& lens, const SeqContext& context) const;
  void put_fields(Lens& lens) const;
  void put_wavelengths(Lens& lens, const SeqContext& context) const;
};

}  // namespace petzval
