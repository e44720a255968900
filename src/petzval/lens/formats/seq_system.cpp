// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/field_point.h>
#include <petzval/lens/formats/seq_system.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {

void SeqContext::fail(const SeqCommand& command, const std::string& message, const std::string& where) const {
  throw InputError(file, command.line, where + quotable(command.name) + " " + message);
}

double SeqContext::number(const SeqCommand& command, std::size_t i, const std::string& where) const {
  const auto value = command.has(i) ? parse_number(command.words[i]) : std::nullopt;
  if (!value)
    fail(command,
         fmt::format("must have a number in place {}, not \"{}\"", i + 1,
                     quotable(command.has(i) ? command.words[i] : "")),
         where);
  return *value;
}

std::vector<double> SeqContext::numbers(const SeqCommand& command) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < command.words.size(); ++i) values.push_back(number(command, i));
  return values;
}

bool SeqSystem::apply_field(const SeqCommand& command, const SeqContext& context) {
  using Kind = Fields::Kind;
  static const std::map<std::string, Kind, std::less<>> kinds{{"AN", Kind::angle_deg},
                                                              {"OB", Kind::object_height_mm},
                                                              {"IM", Kind::paraxial_image_height_mm},
                                                              {"RI", Kind::real_image_height_mm}};
  const std::string& name = command.name;
  if (name.size() != 3 || (name[0] != 'X' && name[0] != 'Y')) return false;
  const auto kind = kinds.find(name.substr(1));
  if (kind == kinds.end()) return false;
  if (kind->second != field_kind) {
    field_x.clear();
    field_y.clear();
  }
  field_kind = kind->second;
  (name[0] == 'X' ? field_x : field_y) = context.numbers(command);
  return true;
}

bool SeqSystem::apply(const SeqCommand& command, const SeqContext& context) {
  const std::string& name = command.name;
  if (apply_field(command, context)) return true;
  if (name == "TIT") {
    title = command.has(0) ? command.words[0] : "";
  } else if (name == "DIM") {
    static const std::map<std::string, double> units{{"M", 1},   {"MM", 1},   {"C", 10},
                                                     {"CM", 10}, {"I", 25.4}, {"IN", 25.4}};
    const auto unit = units.find(command.has(0) ? upper_case(command.words[0]) : "");
    if (unit == units.end()) context.fail(command, "must be M (mm), C (cm) or I (inch)");
    mm_per_unit = unit->second;
  } else if (name == "EPD" || name == "FNO" || name == "NA" || name == "NAO") {
    aperture = command;
  } else if (name == "WL") {
    wavelengths = command;
  } else if (name == "REF") {
    reference = command;
  } else if (name == "TEM" || name == "PRE") {
    const double usual = name == "TEM" ? 20 : 760;
    for (const double value : context.numbers(command))
      if (value != usual)
        context.fail(command,
                     "asks for indices at another temperature or pressure, which are not modelled; "
                     "20 and 760 are");
  } else {
    return false;
  }
  return true;
}

void SeqSystem::put_aperture(Lens& lens, const SeqContext& context) const {
  using Kind = Aperture::Kind;
  if (!aperture)
    throw InputError(context.file, "gives no aperture; one of EPD, FNO, NA and NAO must be there");
  const double value = context.number(*aperture, 0);
  const std::string& name = aperture->name;
  if (name == "EPD") lens.aperture = {Kind::entrance_pupil_diameter_mm, value * mm_per_unit};
  // The image's f-number at the conjugates in use, which at infinity is the f-number.
  if (name == "FNO")
    lens.aperture = {lens.object_distance_mm ? Kind::working_f_number : Kind::f_number, value};
  if (name == "NA") lens.aperture = {Kind::image_na, value};
  if (name == "NAO") lens.aperture = {Kind::object_na, value};
}

void SeqSystem::put_fields(Lens& lens) const {
  lens.fields.kind = field_kind;
  const bool is_angle = field_kind == Fields::Kind::angle_deg;
  const auto value = [](const std::vector<double>& list, std::size_t i) {
    return i < list.size() ? list[i] : 0;
  };
  lens.fields.values.clear();
  for (std::size_t i = 0; i < std::max(field_x.size(), field_y.size()); ++i)
    lens.fields.values.push_back((is_angle ? 1 : mm_per_unit) *
                                 radial_field(value(field_x, i), value(field_y, i), is_angle));
  if (lens.fields.values.empty()) lens.fields.values = {0};
}

void SeqSystem::put_wavelengths(Lens& lens, const SeqContext& context) const {
  if (!wavelengths || wavelengths->words.empty())
    throw InputError(context.file, "has no wavelengths; WL 587.56 would give one");
  lens.wavelengths_nm = context.numbers(*wavelengths);
  const std::size_t count = lens.wavelengths_nm.size();
  std::size_t number = 1;
  if (reference) {
    const double given = context.number(*reference, 0);
    if (!(given >= 1 && given <= static_cast<double>(count)) || given != std::floor(given))
      context.fail(*reference, fmt::format("must be the number of a wavelength, 1 to {}", count));
    number = static_cast<std::size_t>(given);
  } else if (count > 1) {
    context.notes.push_back(
        fmt::format("{}: no REF; the middle wavelength, number {}, is the reference", context.file, number));
  }
  lens.reference_wavelength_nm = lens.wavelengths_nm[number - 1];
}

void SeqSystem::put_into(Lens& lens, const SeqContext& context) const {
  lens.name = title;
  put_aperture(lens, context);
  put_fields(lens);
  put_wavelengths(lens, context);
}

}  // namespace petzval
