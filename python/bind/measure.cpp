// SPDX-License-Identifier: BSD-3-Clause
// Measurement: differences of pictures, colours of a chart, noise of a sensor.
#include <fmt/format.h>
#include <petzval/colour/illuminants.h>
#include <petzval/measure/colour_chart.h>
#include <petzval/measure/oecf.h>
#include <petzval/measure/photon_transfer.h>
#include <petzval/measure/picture_comparison.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/simulate/outputs.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "call.h"
#include "picture.h"

namespace petzval::python {

namespace {

using DoublesIn = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

// ---- pictures

/// Its values as `compare` has those of files.
ComparablePicture comparable_from(const nb::object& picture, const char* name) {
  if (nb::isinstance<nb::str>(picture)) return read_comparable_picture(nb::cast<std::string>(picture));
  ComparablePicture result;
  result.name = name;
  if (nb::isinstance<SpectralImage>(picture)) {
    const auto& image = nb::cast<const SpectralImage&>(picture);
    result.columns = image.columns(), result.rows = image.rows(),
    result.bands = static_cast<std::size_t>(image.bands());
    result.wavelengths_nm = image.wavelengths_nm(), result.pitch_um = image.pitch_um(),
    result.units = "W.m^-2.nm^-1";
    result.values = LargeFloats(std::vector<float>(image.values().begin(), image.values().end()));
    return result;
  }
  if (nb::isinstance<PictureInPython>(picture)) {
    const auto& developed = nb::cast<const PictureInPython&>(picture);
    result.rows = developed.rows, result.columns = developed.columns;
    result.bands = developed.channels;
    result.interleaved = true;
    result.values = std::vector<double>(developed.values.begin(), developed.values.end());
    return result;
  }
  DoublesIn values;
  if (!nb::try_cast(picture, values))
    throw InputError(fmt::format(
        "`{}` is no picture; a SpectralImage, a Picture, an array or a file would be right", name));
  if (values.ndim() != 2 && values.ndim() != 3)
    throw InputError(
        fmt::format("`{}` of {} dimensions; (row, column) or (row, column, channel) would be right", name,
                    values.ndim()));
  result.rows = static_cast<int>(values.shape(0)), result.columns = static_cast<int>(values.shape(1));
  result.bands = values.ndim() == 3 ? values.shape(2) : 1;
  result.interleaved = true;
  result.values = std::vector<double>(values.data(), values.data() + values.size());
  return result;
}

void bind_comparison(nb::module_& module) {
  nb::class_<PictureDifference>(module, "PictureDifference", "How far one picture is from a reference.")
      .def_ro("relative_l2", &PictureDifference::relative_l2)
      .def_ro("max_error_over_peak", &PictureDifference::max_error_over_peak)
      .def_ro("psnr_db", &PictureDifference::psnr_db)
      .def_ro("peak", &PictureDifference::peak)
      .def("__repr__", [](const PictureDifference& d) {
        return fmt::format(
            "<PictureDifference: relative_l2={:.4g}, max_error_over_peak={:.4g}, psnr_db={:.2f}>",
            d.relative_l2, d.max_error_over_peak, d.psnr_db);
      });
  module.def(
      "compare",
      [](const nb::object& picture, const nb::object& reference) {
        ComparablePicture a = comparable_from(picture, "picture"),
                          b = comparable_from(reference, "reference");
        if (a.bands == b.bands + 1) drop_full_opacity(a);
        if (b.bands == a.bands + 1) drop_full_opacity(b);
        return compare_pictures(a, b).all;
      },
      nb::arg("picture"), nb::arg("reference"),
      "How far a picture is from a reference, both a SpectralImage, a Picture (by its linear values), an "
      "array "
      "or a file. Raises InputError saying what differs in kind.");
}

// ---- sensors

void bind_sensor_test(nb::module_& module) {
  nb::class_<SensorTest>(module, "SensorTest", "What noise tells of a sensor (EMVA 1288).")
      .def_prop_ro("dn_per_e", [](const SensorTest& t) { return t.transfer.dn_per_e; })
      .def_prop_ro("dark_noise_e", [](const SensorTest& t) { return t.transfer.dark_noise_e; })
      .def_prop_ro("saturation_e", [](const SensorTest& t) { return t.transfer.saturation_e; })
      .def_prop_ro(
          "full_signal_e", [](const SensorTest& t) { return t.transfer.full_signal_e; },
          "Where all pixels are full.")
      .def_prop_ro(
          "quantisation_limited", [](const SensorTest& t) { return t.transfer.quantisation_limited; },
          "The steps of the converter hide the dark noise, of which dark_noise_e is then an upper bound.")
      .def_prop_ro("dynamic_range_db", [](const SensorTest& t) { return t.transfer.dynamic_range_db; })
      .def_prop_ro("snr_max_db", [](const SensorTest& t) { return t.transfer.snr_max_db; })
      .def_prop_ro("dsnu_e", [](const SensorTest& t) { return t.uniformity.dsnu_e; })
      .def_prop_ro("prnu_percent", [](const SensorTest& t) { return t.uniformity.prnu_percent; })
      .def_prop_ro(
          "grey_total_snr", [](const SensorTest& t) { return t.grey.total_snr; },
          "ISO 15739: signal-to-noise ratio of a grey of 0.18/√2 of saturation.")
      .def_prop_ro("grey_temporal_snr", [](const SensorTest& t) { return t.grey.temporal_snr; })
      .def_prop_ro("grey_fixed_pattern_snr", [](const SensorTest& t) { return t.grey.fixed_pattern_snr; })
      .def_prop_ro(
          "iso_dynamic_range_db", [](const SensorTest& t) { return t.grey.dynamic_range_db; },
          "ISO 15739: saturation over the temporal noise in the dark.")
      .def_prop_ro(
          "mean_dn",
          [](const SensorTest& t) {
            Numbers values;
            for (const TransferPoint& p : t.transfer.points) values.push_back(p.mean_dn);
            return array_of(std::move(values));
          },
          "Of the photon-transfer curve.")
      .def_prop_ro("temporal_variance_dn2", [](const SensorTest& t) {
        Numbers values;
        for (const TransferPoint& p : t.transfer.points) values.push_back(p.temporal_variance_dn2);
        return array_of(std::move(values));
      });
  module.def(
      "test_sensor",
      [](const Sensor& sensor, const std::string& channel, int side, int levels, int stack,
         std::uint64_t seed, int threads, const nb::object& progress) {
        const std::vector<std::string> names = sensor.require_electronics().channel_names();
        std::size_t number = 0;
        while (number < names.size() && names[number] != channel) ++number;
        if (channel.empty()) number = 0;
        if (number == names.size())
          throw InputError(fmt::format("`channel` {}: {} would be right", channel, fmt::join(names, " or ")));
        CaptureOptions options;
        options.seed = seed;
        Call call({threads, seed, progress});
        return call([&](const Context& context) {
          return result_within(context, [&](const ProgressCallback&) {
            return test_sensor(sensor, options, static_cast<int>(number), side, levels, stack);
          });
        });
      },
      nb::arg("sensor"), nb::kw_only(), nb::arg("channel") = "", nb::arg("side") = 256,
      nb::arg("levels") = 24, nb::arg("stack") = 32, nb::arg("seed") = 1, nb::arg("threads") = 0,
      nb::arg("progress").none() = nb::none(),
      "Exposes a sensor as EMVA 1288 wants it and evaluates a channel.");
}

// ---- greys

Oecf oecf_of_files(const std::vector<std::string>& pictures, const std::optional<std::string>& patches,
                   const std::string& channel, const std::string& light) {
  if (pictures.empty()) throw InputError("`pictures`: exposures of a chart, two at least, would be right");
  const bool raw = is_raw_name(pictures.front());
  if (raw && !patches)
    throw InputError("a chart is found in developed pictures; `patches` says where it is in raw files");
  const std::vector<GreyPatch> greys =
      patches ? read_grey_patches(*patches) : colorchecker_greys(pictures.front(), illuminant(light));
  if (!raw) {
    std::vector<ComparablePicture> read;
    for (const std::string& path : pictures) read.push_back(read_comparable_picture(path));
    return measure_oecf(read, greys);
  }
  std::vector<RawImage> read;
  for (const std::string& path : pictures) read.push_back(read_dng(path));
  const std::vector<std::string>& names = read.front().channels;
  const auto found = std::ranges::find(names, channel.empty() ? std::string("green") : channel);
  if (found == names.end() && !channel.empty())
    throw InputError(fmt::format("`channel` {}: {} would be right", channel, fmt::join(names, " or ")));
  return measure_oecf(read, found == names.end() ? 0 : static_cast<int>(found - names.begin()), greys);
}

void bind_oecf(nb::module_& module) {
  module.def(
      "measure_oecf",
      [](const std::vector<std::string>& pictures, const std::optional<std::string>& patches,
         const std::string& channel, const std::string& light) {
        const Oecf oecf = oecf_of_files(pictures, patches, channel, light);
        nb::dict columns, units;
        const auto add = [&](const std::string& name, auto&& value_of) {
          Numbers values;
          for (const OecfPoint& point : oecf.points) values.push_back(value_of(point));
          columns[nb::str(name.c_str())] = array_of(std::move(values));
          units[nb::str(name.c_str())] = "";
        };
        add("exposure", [](const OecfPoint& p) { return p.patch.exposure; });
        for (std::size_t c = 0; c < oecf.channels.size(); ++c)
          add(oecf.channels[c] + "_level", [c](const OecfPoint& p) { return p.levels[c]; });
        add("incremental_gain", [](const OecfPoint& p) { return p.incremental_gain; });
        add("temporal_noise", [](const OecfPoint& p) { return p.noise.temporal; });
        add("fixed_pattern_noise", [](const OecfPoint& p) { return p.noise.fixed_pattern; });
        add("total_snr", [](const OecfPoint& p) { return p.total_snr(); });
        return call_python("petzval._tables", "Table", columns, units,
                           fmt::format("dynamic range {}{:.1f} dB", oecf.saturates ? "" : "above ",
                                       20 * std::log10(oecf.dynamic_range())),
                           "");
      },
      nb::arg("pictures"), nb::kw_only(), nb::arg("patches").none() = nb::none(), nb::arg("channel") = "",
      nb::arg("light") = "D65",
      "Levels (ISO 14524) and noise (ISO 15739) of a chart's greys in exposures of one kind, files .dng, "
      ".png "
      "or .tif, two at least, as a Table. `patches`: a .csv of x_px, y_px, width_px, height_px, exposure; "
      "None: the greys of a ColorChecker that is found. `channel` of raw files; empty: green, or "
      "the first.");
}

// ---- colour

void bind_chart(nb::module_& module) {
  module.def(
      "measure_colour",
      [](const std::string& picture, const std::string& light, bool match_exposure,
         const std::optional<std::array<std::array<double, 2>, 4>>& corners) {
        const ViewedPicture viewed = read_viewed_picture(picture);
        const Spectrum spectrum = illuminant(light);
        const ChartCorners at = corners ? ChartCorners{*corners} : find_chart(viewed, spectrum);
        const ChartDifference d = compare_chart(viewed, at, spectrum, match_exposure);
        nb::dict columns, units;
        nb::list names;
        Numbers x, y, ab, d2000;
        for (const PatchDifference& p : d.patches)
          names.append(p.name), x.push_back(p.x), y.push_back(p.y), ab.push_back(p.delta_e_ab),
              d2000.push_back(p.delta_e_2000);
        columns["patch"] = names, columns["x_px"] = array_of(std::move(x)),
        columns["y_px"] = array_of(std::move(y));
        columns["delta_e_ab"] = array_of(std::move(ab)), columns["delta_e_2000"] = array_of(std::move(d2000));
        for (const char* each : {"patch", "delta_e_ab", "delta_e_2000"}) units[each] = "";
        units["x_px"] = "px", units["y_px"] = "px";
        return call_python(
            "petzval._tables", "Table", columns, units,
            fmt::format("mean DE2000 {:.2f}, max {:.2f}", d.mean_delta_e_2000, d.max_delta_e_2000), "");
      },
      nb::arg("picture"), nb::kw_only(), nb::arg("light") = "D65", nb::arg("match_exposure") = true,
      nb::arg("corners").none() = nb::none(),
      "Colour differences of a ColorChecker that is found in a picture file (.png, .tif), as a Table of its "
      "24 patches.");
}

}  // namespace

void bind_measure(nb::module_& module) {
  bind_comparison(module);
  bind_sensor_test(module);
  bind_oecf(module);
  bind_chart(module);
}

}  // namespace petzval::python
