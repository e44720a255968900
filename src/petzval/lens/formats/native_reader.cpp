// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/wavelength.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/lens_fault.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/surface_kind.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace petzval {

namespace {

/// Calls `make` and gives its complaint the place in the file.
template <typename Make>
Material located(const JsonEntry& entry, Make make) {
  try {
    return make();
  } catch (const InputError& error) {
    entry.fail(fmt::format("cannot be used: {}", error.what()));
  }
}

Material index_table(const JsonEntry& entry) {
  Material::Table table;
  for (const auto& [wavelength, index] : entry.members("an object of \"wavelength in nm\": index")) {
    const auto wavelength_nm = parse_number(wavelength);
    if (!wavelength_nm) index.fail("must have a wavelength in nm for its key");
    if (const std::string wrong = wavelength_fault(*wavelength_nm); !wrong.empty()) index.fail(wrong);
    table.emplace_back(*wavelength_nm, index.number("a refractive index"));
  }
  std::sort(table.begin(), table.end());
  return located(entry, [&] { return Material(table); });
}

Material read_glass(const JsonEntry& entry, GlassLookup& glasses) {
  constexpr const char* forms =
      "a glass name, {\"nd\": …, \"vd\": …}, {\"index\": …} or {\"index_table\": {\"587.56\": …}}";
  if (entry.is_null()) return Material();
  if (entry.is_text()) {
    const std::string name = entry.text(forms);
    return located(entry, [&] { return glasses.find(name); });
  }
  if (!entry.is_object()) entry.fail(fmt::format("must be {}, or be left out for air", forms));
  if (const auto table = entry.find("index_table")) {
    entry.allow_only({"index_table"});
    return index_table(*table);
  }
  if (const auto index = entry.find("index")) {
    entry.allow_only({"index"});
    const double n = index->number("a refractive index");
    return located(entry, [&] { return Material(Material::Constant{n}); });
  }
  if (!entry.find("nd") && !entry.find("vd")) entry.fail(fmt::format("must be {}", forms));
  entry.allow_only({"nd", "vd", "dpgf"});
  const auto deviation = entry.find("dpgf");
  const Material::Model model{entry.at("nd").number("a refractive index"),
                              entry.at("vd").number("an Abbe number"),
                              deviation ? deviation->number("a deviation of P_gF") : 0};
  return located(entry, [&] { return Material(model); });
}

std::vector<double> read_numbers(const JsonEntry& entry, const char* meaning, const char* item_meaning) {
  std::vector<double> numbers;
  for (const JsonEntry& item : entry.items(meaning)) numbers.push_back(item.number(item_meaning));
  return numbers;
}

double read_curvature(const JsonEntry& radius) {
  if (radius.is_null()) return 0;
  const double value = radius.number("a radius in mm, or null for a flat surface");
  if (value == 0) radius.fail("must not be 0; null is a flat surface");
  return radius.long_number() ? curvature_from_radius(*radius.long_number()) : 1 / value;
}

void read_asphere(const JsonEntry& entry, Surface& surface) {
  for (const auto& [key, coefficient] : entry.members("an object of \"power of r\": coefficient")) {
    const auto power = parse_integer(key);
    if (!power) coefficient.fail("must have a power of r, a whole number, for its key");
    surface.asphere[*power] = coefficient.number("a coefficient in mm^(1-power)");
  }
}

/// "kind", and the keys that the kind has: numbers or lists of them.
AddedShape read_shape(const JsonEntry& entry) {
  const JsonEntry name = entry.at("kind");
  AddedShape shape{name.text("a kind of surface"), {}};
  const SurfaceKind* kind = find_surface_kind(shape.kind);
  if (!kind) name.fail("is not a kind of surface; these are: " + surface_kind_names());
  std::vector<const char*> keys{"kind"};
  for (const ShapeParameter& parameter : kind->parameters) keys.push_back(parameter.name);
  entry.allow_only(keys);
  for (const ShapeParameter& parameter : kind->parameters) {
    const auto value = entry.find(parameter.name);
    if (!value) continue;
    shape.parameters[parameter.name] = parameter.most > 1
                                           ? read_numbers(*value, "a list of numbers", parameter.meaning)
                                           : std::vector<double>{value->number(parameter.meaning)};
  }
  return shape;
}

StopBlades read_blades(const JsonEntry& entry) {
  entry.allow_only({"count", "rotation_deg"});
  const JsonEntry count = entry.at("count");
  const double number = count.number("a number of blades");
  if (!(std::abs(number) <= StopBlades::most) || number != std::floor(number))
    count.fail(fmt::format("must be a whole number, 3 to {}, or 0 for a round stop", StopBlades::most));
  StopBlades blades{static_cast<int>(number), 0};
  if (const auto rotation = entry.find("rotation_deg"))
    blades.rotation_deg = rotation->number("an angle in degrees");
  return blades;
}

/// {"ellipse": [8, 5]} or {"rectangle": [8, 5]}: half the widths along x and y.
ApertureFigure read_aperture_figure(const JsonEntry& entry) {
  entry.allow_only({"ellipse", "rectangle", "decentre_mm", "rotation_deg", "obscures"});
  const auto ellipse = entry.find("ellipse"), rectangle = entry.find("rectangle");
  if (ellipse.has_value() == rectangle.has_value())
    entry.fail("must have either \"ellipse\" or \"rectangle\", with half the widths along x and y in mm");
  const auto two = [](const JsonEntry& pair, const char* meaning) {
    const std::vector<double> numbers = read_numbers(pair, meaning, "a number of mm");
    if (numbers.size() != 2) pair.fail(fmt::format("must be {}", meaning));
    return numbers;
  };
  ApertureFigure shape;
  shape.kind = rectangle ? ApertureFigure::Kind::rectangle : ApertureFigure::Kind::ellipse;
  const std::vector<double> half =
      two(rectangle ? *rectangle : *ellipse, "half the widths along x and y in mm, such as [8, 5]");
  shape.half_width_x_mm = half[0], shape.half_width_y_mm = half[1];
  if (const auto decentre = entry.find("decentre_mm")) {
    const std::vector<double> middle = two(*decentre, "the place of its middle in mm, such as [0, 2]");
    shape.decentre_x_mm = middle[0], shape.decentre_y_mm = middle[1];
  }
  if (const auto rotation = entry.find("rotation_deg"))
    shape.rotation_deg = rotation->number("an angle in degrees");
  if (const auto obscures = entry.find("obscures")) shape.obscures = obscures->truth();
  return shape;
}

Material::Melt read_melt(const JsonEntry& entry) {
  entry.allow_only({"delta_nd", "delta_vd_percent"});
  Material::Melt melt;
  if (const auto nd = entry.find("delta_nd")) melt.delta_nd = nd->number("a difference of nd");
  if (const auto vd = entry.find("delta_vd_percent"))
    melt.delta_vd_percent = vd->number("a difference of Vd in per cent");
  return melt;
}

Pose read_pose(const JsonEntry& entry) {
  std::vector<const char*> names;
  for (const PoseNumber& number : pose_numbers) names.push_back(number.name);
  entry.allow_only(names);
  Pose pose;
  for (const PoseNumber& number : pose_numbers)
    if (const auto value = entry.find(number.name))
      pose.*number.value = value->number(number.is_length ? "a distance in mm" : "an angle in degrees");
  return pose;
}

Grating read_grating(const JsonEntry& entry) {
  entry.allow_only({"lines_per_mm", "order", "rotation_deg"});
  Grating grating{entry.at("lines_per_mm").number("lines per mm"), entry.at("order").number("an order"), 0};
  if (const auto rotation = entry.find("rotation_deg"))
    grating.rotation_deg = rotation->number("an angle in degrees");
  return grating;
}

IdealLens read_ideal_lens(const JsonEntry& entry) {
  entry.allow_only({"focal_length_mm"});
  return {entry.at("focal_length_mm").number("a focal length in mm")};
}

std::size_t read_index(const JsonEntry& entry) {
  const double number = entry.number("the index of a surface");
  if (!(number >= 0 && number < 1e6) || number != std::floor(number))
    entry.fail("must be the index of a surface, counted from 0");
  return static_cast<std::size_t>(number);
}

Tolerance read_tolerance(const JsonEntry& entry) {
  entry.allow_only({"kind", "surfaces", "limit"});
  const JsonEntry name = entry.at("kind"), surfaces = entry.at("surfaces");
  const ToleranceKind* kind = find_tolerance_kind(name.text("a kind of tolerance"));
  if (!kind) name.fail("is not a kind of tolerance; TOLERANCES.md has them");
  const std::vector<JsonEntry> ends = surfaces.items("a surface, such as [2], or the first and the last");
  if (ends.empty() || ends.size() > 2)
    surfaces.fail("must be a surface, such as [2], or the first and the last");
  return {kind->name, read_index(ends.front()), read_index(ends.back()),
          entry.at("limit").number("a positive limit")};
}

SurfaceGroup read_group(const JsonEntry& entry) {
  entry.allow_only({"surfaces", "pose", "pivot_mm"});
  const JsonEntry surfaces = entry.at("surfaces");
  const std::vector<JsonEntry> ends = surfaces.items("the first and the last surface, such as [2, 3]");
  if (ends.size() != 2) surfaces.fail("must be the first and the last surface, such as [2, 3]");
  SurfaceGroup group{read_index(ends[0]), read_index(ends[1]), {}, 0};
  if (const auto pose = entry.find("pose"); pose && !pose->is_null()) group.pose = read_pose(*pose);
  if (const auto pivot = entry.find("pivot_mm")) group.pivot_mm = pivot->number("a distance in mm");
  return group;
}

/// {"names": ["wide", "tele"], "values": {"surfaces[4].thickness_mm": [1, 20]}}
LensStates read_states(const JsonEntry& entry) {
  entry.allow_only({"names", "values"});
  LensStates states;
  for (const JsonEntry& name : entry.at("names").items("a list of names, one a state"))
    states.names.push_back(name.text("the name of a state"));
  for (const auto& [path, values] :
       entry.at("values").members("an object of \"surfaces[4].thickness_mm\": [a value a state]")) {
    StateRow row{path, {}};
    for (const JsonEntry& value : values.items("a list, a value a state")) row.values.push_back(value.dump());
    states.rows.push_back(std::move(row));
  }
  return states;
}

/// \param last  the distance to the sensor may be left out.
Surface read_surface(const JsonEntry& entry, GlassLookup& glasses, bool last) {
  entry.allow_only({"radius_mm", "thickness_mm", "glass", "mirror", "semi_diameter_mm", "apertures", "conic",
                    "asphere", "shape", "stop", "blades", "grating", "ideal_lens", "pose", "melt", "transfer",
                    "scatter", "coating"});
  Surface surface;
  surface.curvature_per_mm = read_curvature(entry.at("radius_mm"));
  if (!last || entry.find("thickness_mm"))
    surface.thickness_mm = entry.at("thickness_mm").number("a distance in mm");
  if (const auto glass = entry.find("glass")) surface.material = read_glass(*glass, glasses);
  if (const auto mirror = entry.find("mirror"); mirror && !mirror->is_null())
    surface.mirror = mirror->truth();
  if (const auto melt = entry.find("melt"); melt && !melt->is_null())
    surface.material = located(*melt, [&] { return surface.material.melted(read_melt(*melt)); });
  if (const auto semi = entry.find("semi_diameter_mm"); semi && !semi->is_null())
    surface.semi_diameter_mm = semi->number("a semi-diameter in mm, or null for an unbounded surface");
  if (const auto apertures = entry.find("apertures"); apertures && !apertures->is_null())
    for (const JsonEntry& each : apertures->items("a list of apertures"))
      surface.apertures.push_back(read_aperture_figure(each));
  if (const auto conic = entry.find("conic")) surface.conic = conic->number("a conic constant");
  if (const auto asphere = entry.find("asphere")) read_asphere(*asphere, surface);
  if (const auto shape = entry.find("shape"); shape && !shape->is_null()) surface.shape = read_shape(*shape);
  if (const auto stop = entry.find("stop")) surface.stop = stop->truth();
  if (const auto blades = entry.find("blades"); blades && !blades->is_null())
    surface.blades = read_blades(*blades);
  if (const auto grating = entry.find("grating"); grating && !grating->is_null())
    surface.grating = read_grating(*grating);
  if (const auto ideal = entry.find("ideal_lens"); ideal && !ideal->is_null())
    surface.ideal_lens = read_ideal_lens(*ideal);
  if (const auto pose = entry.find("pose"); pose && !pose->is_null()) surface.pose = read_pose(*pose);
  if (const auto transfer = entry.find("transfer"); transfer && !transfer->is_null())
    surface.transfer = read_transfer(*transfer);
  if (const auto scatter = entry.find("scatter"); scatter && !scatter->is_null())
    surface.scatter = read_scatter(*scatter);
  if (const auto coating = entry.find("coating"); coating && !coating->is_null())
    surface.coating = read_surface_coating(*coating);
  return surface;
}

Aperture read_aperture(const JsonEntry& entry) {
  const auto members = entry.members("an object such as {\"f_number\": 2.8}");
  const std::string known = fmt::format("{}", fmt::join(aperture_keys, ", "));
  if (members.size() != 1) entry.fail("must have exactly one of " + known);
  const auto& [key, value] = members.front();
  const auto kind = std::find(std::begin(aperture_keys), std::end(aperture_keys), key);
  if (kind == std::end(aperture_keys)) value.fail("is not a kind of aperture; these are: " + known);
  return {static_cast<Aperture::Kind>(kind - std::begin(aperture_keys)), value.number("a number")};
}

Fields read_fields(const JsonEntry& entry) {
  entry.allow_only({"type", "values"});
  const JsonEntry type = entry.at("type");
  const auto kind = std::find(std::begin(field_types), std::end(field_types), type.text("a type of field"));
  if (kind == std::end(field_types))
    type.fail(fmt::format("is not a type of field; these are: {}", fmt::join(field_types, ", ")));
  return {static_cast<Fields::Kind>(kind - std::begin(field_types)),
          read_numbers(entry.at("values"), "a list of fields", "a field")};
}

void read_wavelengths(const JsonEntry& top, Lens& lens) {
  lens.wavelengths_nm =
      read_numbers(top.at("wavelengths_nm"), "a list of wavelengths in nm", "a wavelength in nm");
  if (const auto reference = top.find("reference_wavelength_nm"))
    lens.reference_wavelength_nm = reference->number("a wavelength in nm");
  else if (lens.wavelengths_nm.size() == 1)
    lens.reference_wavelength_nm = lens.wavelengths_nm.front();
  else
    top.at("reference_wavelength_nm");  // says that it is missing
}

/// The sensor in the paraxial image, where the file leaves the last distance open.
void focus_paraxially(Lens& lens, const JsonDocument& document) {
  const std::string place = fmt::format("surfaces[{}]", lens.surfaces.size() - 1);
  double& gap_mm = lens.surfaces.back().thickness_mm;
  gap_mm = 1;  // any
  if (const auto fault = find_fault(lens)) document.fail(fault->path, fault->message);
  const double image_mm = first_order(lens).paraxial_image_mm;
  gap_mm = lens.last_sense() * image_mm;
  if (!(image_mm > 0 && std::isfinite(image_mm)))
    document.fail(place, "forms no real image; \"thickness_mm\", the distance to the sensor, would be right");
}

/// Names all keys that are missing, with lines that would do.
void require_all(const JsonEntry& top, const JsonDocument& document) {
  constexpr std::pair<const char*, const char*> wanted[] = {
      {"format", "\"format\": \"petzval-lens/1\""},
      {"aperture", "\"aperture\": {\"f_number\": 4}"},
      {"wavelengths_nm", "\"wavelengths_nm\": [486.13, 587.56, 656.27], \"reference_wavelength_nm\": 587.56"},
      {"surfaces",
       "\"surfaces\": [{\"radius_mm\": 50, \"thickness_mm\": 5, \"glass\": \"SCHOTT:N-BK7\", "
       "\"stop\": true}, …]"}};
  std::vector<std::string> names, lines;
  for (const auto& [key, line] : wanted)
    if (!top.find(key)) names.push_back(fmt::format("\"{}\"", key)), lines.emplace_back(line);
  if (names.size() > 1)
    document.fail("", fmt::format("lacks {}; lines such as these would be right: {}", fmt::join(names, ", "),
                                  fmt::join(lines, ", ")));
}

}  // namespace

