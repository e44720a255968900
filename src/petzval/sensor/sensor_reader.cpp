// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/lens/formats/json_document.h>
#include <petzval/sensor/sensor_reader.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace petzval {

namespace {

// Far beyond any sensor built, and small enough that columns × rows cannot overflow.
constexpr int max_side = 1 << 17;
constexpr double max_pitch_um = 1000;
constexpr std::size_t max_channels = 64, max_mosaic_side = 64;

using Entries = std::vector<JsonEntry>;

/// A number within bounds, in words: "must be a number from 0 to 1".
double number_in(const JsonEntry& entry, double least, double most, const char* unit = "") {
  const std::string range =
      fmt::format("a number{}{} from {:g} to {:g}", *unit ? " of " : "", unit, least, most);
  const double value = entry.number(range.c_str());
  if (!(value >= least && value <= most)) entry.fail(fmt::format("is {:g}; {} would be right", value, range));
  return value;
}

double number_in(const JsonEntry& parent, const char* key, double least, double most, const char* unit,
                 double otherwise) {
  const auto entry = parent.find(key);
  return entry ? number_in(*entry, least, most, unit) : otherwise;
}

int whole_in(const JsonEntry& entry, int least, int most) {
  const double value = number_in(entry, least, most);
  if (value != std::floor(value))
    entry.fail(fmt::format("is {:g}; a whole number from {} to {} would be right", value, least, most));
  return static_cast<int>(value);
}

std::vector<double> numbers(const JsonEntry& entry, double least, double most, const char* unit) {
  std::vector<double> values;
  for (const JsonEntry& item : entry.items("a list of numbers"))
    values.push_back(number_in(item, least, most, unit));
  if (values.empty()) entry.fail("is empty; at least one number must be there");
  return values;
}

void require_increasing(const JsonEntry& entry, const std::vector<double>& values) {
  if (std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end())
    entry.fail("must increase strictly");
}

/// Two lists of one length, the first increasing: a curve.
void read_curve(const JsonEntry& parent, const char* x_key, double x_least, double x_most, const char* y_key,
                double y_least, double y_most, std::vector<double>& x, std::vector<double>& y) {
  x = numbers(parent.at(x_key), x_least, x_most, "");
  require_increasing(parent.at(x_key), x);
  y = numbers(parent.at(y_key), y_least, y_most, "");
  if (x.size() != y.size())
    parent.at(y_key).fail(fmt::format("has {} numbers for the {} of \"{}\"", y.size(), x.size(), x_key));
}

// ---- quantum efficiency

Spectrum read_factor(const JsonEntry& entry) {
  if (entry.find("set")) {
    entry.allow_only({"set", "spectrum", "scale"});
    const double scale = number_in(entry, "scale", 0, 1e6, "", 1);
    try {
      return read_spectrum_set(entry.at("set").text("the name of a set of spectra"))
          .find(entry.at("spectrum").text("the name of a spectrum"))
          .scaled(scale);
    } catch (const InputError& error) {
      entry.fail(std::string("cannot be had: ") + error.what());
    }
  }
  entry.allow_only({"wavelengths_nm", "values"});
  std::vector<double> nm, values;
  read_curve(entry, "wavelengths_nm", 0, 1e5, "values", 0, 1e6, nm, values);
  for (const double wavelength : nm)
    if (const std::string wrong = wavelength_fault(wavelength); !wrong.empty())
      entry.at("wavelengths_nm").fail(wrong);
  return {nm, values};
}

/// Of a filter on a diode: at every wavelength that either is known at.
Spectrum product(const Spectrum& a, const Spectrum& b) {
  std::set<double> nm(a.wavelengths_nm().begin(), a.wavelengths_nm().end());
  nm.insert(b.wavelengths_nm().begin(), b.wavelengths_nm().end());
  const double from = std::max(a.front_nm(), b.front_nm()), to = std::min(a.back_nm(), b.back_nm());
  std::vector<double> kept, values;
  for (const double at : nm) {
    if (at < from || at > to) continue;
    kept.push_back(at);
    values.push_back(a.at(at) * b.at(at));
  }
  return kept.empty() ? Spectrum({a.front_nm()}, {0.0}) : Spectrum(kept, values);
}

Spectrum read_quantum_efficiency(const JsonEntry& entry) {
  Spectrum total;
  for (const JsonEntry& factor : entry.items("a list of spectra, which are multiplied")) {
    const Spectrum spectrum = read_factor(factor);
    total = total.empty() ? spectrum : product(total, spectrum);
  }
  if (total.empty()) entry.fail("is empty; at least one spectrum must be there");
  const auto greatest = std::max_element(total.values().begin(), total.values().end());
  const double at_nm = total.wavelengths_nm()[static_cast<std::size_t>(greatest - total.values().begin())];
  if (*greatest > 1)
    entry.fail(
        fmt::format("is {:.4g} at {:g} nm; more than 1 electron a photon cannot be", *greatest, at_nm));
  const auto least = std::min_element(total.values().begin(), total.values().end());
  if (*least < 0) entry.fail(fmt::format("falls to {:.4g}; it cannot be negative", *least));
  if (*greatest == 0) entry.fail("is zero everywhere; such a channel sees nothing");
  return total;
}

std::vector<SensorChannel> read_channels(const JsonEntry& entry) {
  std::vector<SensorChannel> channels;
  const Entries items = entry.items("a list of channels");
  if (items.empty() || items.size() > max_channels)
    entry.fail(fmt::format("has {} channels; 1 to {} would be right", items.size(), max_channels));
  for (const JsonEntry& item : items) {
    item.allow_only({"name", "quantum_efficiency"});
    const std::string name = item.at("name").text("a name");
    if (name.empty()) item.at("name").fail("is empty");
    for (const SensorChannel& other : channels)
      if (other.name == name) item.at("name").fail("is the name of another channel too");
    channels.push_back({name, read_quantum_efficiency(item.at("quantum_efficiency"))});
  }
  return channels;
}

Mosaic read_mosaic(const JsonEntry& entry, const std::vector<SensorChannel>& channels) {
  const Entries rows = entry.items("a list of rows of names of channels");
  Mosaic mosaic{static_cast<int>(rows.size()), 0, {}};
  if (rows.empty() || rows.size() > max_mosaic_side)
    entry.fail(fmt::format("has {} rows; 1 to {} would be right", rows.size(), max_mosaic_side));
  std::set<int> used;
  for (const JsonEntry& row : rows) {
    const Entries cells = row.items("a list of names of channels");
    if (mosaic.columns == 0) mosaic.columns = static_cast<int>(cells.size());
    if (cells.empty() || cells.size() > max_mosaic_side || static_cast<int>(cells.size()) != mosaic.columns)
      row.fail(fmt::format("has {} cells; all rows must have the same number, 1 to {}", cells.size(),
                           max_mosaic_side));
    for (const JsonEntry& cell : cells) {
      const std::string name = cell.text("the name of a channel");
      const auto found = std::find_if(channels.begin(), channels.end(),
                                      [&](const SensorChannel& channel) { return channel.name == name; });
      if (found == channels.end()) cell.fail(fmt::format("is \"{}\", which no channel is called", name));
      mosaic.cells.push_back(static_cast<int>(found - channels.begin()));
      used.insert(mosaic.cells.back());
    }
  }
  if (used.size() != channels.size()) entry.fail("leaves out a channel; every channel must have a pixel");
  return mosaic;
}

// ---- optics of the pixel

Photosite read_photosite(const JsonEntry& root, double pitch_um) {
  Photosite site;
  if (const auto entry = root.find("photosite"); entry && entry->find("fill_factor")) {
    entry->allow_only({"fill_factor"});
    constexpr double least_share = 1e-4;
    site = Photosite::square(number_in(entry->at("fill_factor"), least_share, 1, ""));
  } else if (entry) {
    entry->allow_only({"shape", "width_um", "height_um"});
    const std::string shape = entry->at("shape").text("\"rectangle\" or \"ellipse\"");
    if (shape != "rectangle" && shape != "ellipse")
      entry->at("shape").fail(fmt::format("is \"{}\"; \"rectangle\" or \"ellipse\" would be right", shape));
    site.shape = shape == "ellipse" ? Photosite::Shape::ellipse : Photosite::Shape::rectangle;
    constexpr double least_um = 1e-3;
    site.width = number_in(entry->at("width_um"), least_um, pitch_um, "µm") / pitch_um;
    site.height = number_in(entry->at("height_um"), least_um, pitch_um, "µm") / pitch_um;
  }
  constexpr double most_pitches = 4;
  site.separation_x = site.separation_y =
      number_in(root, "low_pass_um", 0, most_pitches * pitch_um, "µm", 0) / pitch_um;
  return site;
}

Microlens read_microlens(const JsonEntry& entry) {
  entry.allow_only({"angles_deg", "response", "design_heights_mm", "design_angles_deg"});
  Microlens microlens;
  read_curve(entry, "angles_deg", 0, 90, "response", 0, 1, microlens.angles_deg, microlens.response);
  if (microlens.angles_deg.front() != 0 || microlens.response.front() != 1)
    entry.at("response").fail("must begin with 1 at an angle of 0: it is relative");
  if (entry.find("design_heights_mm") || entry.find("design_angles_deg"))
    read_curve(entry, "design_heights_mm", 0, 1e4, "design_angles_deg", 0, 90, microlens.design_heights_mm,
               microlens.design_angles_deg);
  return microlens;
}

void read_crosstalk(const JsonEntry& entry, SensorElectronics& electronics) {
  const Entries rows = entry.items("3 rows of 3 shares");
  double sum = 0;
  if (rows.size() != 3)
    entry.fail(fmt::format("has {} rows; 3 rows of 3 shares would be right", rows.size()));
  for (std::size_t r = 0; r < 3; ++r) {
    const std::vector<double> shares = numbers(rows[r], 0, 1, "");
    if (shares.size() != 3) rows[r].fail(fmt::format("has {} shares; 3 would be right", shares.size()));
    for (std::size_t c = 0; c < 3; ++c) sum += electronics.crosstalk[r][c] = shares[c];
  }
  constexpr double rounding = 1e-6;
  if (sum > 1 + rounding)
    entry.fail(fmt::format("hands out {:.6g} of each electron; at most 1 would be right", sum));
}

// ---- electronics

GainMode read_gain_mode(const JsonEntry& entry) {
  entry.allow_only({"name", "full_well_e", "dn_per_e", "read_noise_e", "adc_noise_dn", "max_analog_gain"});
  GainMode mode;
  mode.name = entry.at("name").text("a name");
  mode.full_well_e = number_in(entry.at("full_well_e"), 1, 1e9, "electrons");
  mode.dn_per_e = number_in(entry.at("dn_per_e"), 1e-9, 1e6, "DN per electron");
  mode.read_noise_e = number_in(entry.at("read_noise_e"), 0, 1e6, "electrons");
  mode.adc_noise_dn = number_in(entry, "adc_noise_dn", 0, 1e5, "DN", 0);
  mode.max_analog_gain = number_in(entry, "max_analog_gain", 1, 1e5, "", 1);
  return mode;
}

void read_adc(const JsonEntry& entry, SensorElectronics& electronics) {
  entry.allow_only({"bits", "black_level_dn", "white_level_dn", "linearity"});
  constexpr int max_bits = 16;
  electronics.bits = whole_in(entry.at("bits"), 1, max_bits);
  const double greatest = std::exp2(electronics.bits) - 1;
  electronics.white_level_dn = number_in(entry, "white_level_dn", 1, 1e9, "DN", greatest);
  if (electronics.white_level_dn > greatest)
    entry.at("white_level_dn")
        .fail(fmt::format("is {:g}, but {} bits reach only to {:g}", electronics.white_level_dn,
                          electronics.bits, greatest));
  electronics.black_level_dn = number_in(entry, "black_level_dn", 0, 1e9, "DN", 0);
  if (!(electronics.black_level_dn < electronics.white_level_dn))
    entry.at("black_level_dn")
        .fail(fmt::format("is {:g}; it must lie below the white level, {:g}", electronics.black_level_dn,
                          electronics.white_level_dn));
  for (const char* key : {"white_level_dn", "black_level_dn"})
    if (const auto level = entry.find(key)) whole_in(*level, 0, 65535);
  if (const auto linearity = entry.find("linearity")) {
    linearity->allow_only({"fractions", "deviations"});
    read_curve(*linearity, "fractions", 0, 1, "deviations", -0.5, 0.5, electronics.linearity_fractions,
               electronics.linearity_deviations);
    double before = 0;
    for (std::size_t i = 0; i < electronics.linearity_fractions.size(); ++i) {
      const double out = electronics.linearity_fractions[i] * (1 + electronics.linearity_deviations[i]);
      if (i > 0 && out <= before) linearity->fail("makes the output fall where the signal rises");
      before = out;
    }
  }
}

void read_dark(const JsonEntry& entry, SensorElectronics& electronics) {
  entry.allow_only({"current_e_per_s", "temperature_c", "doubling_c"});
  electronics.dark_current_e_per_s = number_in(entry.at("current_e_per_s"), 0, 1e9, "electrons per second");
  electronics.dark_temperature_c = number_in(entry, "temperature_c", -270, 200, "°C", 20);
  electronics.dark_doubling_c = number_in(entry, "doubling_c", 0.1, 100, "°C", 8);
}

void read_defects(const JsonEntry& entry, SensorElectronics& electronics) {
  entry.allow_only({"hot_pixels_per_million", "hot_current_e_per_s", "dead_pixels_per_million"});
  constexpr double most = 1e5;  // a tenth of all pixels
  electronics.hot_pixels_per_million = number_in(entry, "hot_pixels_per_million", 0, most, "", 0);
  electronics.hot_current_e_per_s =
      number_in(entry, "hot_current_e_per_s", 0, 1e9, "electrons per second", 0);
  electronics.dead_pixels_per_million = number_in(entry, "dead_pixels_per_million", 0, most, "", 0);
}

Shutter read_shutter(const JsonEntry& entry) {
  entry.allow_only({"kind", "row_time_us"});
  const std::string kind = entry.at("kind").text("\"global\" or \"rolling\"");
  if (kind != "global" && kind != "rolling")
    entry.at("kind").fail(fmt::format("is \"{}\"; \"global\" or \"rolling\" would be right", kind));
  Shutter shutter;
  if (kind == "global") {
    if (const auto time = entry.find("row_time_us")) time->fail("is for a rolling shutter");
    return shutter;
  }
  constexpr double least_us = 1e-3, most_us = 1e6, s_per_us = 1e-6;
  shutter.kind = Shutter::Kind::rolling;
  shutter.row_time_s = s_per_us * number_in(entry.at("row_time_us"), least_us, most_us, "µs");
  return shutter;
}

SensorElectronics read_electronics(const JsonEntry& root) {
  SensorElectronics electronics;
  electronics.channels = read_channels(root.at("channels"));
  if (const auto mosaic = root.find("mosaic"))
    electronics.mosaic = read_mosaic(*mosaic, electronics.channels);
  else if (electronics.channels.size() > 1)
    root.at("channels").fail("are several, so \"mosaic\" must say which pixel has which");
  if (const auto microlens = root.find("microlens")) electronics.microlens = read_microlens(*microlens);
  if (const auto crosstalk = root.find("crosstalk")) read_crosstalk(*crosstalk, electronics);
  const Entries modes = root.at("gain_modes").items("a list of conversion gains");
  if (modes.empty()) root.at("gain_modes").fail("is empty; at least one conversion gain must be there");
  for (const JsonEntry& mode : modes) {
    electronics.gain_modes.push_back(read_gain_mode(mode));
    for (std::size_t i = 0; i + 1 < electronics.gain_modes.size(); ++i)
      if (electronics.gain_modes[i].name == electronics.gain_modes.back().name)
        mode.at("name").fail("is the name of another conversion gain too");
  }
  read_adc(root.at("adc"), electronics);
  if (const auto dark = root.find("dark")) read_dark(*dark, electronics);
  if (const auto defects = root.find("defects")) read_defects(*defects, electronics);
  if (const auto shutter = root.find("shutter")) electronics.shutter = read_shutter(*shutter);
  if (const auto blooming = root.find("blooming")) {
    constexpr double most = 1e9;
    blooming->allow_only({"onset"});
    electronics.blooming_onset = number_in(blooming->at("onset"), 1, most, "full wells");
  }
  electronics.dsnu_e = number_in(root, "dsnu_e", 0, 1e6, "electrons", 0);
  electronics.prnu = number_in(root, "prnu_percent", 0, 50, "percent", 0) / 100;
  electronics.column_pattern_e = number_in(root, "column_pattern_e", 0, 1e6, "electrons", 0);
  electronics.row_noise_e = number_in(root, "row_noise_e", 0, 1e6, "electrons", 0);
  if (const auto serial = root.find("serial"))
    electronics.serial = static_cast<std::uint64_t>(whole_in(*serial, 0, 2'000'000'000));
  return electronics;
}

}  // namespace

std::string complaint_about(const SensorGeometry& geometry) {
  for (const int side : {geometry.columns, geometry.rows})
    if (side < 1 || side > max_side)
      return fmt::format("{} pixels on a side; 1 to {} would be right", side, max_side);
  if (!(geometry.pitch_um > 0 && geometry.pitch_um <= max_pitch_um))
    return fmt::format("a pitch of {} µm; above 0 and up to {} would be right", geometry.pitch_um,
                       max_pitch_um);
  return "";
}

Sensor parse_sensor(const std::string& text, const std::string& file) {
  return parse_sensor(JsonDocument(text, file));
}

Sensor parse_sensor(const JsonDocument& document) {
  const JsonEntry root(document);
  root.allow_only({"format",      "name",        "source",   "columns", "rows",         "pitch_um",
                   "photosite",   "low_pass_um", "channels", "mosaic",  "microlens",    "crosstalk",
                   "gain_modes",  "adc",         "dark",     "dsnu_e",  "prnu_percent", "column_pattern_e",
                   "row_noise_e", "defects",     "shutter",  "serial",  "reflectance",  "microlens_sag_um",
                   "blooming"});
  if (const std::string format = root.at("format").text("\"petzval-sensor/1\""); format != "petzval-sensor/1")
    root.at("format").fail("is another format; \"petzval-sensor/1\" would be right");
  Sensor sensor;
  sensor.name = root.at("name").text("a name");
  sensor.source = root.at("source").text("where the figures are from");
  sensor.geometry = {whole_in(root.at("columns"), 1, max_side), whole_in(root.at("rows"), 1, max_side),
                     root.at("pitch_um").number("a number of µm")};
  if (const std::string wrong = complaint_about(sensor.geometry); !wrong.empty())
    root.at("pitch_um").fail("gives " + wrong);
  sensor.photosite = read_photosite(root, sensor.geometry.pitch_um);
  if (const auto entry = root.find("reflectance")) sensor.reflectance = number_in(*entry, 0, 1);
  if (const auto entry = root.find("microlens_sag_um")) {
    sensor.microlens_sag_um = number_in(*entry, 0, 100);
    if (!sensor.reflectance) entry->fail("needs \"reflectance\" beside it: how much light it turns back");
  }
  if (root.find("channels")) {
    sensor.electronics = read_electronics(root);
  } else {
    for (const char* key :
         {"mosaic", "microlens", "crosstalk", "gain_modes", "adc", "dark", "dsnu_e", "prnu_percent",
          "column_pattern_e", "row_noise_e", "defects", "shutter", "serial", "blooming"})
      if (root.find(key)) root.at(key).fail("needs \"channels\" beside it: what the sensor sees");
  }
  return sensor;
}

}  // namespace petzval
