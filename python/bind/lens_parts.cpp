// SPDX-License-Identifier: BSD-3-Clause
#include "lens_parts.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>

#include <algorithm>

namespace petzval::python {

namespace {

/// \throws InputError for a key that is none of these, naming the nearest.
void allow_only(const char* parameter, const nb::dict& dict, const std::vector<std::string>& keys) {
  for (const auto& [key, value] : dict) {
    const auto name = nb::cast<std::string>(nb::str(key));
    if (std::ranges::find(keys, name) == keys.end())
      throw InputError(fmt::format("`{}` has no \"{}\"; \"{}\" would be right", parameter, name,
                                   fmt::join(nearest_names(name, keys, 1), "")));
  }
}

ApertureFigure aperture_from(const nb::dict& dict) {
  allow_only("apertures", dict, {"rectangle", "ellipse", "decentre_mm", "rotation_deg", "obscures"});
  using Pair = std::pair<double, double>;
  const bool rectangle = dict.contains("rectangle");
  if (rectangle == dict.contains("ellipse"))
    throw InputError(
        "an entry of `apertures` is either a rectangle or an ellipse; {\"rectangle\": (8, 5)}, half the "
        "widths "
        "along x and y [mm], would be right");
  ApertureFigure figure;
  figure.kind = rectangle ? ApertureFigure::Kind::rectangle : ApertureFigure::Kind::ellipse;
  std::tie(figure.half_width_x_mm, figure.half_width_y_mm) =
      nb::cast<Pair>(dict[rectangle ? "rectangle" : "ellipse"]);
  if (dict.contains("decentre_mm"))
    std::tie(figure.decentre_x_mm, figure.decentre_y_mm) = nb::cast<Pair>(dict["decentre_mm"]);
  if (dict.contains("rotation_deg")) figure.rotation_deg = nb::cast<double>(dict["rotation_deg"]);
  if (dict.contains("obscures")) figure.obscures = nb::cast<bool>(dict["obscures"]);
  return figure;
}

nb::object aperture_to(const ApertureFigure& figure) {
  nb::dict dict;
  dict[figure.kind == ApertureFigure::Kind::rectangle ? "rectangle" : "ellipse"] =
      nb::make_tuple(figure.half_width_x_mm, figure.half_width_y_mm);
  if (figure.decentre_x_mm != 0 || figure.decentre_y_mm != 0)
    dict["decentre_mm"] = nb::make_tuple(figure.decentre_x_mm, figure.decentre_y_mm);
  if (figure.rotation_deg != 0) dict["rotation_deg"] = figure.rotation_deg;
  if (figure.obscures) dict["obscures"] = true;
  return read_only(dict);
}

}  // namespace

nb::object read_only(const nb::object& dict) {
  return nb::steal(PyDictProxy_New(dict.ptr()));
}

nb::tuple apertures_to(const std::vector<ApertureFigure>& apertures) {
  nb::list list;
  for (const ApertureFigure& each : apertures) list.append(aperture_to(each));
  return nb::tuple(list);
}

std::vector<ApertureFigure> apertures_from(const nb::iterable& apertures) {
  std::vector<ApertureFigure> result;
  for (const nb::handle each : apertures) result.push_back(aperture_from(dict_of(nb::borrow(each))));
  return result;
}

nb::object pose_to(const Pose& pose) {
  nb::dict dict;
  for (const PoseNumber& number : pose_numbers)
    if (const double value = pose.*number.value; value != 0) dict[number.name] = value;
  return read_only(dict);
}

Pose pose_from(const nb::dict& dict) {
  std::vector<std::string> names;
  for (const PoseNumber& number : pose_numbers) names.emplace_back(number.name);
  allow_only("pose", dict, names);
  Pose pose;
  for (const PoseNumber& number : pose_numbers)
    if (dict.contains(number.name)) pose.*number.value = nb::cast<double>(dict[number.name]);
  return pose;
}

nb::tuple groups_to(const std::vector<SurfaceGroup>& groups) {
  nb::list list;
  for (const SurfaceGroup& group : groups) {
    nb::dict dict;
    dict["surfaces"] = nb::make_tuple(group.first, group.last);
    dict["pose"] = pose_to(group.pose);
    dict["pivot_mm"] = group.pivot_mm;
    list.append(read_only(dict));
  }
  return nb::tuple(list);
}

std::vector<SurfaceGroup> groups_from(const nb::iterable& groups) {
  std::vector<SurfaceGroup> result;
  for (const nb::handle each : groups) {
    const nb::dict dict = dict_of(nb::borrow(each));
    allow_only("groups", dict, {"surfaces", "pose", "pivot_mm"});
    if (!dict.contains("surfaces"))
      throw InputError(
          "an entry of `groups` says which surfaces move; {\"surfaces\": (2, 3)} would be right");
    SurfaceGroup group;
    std::tie(group.first, group.last) = nb::cast<std::pair<std::size_t, std::size_t>>(dict["surfaces"]);
    if (dict.contains("pose")) group.pose = pose_from(dict_of(nb::borrow(dict["pose"])));
    if (dict.contains("pivot_mm")) group.pivot_mm = nb::cast<double>(dict["pivot_mm"]);
    result.push_back(group);
  }
  return result;
}

nb::tuple tolerances_to(const std::vector<Tolerance>& tolerances) {
  nb::list list;
  for (const Tolerance& each : tolerances) list.append(place_of(each) + "=" + number_repr(each.limit));
  return nb::tuple(list);
}

std::vector<Tolerance> tolerances_from(const std::vector<std::string>& texts) {
  std::vector<Tolerance> tolerances;
  for (const std::string& text : texts)
    for (const Tolerance& each : parse_tolerances(text)) tolerances.push_back(each);
  return tolerances;
}

}  // namespace petzval::python
