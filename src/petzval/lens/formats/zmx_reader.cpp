// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/field_point.h>
#include <petzval/lens/formats/zmx.h>
#include <petzval/lens/formats/zmx_configurations.h>
#include <petzval/lens/formats/zmx_keywords.h>
#include <petzval/lens/formats/zmx_surfaces.h>
#include <petzval/lens/lens_fault.h>
#include <petzval/lens/lens_states.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

namespace petzval {

namespace {

double read_unit(const ZmxFile& file) {
  static const std::map<std::string, double> mm_per_unit{
      {"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}, {"M", 1000}};
  const ZmxRecord* record = file.header.find("UNIT");
  if (!record) return 1;
  const auto unit = mm_per_unit.find(record->has(0) ? record->values[0] : "");
  if (unit == mm_per_unit.end())
    file.fail(file.header, record->line,
              fmt::format("UNIT \"{}\" is not known; MM, CM, IN and METER are", quotable(record->rest)));
  return unit->second;
}

/// Catalogue indices hold at 20 °C and 1 atm; a file may ask for others to be used.
void check_environment(const ZmxFile& file) {
  const ZmxRecord* mode = file.header.find("MODE");
  if (mode && mode->rest != "SEQ")
    file.fail(file.header, mode->line,
              fmt::format("MODE {} is not modelled; MODE SEQ is", quotable(mode->rest)));
  const ZmxRecord* air = file.header.find("ENVD");
  if (!air || file.number_or(file.header, *air, 2, 0) == 0) return;
  if (file.number(file.header, *air, 0) != 20 || file.number(file.header, *air, 1) != 1)
    file.fail(file.header, air->line,
              "indices at another temperature or pressure are not modelled; 20 and 1 atm are");
}

Aperture read_aperture(const ZmxContext& context) {
  using Kind = Aperture::Kind;
  const ZmxFile& file = context.file;
  const ZmxBlock& header = file.header;
  std::vector<const ZmxRecord*> given;
  for (const char* keyword : {"ENPD", "FNUM", "OBNA", "FLOA"})
    if (const ZmxRecord* record = header.find(keyword)) given.push_back(record);
  if (given.size() != 1)
    throw InputError(
        file.name,
        fmt::format("gives {} system apertures; exactly one of ENPD, FNUM, OBNA and FLOA must be there",
                    given.size()));
  const ZmxRecord& record = *given.front();
  if (record.keyword == "FLOA") return {Kind::stop_semi_diameter_mm, zmx_stop_semi_diameter_mm(context)};
  const double value = file.number(header, record, 0);
  const bool flag = file.number_or(header, record, 1, 0) != 0;
  if (record.keyword == "ENPD") return {Kind::entrance_pupil_diameter_mm, value * context.mm_per_unit};
  if (record.keyword == "FNUM") return {flag ? Kind::working_f_number : Kind::f_number, value};
  return {Kind::object_na, flag ? std::sin(radians(value)) : value};  // with the flag, half the cone's angle
}

/// The first `count` numbers of a record, all if count is not known.
std::vector<double> read_list(const ZmxFile& file, const ZmxRecord& record, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < std::min(count, record.values.size()); ++i)
    numbers.push_back(file.number(file.header, record, i));
  return numbers;
}

/// Value i of FTYP, a whole number that is not negative.
std::optional<std::size_t> field_option(const ZmxFile& file, std::size_t i) {
  const ZmxRecord* record = file.header.find("FTYP");
  if (!record || !record->has(i)) return {};
  const auto value = parse_integer(record->values[i]);
  if (!value || *value < 0)
    file.fail(file.header, record->line, fmt::format("value {} of FTYP must be a whole number", i + 1));
  return static_cast<std::size_t>(*value);
}

Fields read_fields(const ZmxContext& context) {
  const ZmxFile& file = context.file;
  Fields fields;
  const std::size_t type = field_option(file, 0).value_or(0);
  if (type > 3)
    file.fail(file.header, file.header.find("FTYP")->line,
              fmt::format(
                  "field type {} (FTYP) is not modelled; 0 to 3 are: angle, object height, paraxial and real "
                  "image height",
                  type));
  fields.kind = static_cast<Fields::Kind>(type);
  const bool is_angle = fields.kind == Fields::Kind::angle_deg;
  if (field_option(file, 1).value_or(0) != 0)
    context.notes.push_back(
        file.name + ": telecentric in object space (FTYP); chief rays are aimed at the stop all the same");
  const auto list = [&](const char* new_name, const char* old_name) {
    const ZmxRecord* record =
        file.header.find(new_name) ? file.header.find(new_name) : file.header.find(old_name);
    // The oldest files have as many values as fields and give no count.
    return record ? read_list(file, *record, field_option(file, 2).value_or(record->values.size()))
                  : std::vector<double>();
  };
  const std::vector<double> x = list("XFLN", "XFLD"), y = list("YFLN", "YFLD");
  const double scale = is_angle ? 1 : context.mm_per_unit;
  fields.values.clear();
  for (std::size_t i = 0; i < std::max(x.size(), y.size()); ++i)
    fields.values.push_back(scale * radial_field(i < x.size() ? x[i] : 0, i < y.size() ? y[i] : 0, is_angle));
  if (fields.values.empty()) fields.values = {0};
  return fields;
}

double wavelength_nm(const ZmxFile& file, const ZmxRecord& record, std::size_t i) {
  constexpr int nm_per_um_power = 3;
  file.number(file.header, record, i);  // complains if it is not a number
  return parse_scaled_number(record.values[i], nm_per_um_power).value_or(0);
}

std::vector<double> wavelengths_nm(const ZmxFile& file) {
  std::vector<double> wavelengths;
  for (const ZmxRecord& record : file.header.records) {
    if (record.keyword != "WAVM") continue;
    const double number = file.number(file.header, record, 0);
    if (number != static_cast<double>(wavelengths.size() + 1))
      file.fail(file.header, record.line,
                fmt::format("WAVM must be numbered 1, 2, 3 …; this should be {}", wavelengths.size() + 1));
    wavelengths.push_back(wavelength_nm(file, record, 1));
  }
  for (const char* keyword : {"WAVL", "WAVN"})
    if (const ZmxRecord* record = file.header.find(keyword); record && wavelengths.empty())
      for (std::size_t i = 0; i < record->values.size(); ++i)
        wavelengths.push_back(wavelength_nm(file, *record, i));
  // The list goes on to 24 with values of no meaning.
  const std::size_t count = field_option(file, 3).value_or(0);
  if (count > 0 && wavelengths.size() > count) wavelengths.resize(count);
  return wavelengths;
}

void read_wavelengths(const ZmxFile& file, Lens& lens) {
  lens.wavelengths_nm = wavelengths_nm(file);
  if (lens.wavelengths_nm.empty())
    throw InputError(file.name, "has no wavelengths; WAVM 1 0.5875618 1 would give one");
  const ZmxRecord* primary = file.header.find("PWAV");
  const double number = primary ? file.number(file.header, *primary, 0) : 1;
  if (!(number >= 1 && number <= static_cast<double>(lens.wavelengths_nm.size())) ||
      number != std::floor(number))
    file.fail(file.header, primary->line,
              fmt::format("PWAV must be the number of a wavelength, 1 to {}", lens.wavelengths_nm.size()));
  lens.reference_wavelength_nm = lens.wavelengths_nm[static_cast<std::size_t>(number) - 1];
}

/// The line of the surface that a path such as "surfaces[4].conic" names; that of the header's end otherwise.
int line_of(const ZmxFile& file, const std::string& path) {
  const std::string prefix = "surfaces[";
  if (path.compare(0, prefix.size(), prefix) != 0) return file.surfaces.front().line;
  const auto i = static_cast<std::size_t>(std::atoi(path.c_str() + prefix.size()));
  return file.surfaces[zmx_block_of(file, i)].line;
}

void note_unbounded(const ZmxFile& file, const Lens& lens, std::vector<std::string>& notes) {
  const auto unbounded =
      std::count_if(lens.surfaces.begin(), lens.surfaces.end(),
                    [](const Surface& surface) { return !surface.semi_diameter_mm && !surface.stop; });
  if (unbounded > 0)
    notes.push_back(fmt::format("{}: {} of {} surfaces have no clear aperture and are unbounded", file.name,
                                unbounded, lens.surfaces.size()));
}

/// One configuration. \param notes  what its reader has to say, but for the glasses.
Lens read_one(const ZmxFile& file, GlassLookup& glasses, std::vector<std::string>& notes) {
  ZmxContext context{file, glasses, read_unit(file), {}, notes};
  if (const ZmxRecord* catalogues = file.header.find("GCAT")) context.catalogues = catalogues->values;
  Lens lens;
  if (const ZmxRecord* name = file.header.find("NAME")) lens.name = name->rest;
  lens.object_distance_mm = zmx_object_distance_mm(context);
  put_zmx_surfaces(context, lens);
  glasses.require_all_found();
  lens.aperture = read_aperture(context);
  lens.fields = read_fields(context);
  read_wavelengths(file, lens);
  if (const auto fault = find_fault(lens))
    throw InputError(file.name, line_of(file, fault->path), fault->path + " " + fault->message);
  return lens;
}

/// Each configuration becomes a state, config-1 and so on, unless there is something in them that is not
/// modelled.
void put_configurations(const ZmxFile& file, GlassLookup& glasses, Lens& lens,
                        std::vector<std::string>& notes) {
  const std::size_t count = zmx_configuration_count(file);
  if (count < 2) return;
  const auto say = [&](const std::string& text) {
    notes.push_back(fmt::format("{}:{}: of {} configurations (MNUM) {}", file.name,
                                file.header.find("MNUM")->line, count, text));
  };
  if (const std::string fault = zmx_configurations_fault(file); !fault.empty())
    return say(fmt::format("the one written out in the surfaces is read: {}", fault));
  std::vector<std::string> names, scratch;
  std::vector<Lens> lenses;
  for (std::size_t i = 1; i <= count; ++i) {
    names.push_back(fmt::format("config-{}", i));
    lenses.push_back(read_one(zmx_configuration(file, i), glasses, scratch));
    if (!zmx_solves_image(file)) continue;
    const double image_mm = first_order(lenses.back()).paraxial_image_mm;
    if (!std::isfinite(image_mm))
      throw InputError(file.name,
                       fmt::format("configuration {} forms no paraxial image to solve for (MAZH)", i));
    lenses.back().surfaces.back().thickness_mm = lens.last_sense() * image_mm;
  }
  LensStates states = states_beside(lens, std::move(names), std::move(lenses));
  if (states.rows.empty()) return say("all are the same");
  lens.states = std::move(states);
  say(fmt::format("each is a state, config-1 to config-{}; the one written out in the surfaces is read",
                  count));
}

/// An object at a plane that does nothing (a slit that is drawn twice) lies where that plane's gap begins.
void join_object_plane(ZmxFile& file) {
  constexpr std::size_t fewest = 4;
  if (file.surfaces.size() < fewest || zmx_configuration_count(file) > 1) return;
  ZmxBlock& object = file.surfaces[0];
  const ZmxBlock& plane = file.surfaces[1];
  const ZmxRecord* distance = object.find("DISZ");
  const ZmxRecord* gap = plane.find("DISZ");
  if (!distance || !gap || object.find("GLAS") || !distance->has(0) || parse_number(distance->values[0]) != 0)
    return;
  for (const char* alters : {"STOP", "GLAS", "CLAP", "FLAP", "SQAP", "ELAP", "OBSC", "SQOB", "ELOB", "SPID"})
    if (plane.find(alters)) return;
  const ZmxRecord* type = plane.find("TYPE");
  const ZmxRecord* curvature = plane.find("CURV");
  if (!type || type->rest != "STANDARD" || (curvature && file.number_or(plane, *curvature, 0, 0) != 0))
    return;
  object.records.push_back(*gap);
  file.surfaces.erase(file.surfaces.begin() + 1);
}

}  // namespace

LensFile read_zmx(const std::string& text, const std::string& file_name, const LensReadOptions& options) {
  ZmxFile file = zmx_records(text, file_name);
  join_object_plane(file);
  LensFile result;
  result.notes = check_zmx_keywords(file);
  check_environment(file);
  GlassLookup glasses(options, file_name, result.notes);
  result.lens = read_one(file, glasses, result.notes);
  put_configurations(file, glasses, result.lens, result.notes);
  try {
    glasses.require_all_used();
  } catch (const InputError& error) {
    throw InputError(file_name, error.what());
  }
  note_unbounded(file, result.lens, result.notes);
  return result;
}

}  // namespace petzval
