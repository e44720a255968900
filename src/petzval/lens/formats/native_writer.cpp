// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/surface_kind.h>

namespace petzval {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

namespace {

std::string list(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(number_text(number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

struct NativeGlassText {
  std::string operator()(const Material::Air&) const { return ""; }
  std::string operator()(const std::shared_ptr<const Glass>& glass) const {
    return quoted(glass->full_name());
  }
  std::string operator()(const Material::Model& model) const {
    const std::string deviation = model.dpgf == 0 ? "" : ", \"dpgf\": " + number_text(model.dpgf);
    return fmt::format(R"({{"nd": {}, "vd": {}{}}})", number_text(model.nd), number_text(model.vd),
                       deviation);
  }
  std::string operator()(const Material::Constant& constant) const {
    return fmt::format(R"({{"index": {}}})", number_text(constant.index));
  }
  std::string operator()(const Material::Table& table) const {
    std::vector<std::string> entries;
    for (const auto& [wavelength_nm, index] : table)
      entries.push_back(fmt::format("\"{}\": {}", fmt::format("{}", wavelength_nm), number_text(index)));
    return fmt::format(R"({{"index_table": {{{}}}}})", fmt::join(entries, ", "));
  }
};

std::string shape_text(const AddedShape& shape) {
  std::string text = "{\"kind\": " + quoted(shape.kind);
  for (const ShapeParameter& parameter : surface_kind(shape.kind).parameters)
    if (const auto found = shape.parameters.find(parameter.name); found != shape.parameters.end())
      text += fmt::format(", \"{}\": {}", parameter.name,
                          parameter.most > 1 ? list(found->second) : number_text(found->second.at(0)));
  return text + "}";
}

std::string aperture_figure_text(const ApertureFigure& shape) {
  std::string text =
      fmt::format("{{\"{}\": {}", shape.kind == ApertureFigure::Kind::rectangle ? "rectangle" : "ellipse",
                  list({shape.half_width_x_mm, shape.half_width_y_mm}));
  if (shape.decentre_x_mm != 0 || shape.decentre_y_mm != 0)
    text += ", \"decentre_mm\": " + list({shape.decentre_x_mm, shape.decentre_y_mm});
  if (shape.rotation_deg != 0) text += ", \"rotation_deg\": " + number_text(shape.rotation_deg);
  if (shape.obscures) text += ", \"obscures\": true";
  return text + "}";
}

std::string pose_text(const Pose& pose) {
  std::vector<std::string> entries;
  for (const PoseNumber& number : pose_numbers)
    if (const double value = pose.*number.value; value != 0)
      entries.push_back(fmt::format("\"{}\": {}", number.name, number_text(value)));
  return fmt::format("{{{}}}", fmt::join(entries, ", "));
}

std::string group_text(const SurfaceGroup& group) {
  return fmt::format("{{\"surfaces\": [{}, {}], \"pose\": {}{}}}", group.first, group.last,
                     pose_text(group.pose),
                     group.pivot_mm == 0 ? "" : ", \"pivot_mm\": " + number_text(group.pivot_mm));
}

std::string surface_text(const Surface& surface) {
  const bool flat = surface.curvature_per_mm == 0;
  std::string text =
      fmt::format(R"({{"radius_mm": {}, "thickness_mm": {})",
                  flat ? "null" : radius_text(surface.curvature_per_mm), number_text(surface.thickness_mm));
  const std::string glass = std::visit(NativeGlassText{}, surface.material.kind());
  if (!glass.empty()) text += ", \"glass\": " + glass;
  if (const Material::Melt& melt = surface.material.melt(); !melt.is_none())
    text += fmt::format(", \"melt\": {{\"delta_nd\": {}, \"delta_vd_percent\": {}}}",
                        number_text(melt.delta_nd), number_text(melt.delta_vd_percent));
  if (surface.mirror) text += ", \"mirror\": true";
  if (surface.stop) text += ", \"stop\": true";
  if (surface.blades.count != 0)
    text += fmt::format(R"(, "blades": {{"count": {}, "rotation_deg": {}}})", surface.blades.count,
                        number_text(surface.blades.rotation_deg));
  if (surface.semi_diameter_mm) text += ", \"semi_diameter_mm\": " + number_text(*surface.semi_diameter_mm);
  if (!surface.apertures.empty()) {
    std::vector<std::string> figures;
    for (const ApertureFigure& each : surface.apertures) figures.push_back(aperture_figure_text(each));
    text += fmt::format(", \"apertures\": [{}]", fmt::join(figures, ", "));
  }
  if (surface.conic != 0) text += ", \"conic\": " + number_text(surface.conic);
  if (!surface.asphere.empty()) {
    std::vector<std::string> terms;
    for (const auto& [power, coefficient] : surface.asphere)
      terms.push_back(fmt::format("\"{}\": {}", power, number_text(coefficient)));
    text += fmt::format(", \"asphere\": {{{}}}", fmt::join(terms, ", "));
  }
  if (surface.shape) text += ", \"shape\": " + shape_text(*surface.shape);
  if (const auto& grating = surface.grating) {
    text += fmt::format(
        ", \"grating\": {{\"lines_per_mm\": {}, \"order\": {}{}}}", number_text(grating->lines_per_mm),
        number_text(grating->order),
        grating->rotation_deg == 0 ? "" : ", \"rotation_deg\": " + number_text(grating->rotation_deg));
  }
  if (surface.ideal_lens)
    text += fmt::format(", \"ideal_lens\": {{\"focal_length_mm\": {}}}",
                        number_text(surface.ideal_lens->focal_length_mm));
  if (!surface.pose.is_none()) text += ", \"pose\": " + pose_text(surface.pose);
  if (surface.scatter) text += ", \"scatter\": " + scatter_text(*surface.scatter);
  if (surface.coating) text += ", \"coating\": " + coating_text(*surface.coating);
  if (surface.transfer) text += ", \"transfer\": " + transfer_text(*surface.transfer);
  return text + "}";
}

std::string states_text(const LensStates& states) {
  std::vector<std::string> names, rows;
  for (const std::string& name : states.names) names.push_back(quoted(name));
  for (const StateRow& row : states.rows)
    rows.push_back(fmt::format("      {}: [{}]", quoted(row.path), fmt::join(row.values, ", ")));
  return fmt::format("{{\n    \"names\": [{}],\n    \"values\": {{\n{}\n    }}\n  }}", fmt::join(names, ", "),
                     fmt::join(rows, ",\n"));
}

}  // namespace

std::string lens_to_json(const Lens& lens) {
  lens.validate();
  std::string text = fmt::format("{{\n  \"format\": \"{}\",\n", native_format);
  const auto line = [&](const char* key, const std::string& value) {
    text += fmt::format("  \"{}\": {},\n", key, value);
  };
  line("name", quoted(lens.name));
  line("source", quoted(lens.source));
  line("object_distance_mm", lens.object_distance_mm ? number_text(*lens.object_distance_mm) : "null");
  if (!lens.object_material.is_air())
    line("object_glass", std::visit(NativeGlassText{}, lens.object_material.kind()));
  line("aperture", fmt::format("{{\"{}\": {}}}", aperture_keys[static_cast<std::size_t>(lens.aperture.kind)],
                               number_text(lens.aperture.value)));
  line("fields",
       fmt::format("{{\"type\": \"{}\", \"values\": {}}}",
                   field_types[static_cast<std::size_t>(lens.fields.kind)], list(lens.fields.values)));
  line("wavelengths_nm", list(lens.wavelengths_nm));
  line("reference_wavelength_nm", number_text(lens.reference_wavelength_nm));
  text += "  \"surfaces\": [\n";
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    text +=
        fmt::format("    {}{}\n", surface_text(lens.surfaces[i]), i + 1 < lens.surfaces.size() ? "," : "");
  text += "  ]";
  if (!lens.groups.empty()) {
    std::vector<std::string> groups;
    for (const SurfaceGroup& group : lens.groups) groups.push_back("    " + group_text(group));
    text += fmt::format(",\n  \"groups\": [\n{}\n  ]", fmt::join(groups, ",\n"));
  }
  if (!lens.sensor_pose.is_none()) text += ",\n  \"sensor_pose\": " + pose_text(lens.sensor_pose);
  if (!lens.tolerances.empty()) {
    std::vector<std::string> lines;
    for (const Tolerance& each : lens.tolerances)
      lines.push_back(fmt::format("    {{\"kind\": \"{}\", \"surfaces\": [{}], \"limit\": {}}}", each.kind,
                                  each.first == each.last ? fmt::format("{}", each.first)
                                                          : fmt::format("{}, {}", each.first, each.last),
                                  number_text(each.limit)));
    text += fmt::format(",\n  \"tolerances\": [\n{}\n  ]", fmt::join(lines, ",\n"));
  }
  if (lens.scatter) text += ",\n  \"scatter\": " + scatter_text(*lens.scatter);
  if (!lens.states.empty()) text += ",\n  \"states\": " + states_text(lens.states);
  return text + "\n}\n";
}

}  // namespace petzval
