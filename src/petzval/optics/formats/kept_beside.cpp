// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/optics/formats/kept_beside.h>
#include <petzval/optics/table_layout.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace petzval {

namespace {

using Json = nlohmann::ordered_json;
constexpr char format[] = "petzval-kept/1";

/// JSON has no infinity.
Json number_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? Json(nullptr) : Json(value > 0 ? "inf" : "-inf");
}

double number_of(const Json& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (json == "inf") return std::numeric_limits<double>::infinity();
  if (json == "-inf") return -std::numeric_limits<double>::infinity();
  return json.get<double>();
}

Json psf_json(const LensDataTable& table) {
  Json sizes = Json::array(), spacings = Json::array(), captured = Json::array();
  for (const Psf& psf : table.psf) {
    sizes.push_back(psf.size);
    spacings.push_back(psf.spacing_um);
    captured.push_back(psf.captured);
  }
  return {{"size", sizes}, {"spacing_um", spacings}, {"captured", captured}};
}

void take_psfs(const Json& json, LensDataTable& table) {
  const auto sizes = json.at("size").get<std::vector<int>>();
  const auto spacings = json.at("spacing_um").get<std::vector<double>>();
  const auto captured = json.at("captured").get<std::vector<double>>();
  if (spacings.size() != sizes.size() || captured.size() != sizes.size())
    throw InputError("what Petzval kept beside the table counts its PSFs differently");
  for (std::size_t i = 0; i < sizes.size(); ++i)
    table.psf.push_back({sizes[i], spacings[i], {}, captured[i]});
}

LensDataTable take(const Json& json) {
  if (json.at("format") != format)
    throw InputError(
        "what is kept beside the table is of an unknown format; this version reads petzval-kept/1");
  LensDataTable table;
  table.lens_name = json.at("lens_name").get<std::string>();
  table.provenance = json.at("provenance").get<std::string>();
  table.lens_json = json.at("lens_json").get<std::string>();
  if (const double distance = number_of(json.at("object_distance_mm")); std::isfinite(distance))
    table.object_distance_mm = distance;
  table.vertex_to_sensor_mm = number_of(json.at("vertex_to_sensor_mm"));
  if (const Json& stop = json.at("stop_semi_diameter_mm"); !stop.is_null())
    table.stop_semi_diameter_mm = stop.get<double>();
  const Json& first_order = json.at("first_order");
  table_layout::for_each_first_order(
      table.first_order, [&](const char* name, double& number) { number = number_of(first_order.at(name)); });
  table.fields = json.at("fields").get<std::vector<double>>();
  table.wavelengths_nm = json.at("wavelengths_nm").get<std::vector<double>>();
  table.g_source_sr = json.at("g_source_sr").get<std::vector<double>>();
  table.g_sensor_sr = json.at("g_sensor_sr").get<std::vector<double>>();
  take_psfs(json.at("psf"), table);
  return table;
}

}  // namespace

std::string kept_beside(const LensDataTable& table) {
  Json first_order;
  table_layout::for_each_first_order(
      table.first_order, [&](const char* name, double number) { first_order[name] = number_json(number); });
  const Json json = {{"format", format},
                     {"lens_name", table.lens_name},
                     {"provenance", table.provenance},
                     {"lens_json", table.lens_json},
                     {"object_distance_mm", number_json(table.object_distance_mm.value_or(INFINITY))},
                     {"vertex_to_sensor_mm", table.vertex_to_sensor_mm},
                     {"stop_semi_diameter_mm", number_json(table.stop_semi_diameter_mm.value_or(NAN))},
                     {"first_order", first_order},
                     {"fields", table.fields},
                     {"wavelengths_nm", table.wavelengths_nm},
                     {"g_source_sr", table.g_source_sr},
                     {"g_sensor_sr", table.g_sensor_sr},
                     {"psf", psf_json(table)}};
  constexpr bool ascii = true;
  return json.dump(-1, ' ', ascii, Json::error_handler_t::replace);
}

LensDataTable table_of_kept(const std::string& text) {
  try {
    return take(Json::parse(text));
  } catch (const nlohmann::json::exception&) {
    throw InputError("what Petzval kept beside the table cannot be read");
  }
}

}  // namespace petzval
