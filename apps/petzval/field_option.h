// SPDX-License-Identifier: BSD-3-Clause
// Fields and wavelengths on the command line, for every analysis of a lens.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_values.h>
#include <petzval/lens/first_order.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"

namespace petzval::app {

/// The words of --wavelengths, as parse_number_list() takes them. \throws InputError for what is no nm.
std::vector<double> parse_wavelength_list(const std::string& text);

struct FieldChoice {
  std::vector<double> fields, wavelengths_nm;
  std::string field_type;  ///< empty: the lens's own
  bool ignore_apertures = false;
  bool from_fields = false;

  /// Adds --fields, --field-type, --wavelengths, --ignore-apertures and --apertures.
  void add_to(CLI::App& command);
  /// The lens with --apertures applied, and a note when clear apertures are missing.
  Lens prepare(Lens lens, const Shared& shared) const;
  /// The lens's own fields and wavelengths where none were given.
  FieldTableRequest request(const Lens& lens) const;
};

/// What the numbers in `field` are: {"type": "angle_deg", "meaning": "…"}.
nlohmann::ordered_json field_definition(Fields::Kind kind);
/// "field [deg]" and the like, for table headings.
std::string field_heading(Fields::Kind kind);

/// A lens that is telecentric in object space has an infinite entrance pupil and so no f-number.
bool has_f_number(const FirstOrder& data);
nlohmann::ordered_json f_number_or_null(const FirstOrder& data);

/// NaN and infinities become null, as JSON wants.
nlohmann::ordered_json number_or_null(double value);
/// Prints JSON on stdout, indented; or hands it to the JsonTaker that there is.
void print_json(const nlohmann::ordered_json& json);

/// While it lives, JSON that commands would print is kept instead: for commands that run other commands.
class JsonTaker {
 public:
  JsonTaker();
  ~JsonTaker();
  JsonTaker(const JsonTaker&) = delete;
  JsonTaker& operator=(const JsonTaker&) = delete;
  /// What was printed last; null: nothing.
  const nlohmann::ordered_json& taken() const { return taken_; }

 private:
  friend void print_json(const nlohmann::ordered_json& json);
  nlohmann::ordered_json taken_;
};

}  // namespace petzval::app
