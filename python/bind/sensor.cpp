// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bind.h"
#include "constructor.h"

namespace petzval::python {

namespace {

using Curve = std::pair<Numbers, Numbers>;

Sensor read(const std::string& text, const std::map<std::string, nb::object>& settings) {
  std::vector<std::string> altered;
  for (const auto& [path, value] : settings)
    altered.push_back(path + "=" + nb::cast<std::string>(call_python("json", "dumps", value)));
  return read_sensor(text, altered);
}

// For pickle: every member, as nested tuples.

nb::tuple state_of(const Photosite& p) {
  return nb::make_tuple(static_cast<int>(p.shape), p.width, p.height, p.vertices, p.separation_x,
                        p.separation_y);
}

Photosite photosite_of(const nb::tuple& t) {
  return {
      static_cast<Photosite::Shape>(nb::cast<int>(t[0])),     nb::cast<double>(t[1]), nb::cast<double>(t[2]),
      nb::cast<std::vector<std::pair<double, double>>>(t[3]), nb::cast<double>(t[4]), nb::cast<double>(t[5])};
}

nb::tuple state_of(const SensorElectronics& e) {
  std::vector<std::tuple<std::string, Numbers, Numbers>> channels;
  for (const SensorChannel& c : e.channels)
    channels.emplace_back(c.name, c.quantum_efficiency.wavelengths_nm(), c.quantum_efficiency.values());
  std::vector<std::tuple<std::string, std::array<double, 5>>> modes;
  for (const GainMode& m : e.gain_modes)
    modes.emplace_back(
        m.name, std::array{m.full_well_e, m.dn_per_e, m.read_noise_e, m.adc_noise_dn, m.max_analog_gain});
  nb::object microlens = nb::none();
  if (e.microlens)
    microlens = nb::make_tuple(e.microlens->angles_deg, e.microlens->response, e.microlens->design_heights_mm,
                               e.microlens->design_angles_deg);
  return nb::make_tuple(
      channels, std::tuple(e.mosaic.rows, e.mosaic.columns, e.mosaic.cells), e.crosstalk, microlens, modes,
      e.bits, e.black_level_dn, e.white_level_dn, e.linearity_fractions, e.linearity_deviations,
      std::array{e.dark_current_e_per_s, e.dark_temperature_c, e.dark_doubling_c, e.dsnu_e, e.prnu,
                 e.column_pattern_e, e.row_noise_e, e.hot_pixels_per_million, e.hot_current_e_per_s,
                 e.dead_pixels_per_million, e.blooming_onset, e.shutter.row_time_s},
      e.serial, e.shutter.kind == Shutter::Kind::rolling);
}

SensorElectronics electronics_of(const nb::tuple& t) {
  SensorElectronics e;
  for (auto& [name, nm, values] : nb::cast<std::vector<std::tuple<std::string, Numbers, Numbers>>>(t[0]))
    e.channels.push_back({name, Spectrum(nm, values)});
  std::tie(e.mosaic.rows, e.mosaic.columns, e.mosaic.cells) =
      nb::cast<std::tuple<int, int, std::vector<int>>>(t[1]);
  e.crosstalk = nb::cast<decltype(e.crosstalk)>(t[2]);
  if (!t[3].is_none()) {
    const auto [angles, response, heights, design] =
        nb::cast<std::tuple<Numbers, Numbers, Numbers, Numbers>>(t[3]);
    e.microlens = Microlens{angles, response, heights, design};
  }
  for (const auto& [name, n] : nb::cast<std::vector<std::tuple<std::string, std::array<double, 5>>>>(t[4]))
    e.gain_modes.push_back({name, n[0], n[1], n[2], n[3], n[4]});
  e.bits = nb::cast<int>(t[5]);
  e.black_level_dn = nb::cast<double>(t[6]), e.white_level_dn = nb::cast<double>(t[7]);
  e.linearity_fractions = nb::cast<Numbers>(t[8]), e.linearity_deviations = nb::cast<Numbers>(t[9]);
  const auto n = nb::cast<std::array<double, 12>>(t[10]);
  e.dark_current_e_per_s = n[0], e.dark_temperature_c = n[1], e.dark_doubling_c = n[2], e.dsnu_e = n[3],
  e.prnu = n[4];
  e.column_pattern_e = n[5], e.row_noise_e = n[6], e.hot_pixels_per_million = n[7],
  e.hot_current_e_per_s = n[8];
  e.dead_pixels_per_million = n[9], e.blooming_onset = n[10], e.shutter.row_time_s = n[11];
  e.serial = nb::cast<std::uint64_t>(t[11]);
  e.shutter.kind = nb::cast<bool>(t[12]) ? Shutter::Kind::rolling : Shutter::Kind::global;
  return e;
}

nb::tuple state_of(const Sensor& s) {
  return nb::make_tuple(
      s.name, s.source, s.geometry.columns, s.geometry.rows, s.geometry.pitch_um, state_of(s.photosite),
      s.electronics ? nb::object(state_of(*s.electronics)) : nb::none(), s.reflectance, s.microlens_sag_um);
}

Sensor sensor_of(const nb::tuple& t) {
  Sensor s{nb::cast<std::string>(t[0]),
           nb::cast<std::string>(t[1]),
           {nb::cast<int>(t[2]), nb::cast<int>(t[3]), nb::cast<double>(t[4])},
           photosite_of(nb::cast<nb::tuple>(t[5])),
           {}};
  s.reflectance = nb::cast<std::optional<double>>(t[7]), s.microlens_sag_um = nb::cast<double>(t[8]);
  if (!t[6].is_none()) s.electronics = electronics_of(nb::cast<nb::tuple>(t[6]));
  return s;
}

nb::dict quantum_efficiency(const Sensor& sensor) {
  nb::dict curves;
  for (const SensorChannel& c : sensor.require_electronics().channels)
    curves[c.name.c_str()] = nb::make_tuple(array_of(c.quantum_efficiency.wavelengths_nm()),
                                            array_of(c.quantum_efficiency.values()));
  return curves;
}

std::string repr(const Sensor& s) {
  return fmt::format(
      "<Sensor '{}': {} x {} pixels of {:g} um{}>", s.name, s.geometry.columns, s.geometry.rows,
      s.geometry.pitch_um,
      s.electronics ? ", " + mosaic_text(s.electronics->mosaic, s.electronics->channel_names()) : "");
}

}  // namespace

void bind_sensor(nb::module_& module) {
  nb::class_<GainMode>(module, "GainMode", "One conversion gain of the pixel.")
      .def_ro("name", &GainMode::name)
      .def_ro("full_well_e", &GainMode::full_well_e)
      .def_ro("dn_per_e", &GainMode::dn_per_e)
      .def_ro("read_noise_e", &GainMode::read_noise_e, "RMS, before the analog gain [electrons].")
      .def_ro("max_analog_gain", &GainMode::max_analog_gain)
      .def("__repr__", [](const GainMode& m) {
        return fmt::format("<GainMode '{}': full_well_e={:g}, read_noise_e={:g}>", m.name, m.full_well_e,
                           m.read_noise_e);
      });
  nb::class_<Sensor>(module, "Sensor", nb::type_slots(explained_constructor),
                     "Description of a sensor. It does not change; alter a copy with `settings`.")
      .def(nb::new_([](const std::string& name, const std::map<std::string, nb::object>& settings) {
             return read(name, settings);
           }),
           nb::arg("name"), nb::arg("settings") = std::map<std::string, nb::object>(),
           "A bundled sensor by name, a file, or \"768x576@6.25\" (pixels @ pitch in um). `settings` alter "
           "entries of "
           "its file: {\"gain_modes[0].read_noise_e\": 1.5}. Raises InputError with file and line.")
      .def_ro("name", &Sensor::name)
      .def_ro("source", &Sensor::source)
      .def_prop_ro("columns", [](const Sensor& s) { return s.geometry.columns; })
      .def_prop_ro("rows", [](const Sensor& s) { return s.geometry.rows; })
      .def_prop_ro(
          "pitch_um", [](const Sensor& s) { return s.geometry.pitch_um; }, "Pixel pitch [um].")
      .def_prop_ro("width_mm", [](const Sensor& s) { return s.geometry.width_mm(); })
      .def_prop_ro("height_mm", [](const Sensor& s) { return s.geometry.height_mm(); })
      .def_prop_ro(
          "photosite", [](const Sensor& s) { return s.photosite.text(); },
          "Where in a pixel light is gathered, in words.")
      .def_prop_ro(
          "has_electronics", [](const Sensor& s) { return s.electronics.has_value(); },
          "Whether it turns light into numbers.")
      .def_prop_ro(
          "channels", [](const Sensor& s) { return s.require_electronics().channel_names(); },
          "Names of its colours.")
      .def_prop_ro("bits", [](const Sensor& s) { return s.require_electronics().bits; })
      .def_prop_ro("black_level_dn", [](const Sensor& s) { return s.require_electronics().black_level_dn; })
      .def_prop_ro("white_level_dn", [](const Sensor& s) { return s.require_electronics().white_level_dn; })
      .def_prop_ro("gain_modes", [](const Sensor& s) { return s.require_electronics().gain_modes; })
      .def_prop_ro("quantum_efficiency", quantum_efficiency,
                   "{channel: (wavelengths [nm], electrons per photon)}.")
      .def("__repr__", repr)
      .def("__getstate__", [](const Sensor& s) { return state_of(s); })
      .def("__setstate__", [](Sensor& self, const nb::tuple& state) { new (&self) Sensor(sensor_of(state)); })
      .def("__eq__", [](const Sensor& a, const nb::object& b) {
        return nb::isinstance<Sensor>(b) && state_of(a).equal(state_of(nb::cast<const Sensor&>(b)));
      });
}

}  // namespace petzval::python