Lens read_native(const JsonDocument& document, const LensReadOptions& options) {
  const JsonEntry top(document);
  require_all(top, document);
  const JsonEntry format = top.at("format");
  if (format.text("a text") != native_format) format.fail(fmt::format("must be \"{}\"", native_format));
  top.allow_only({"format", "name", "source", "object_distance_mm", "aperture", "fields", "wavelengths_nm",
                  "reference_wavelength_nm", "object_glass", "surfaces", "groups", "sensor_pose",
                  "tolerances", "states", "scatter"});
  Lens lens;
  if (const auto name = top.find("name")) lens.name = name->text("a text");
  if (const auto source = top.find("source")) lens.source = source->text("a text");
  if (const auto distance = top.find("object_distance_mm"); distance && !distance->is_null())
    lens.object_distance_mm = distance->number("a distance in mm, or null for infinity");
  lens.aperture = read_aperture(top.at("aperture"));
  if (const auto fields = top.find("fields")) lens.fields = read_fields(*fields);
  read_wavelengths(top, lens);
  GlassLookup glasses(options);
  if (const auto medium = top.find("object_glass")) lens.object_material = read_glass(*medium, glasses);
  const std::vector<JsonEntry> surfaces = top.at("surfaces").items("a list of surfaces, front to back");
  for (const JsonEntry& surface : surfaces)
    lens.surfaces.push_back(read_surface(surface, glasses, &surface == &surfaces.back()));
  if (const auto groups = top.find("groups"); groups && !groups->is_null())
    for (const JsonEntry& group : groups->items("a list of groups of surfaces"))
      lens.groups.push_back(read_group(group));
  if (const auto tolerances = top.find("tolerances"); tolerances && !tolerances->is_null())
    for (const JsonEntry& tolerance : tolerances->items("a list of tolerances"))
      lens.tolerances.push_back(read_tolerance(tolerance));
  if (const auto pose = top.find("sensor_pose"); pose && !pose->is_null())
    lens.sensor_pose = read_pose(*pose);
  if (const auto scatter = top.find("scatter"); scatter && !scatter->is_null())
    lens.scatter = read_scatter(*scatter);
  if (const auto states = top.find("states"); states && !states->is_null())
    lens.states = read_states(*states);
  if (!surfaces.empty() && !surfaces.back().find("thickness_mm")) focus_paraxially(lens, document);
  if (const auto fault = find_fault(lens)) document.fail(fault->path, fault->message);
  try {
    glasses.require_all_used();
  } catch (const InputError& error) {
    document.fail("", error.what());
  }
  for (std::size_t i = 0; i < lens.states.size(); ++i) try {
      in_state(lens, static_cast<double>(i), options);
    } catch (const InputError& error) {
      document.fail(fmt::format("states.names[{}]", i), error.what());
    }
  return lens;
}

Lens lens_from_json(const std::string& text, const std::string& file, const LensReadOptions& options) {
  return read_native(JsonDocument(text, file), options);
}

}  // namespace petzval
