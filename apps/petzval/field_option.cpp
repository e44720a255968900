// SPDX-License-Identifier: BSD-3-Clause
#include "field_option.h"

#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>
#include <petzval/base/wavelength.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval::app {

namespace {

const std::map<std::string, Fields::Kind>& field_kinds() {
  static const std::map<std::string, Fields::Kind> kinds = [] {
    std::map<std::string, Fields::Kind> table;
    for (const Fields::Kind kind :
         {Fields::Kind::angle_deg, Fields::Kind::object_height_mm, Fields::Kind::paraxial_image_height_mm,
          Fields::Kind::real_image_height_mm})
      table[to_string(kind)] = kind;
    return table;
  }();
  return kinds;
}

}  // namespace

std::vector<double> parse_wavelength_list(const std::string& text) {
  std::vector<double> wavelengths_nm = parse_number_list(text, "wavelengths_nm");
  for (const double nm : wavelengths_nm) require_wavelength(nm, "`wavelengths_nm` " + text);
  return wavelengths_nm;
}

void FieldChoice::add_to(CLI::App& command) {
  command.add_option_function<std::string>(
      "--fields", [this](const std::string& text) { fields = parse_number_list(text, "fields"); },
      "Fields, 0,7,14 or 0:7:14 (start:step:stop); in the units of the field type");
  command.add_option("--field-type", field_type, "What the fields are; default: as in the lens file")
      ->check(CLI::IsMember(
          {"angle_deg", "object_height_mm", "paraxial_image_height_mm", "real_image_height_mm"}));
  command.add_option_function<std::string>(
      "--wavelengths", [this](const std::string& text) { wavelengths_nm = parse_wavelength_list(text); },
      "Wavelengths [nm], 450,550 or 400:50:700; default: the lens's own");
  command.add_flag("--ignore-apertures", ignore_apertures, "Let nothing but the stop clip the rays");
  command
      .add_option_function<std::string>(
          "--apertures", [this](const std::string& choice) { from_fields = choice == "from-fields"; },
          "Clear apertures that the file leaves out: unbounded (file), or what the lens's fields need "
          "(from-fields)")
      ->check(CLI::IsMember({"file", "from-fields"}));
}

Lens FieldChoice::prepare(Lens lens, const Shared& shared) const {
  if (from_fields) return with_apertures_from_fields(std::move(lens));
  const auto missing = std::count_if(lens.surfaces.begin(), lens.surfaces.end(), [](const Surface& surface) {
    return !surface.stop && !surface.semi_diameter_mm;
  });
  if (missing > 0 && !ignore_apertures)
    note(shared,
         fmt::format("{} of {} surfaces have no clear aperture and clip nothing; --apertures from-fields "
                     "solves them",
                     missing, lens.surfaces.size()));
  return lens;
}

FieldTableRequest FieldChoice::request(const Lens& lens) const {
  FieldTableRequest request = FieldTableRequest::of(lens);
  if (!field_type.empty()) {
    request.field_kind = field_kinds().at(field_type);
    if (fields.empty() && request.field_kind != lens.fields.kind)
      throw InputError(fmt::format("--field-type {} needs --fields, because the lens file gives {}",
                                   field_type, to_string(lens.fields.kind)));
  }
  if (!fields.empty()) request.fields = fields;
  if (!wavelengths_nm.empty()) request.wavelengths_nm = wavelengths_nm;
  if (ignore_apertures) request.clip = Tracer::Clip::stop_only;
  return request;
}

nlohmann::ordered_json field_definition(Fields::Kind kind) {
  const char* meaning = "";
  switch (kind) {
    case Fields::Kind::angle_deg:
      meaning = "angle of the chief ray in object space, degrees; +: the ray rises";
      break;
    case Fields::Kind::object_height_mm:
      meaning = "height of the object point, mm";
      break;
    case Fields::Kind::paraxial_image_height_mm:
      meaning = "paraxial image height at the reference wavelength, mm";
      break;
    case Fields::Kind::real_image_height_mm:
      meaning = "height of the real chief ray on the image surface at the reference wavelength, mm";
      break;
  }
  return {{"type", to_string(kind)}, {"meaning", meaning}};
}

std::string field_heading(Fields::Kind kind) {
  const std::string name = to_string(kind);
  return fmt::format("{} [{}]", name.substr(0, name.rfind('_')), field_unit(kind));
}

bool has_f_number(const FirstOrder& data) {
  return std::isfinite(data.f_number) && data.f_number > 0;
}

nlohmann::ordered_json f_number_or_null(const FirstOrder& data) {
  return has_f_number(data) ? nlohmann::ordered_json(data.f_number) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

namespace {

JsonTaker* json_taker = nullptr;

}  // namespace

JsonTaker::JsonTaker() {
  json_taker = this;
}

JsonTaker::~JsonTaker() {
  json_taker = nullptr;
}

void print_json(const nlohmann::ordered_json& json) {
  if (json_taker) {
    json_taker->taken_ = json;
    return;
  }
  fmt::print("{}\n", json.dump(2));
}

}  // namespace petzval::app
