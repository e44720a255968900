// SPDX-License-Identifier: BSD-3-Clause
// Raw images and developed pictures.
#include <fmt/format.h>
#include <petzval/colour/illuminants.h>
#include <petzval/isp/raw_output.h>
#include <petzval/sensor/formats/dng.h>

#include "call.h"
#include "camera.h"
#include "constructor.h"
#include "keywords.h"
#include "picture.h"

namespace petzval::python {

namespace {

/// Seconds, or what Exposure::parse takes.
Exposure exposure_from(const nb::object& exposure) {
  if (nb::isinstance<nb::str>(exposure)) return Exposure::parse(nb::cast<std::string>(exposure));
  return Exposure::seconds(nb::cast<double>(exposure));
}

}  // namespace

ExposeOptions expose_options(const nb::object& exposure, const std::string& metering, double compensation_ev,
                             const std::string& gain_mode, double analog_gain, Maybe<double> temperature_c,
                             Maybe<std::uint64_t> serial, const std::vector<std::string>& without,
                             const Numbers& bracket_ev, const std::string& illuminant_name,
                             Maybe<double> f_number, Maybe<double> exit_pupil_mm,
                             const std::string& date_time) {
  ExposeOptions options;
  options.exposure = exposure_from(exposure);
  options.metering = choice<Metering::Rule>(
      "metering", metering,
      {{"highlights", Metering::Rule::highlights}, {"average", Metering::Rule::average}});
  options.compensation_ev = compensation_ev, options.gain_mode = gain_mode, options.analog_gain = analog_gain;
  options.temperature_c = temperature_c, options.serial = serial;
  for (const std::string& name : without) options.without.insert(noise_source(name));
  options.bracket_ev = bracket_ev;
  options.f_number = f_number, options.exit_pupil_mm = exit_pupil_mm;
  if (!date_time.empty()) options.date_time = parse_date_time(date_time);
  if (!illuminant_name.empty()) options.illuminant = illuminant(illuminant_name);
  return options;
}

namespace {

using SpaceWords = std::initializer_list<std::pair<std::string_view, DisplaySpace>>;
const SpaceWords space_words{{"srgb", DisplaySpace::srgb},
                             {"display-p3", DisplaySpace::display_p3},
                             {"rec2100-pq", DisplaySpace::rec2100_pq}};

RawImage expose_to(const SpectralImage& light, const Sensor& sensor, const ExposeOptions& options,
                   const CallOptions& how) {
  Call call(how);
  return call([&](const Context& context) { return expose(light, sensor, options, context); });
}

const Sensor& sensor_of(const Sensor& sensor) {
  return sensor;
}

const Sensor& sensor_of(const CameraInPython& camera) {
  if (!camera.sensor)
    throw InputError(
        "`sensor`: a camera without one exposes nothing; Camera(lens, sensor=\"imx363\") would be right");
  return *camera.sensor;
}

/// Exposing as a function with the keywords of exposures.
template <typename Self, typename... OfExposure>
auto expose_function(ExposeOptions (*)(OfExposure...)) {
  return [](const Self& self, const SpectralImage& light, OfExposure... of_exposure, int frames, int threads,
            std::uint64_t seed, const nb::object& progress) {
    ExposeOptions options = expose_options(of_exposure...);
    options.frames = frames;
    return expose_to(light, sensor_of(self), options, {threads, seed, progress});
  };
}

constexpr const char* expose_text =
    "Exposes the sensor to light, as a Raw. `exposure`: auto, seconds, or an exposure value (\"ev:12\"). "
    "`without`: noise sources "
    "to switch off (shot, dark, read, dsnu, prnu, column, row, defects, crosstalk, microlens, linearity, "
    "blooming). "
    "`frames` are averaged, exposures of "
    "`bracket_ev` merged. `illuminant`: for white balance; empty: as the light says. `f_number` (for "
    "exposure values) and `exit_pupil_mm` (from the sensor, negative in front of it; for microlenses): the "
    "lens's, where they are known. `date_time`: when it began, for files (\"2026-11-26 10:00:00\"); empty: "
    "they "
    "state none. Raises InputError; "
    "Cancelled.";

WhiteBalance white_balance_from(const nb::object& white_balance, const nb::object& sensor) {
  WhiteBalance result;
  if (nb::isinstance<nb::str>(white_balance)) {
    result = WhiteBalance::parse(nb::cast<std::string>(white_balance));
  } else {
    result.kind = WhiteBalance::Kind::neutral;
    result.neutral = nb::cast<Numbers>(white_balance);
  }
  if (const auto chosen = sensor_from(sensor)) result.sensor = *chosen;
  return result;
}

PictureInPython develop_raw(const RawImage& raw, const nb::object& white_balance, const nb::object& sensor,
                            const Maybe<std::string>& demosaic, bool colours, const RawImage* flat,
                            bool defects, double denoise, double sharpen, double sharpen_sigma_px,
                            double exposure_ev, const std::string& tone, const std::string& space,
                            int threads, const nb::object& progress) {
  Development development;
  development.white_balance = white_balance_from(white_balance, sensor);
  if (flat != nullptr) development.flat = *flat;
  DevelopOptions& options = development.options;
  options.demosaic = demosaic, options.colours = colours, options.defects = defects;
  options.denoise_strength = denoise, options.sharpen_amount = sharpen,
  options.sharpen_sigma_px = sharpen_sigma_px;
  options.exposure_ev = exposure_ev;
  options.tone = choice<ToneCurve>("tone", tone, {{"none", ToneCurve::none}, {"soft", ToneCurve::soft}});
  options.space = display_space(space);
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return PictureInPython(develop(raw, development, context)); });
}

template <typename Save>
nb::object png_of(const Save& save) {
  return call_python("petzval._display", "png_bytes", nb::cpp_function(save));
}

void bind_raw_image(nb::module_& module) {
  nb::class_<RawImage>(
      module, "Raw",
      "What a sensor records: a mosaic of numbers with all that is needed to make a picture of it.")
      .def_static("load", &read_dng, nb::arg("path"), "Reads a .dng, of `save` or of many a camera.")
      .def(
          "save", [](const RawImage& raw, const std::string& path) { write_raw_output(path, raw); },
          nb::arg("path"), "Writes .dng with everything, .tif or .npy with the numbers, .exr.")
      .def_prop_ro(
          "values",
          [](nb::handle self) {
            auto& raw = nb::cast<RawImage&>(self);
            const std::size_t shape[] = {static_cast<std::size_t>(raw.rows),
                                         static_cast<std::size_t>(raw.columns)};
            return Array<std::uint16_t>(raw.samples.data(), 2, shape, self);
          },
          "A view (row, column) of uint16, as stored.")
      .def_prop_ro(
          "linear_values",
          [](const RawImage& raw) {
            std::vector<double> linear;
            for (int row = 0; row < raw.rows; ++row)
              for (int column = 0; column < raw.columns; ++column) linear.push_back(raw.pixel(row, column));
            return array_of(std::move(linear),
                            {static_cast<std::size_t>(raw.rows), static_cast<std::size_t>(raw.columns)});
          },
          "A copy (row, column) of float64, proportional to light: (value - black level) / dn_per_e "
          "electrons.")
      .def_prop_ro(
          "electrons",
          [](const RawImage& raw) {
            if (!(raw.dn_per_e > 0))
              throw InputError(
                  "the raw image does not say how many steps an electron is; one of `expose` would be right");
            std::vector<double> electrons;
            for (int row = 0; row < raw.rows; ++row)
              for (int column = 0; column < raw.columns; ++column)
                electrons.push_back((raw.pixel(row, column) - raw.black_level) / raw.dn_per_e);
            return array_of(std::move(electrons),
                            {static_cast<std::size_t>(raw.rows), static_cast<std::size_t>(raw.columns)});
          },
          "A copy (row, column) of float64: what each pixel recorded, noise included.")
      .def_ro("columns", &RawImage::columns)
      .def_ro("rows", &RawImage::rows)
      .def_ro("channels", &RawImage::channels, "Names of the colours.")
      .def_prop_ro(
          "mosaic",
          [](const RawImage& raw) {
            return array_of(raw.mosaic.cells, {static_cast<std::size_t>(raw.mosaic.rows),
                                               static_cast<std::size_t>(raw.mosaic.columns)});
          },
          "Numbers of channels in the block that repeats over the sensor.")
      .def_ro("black_level", &RawImage::black_level)
      .def_ro("white_level", &RawImage::white_level)
      .def_ro("dn_per_e", &RawImage::dn_per_e)
      .def_ro("exposure_s", &RawImage::exposure_s)
      .def_ro("iso", &RawImage::iso)
      .def_prop_ro(
          "date_time",
          [](const RawImage& raw) { return raw.date_time ? iso_date_time(*raw.date_time) : std::string(); },
          "When the exposure began, as ISO 8601 writes it; empty: not known.")
      .def_ro("as_shot_neutral", &RawImage::as_shot_neutral)
      .def_prop_ro("lens", [](const RawImage& raw) { return raw.lens; })
      .def_ro("sensor_name", &RawImage::sensor_name)
      .def_ro("provenance", &RawImage::provenance)
      .def(
          "__array__",
          [](nb::handle self, const nb::object& dtype, const nb::object& copy) {
            return call_python("petzval._arrays", "array", self.attr("values"), dtype, copy);
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none())
      .def("__reduce__",
           [](const RawImage& raw) {
             const std::string bytes = dng_bytes(raw, "pickle");
             return nb::make_tuple(nb::module_::import_("petzval._states").attr("raw"),
                                   nb::make_tuple(nb::bytes(bytes.data(), bytes.size())));
           })
      .def("_repr_png_",
           [](const RawImage& raw) {
             return png_of([&](const std::string& path) { write_picture(path, develop(raw)); });
           })
      .def("__repr__", [](const RawImage& raw) {
        return fmt::format("<Raw {} x {}, {}, {:.3g} s, ISO {:.0f}>", raw.columns, raw.rows,
                           mosaic_text(raw.mosaic, raw.channels), raw.exposure_s, raw.iso);
      });
  module.def("_raw_from_bytes", [](const nb::bytes& bytes) {
    return parse_dng(std::string(bytes.c_str(), bytes.size()), "pickle");
  });
}

}  // namespace

PictureInPython::PictureInPython(Picture picture)
    : space(picture.space), report(picture.report), provenance(picture.provenance), facts(picture.facts) {
  columns = picture.planes.columns, rows = picture.planes.rows, channels = picture.planes.values.size();
  values.resize(columns * static_cast<std::size_t>(rows) * channels);
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t i = 0; i < picture.planes.values[c].size(); ++i)
      values[i * channels + c] = picture.planes.values[c][i];
}

Picture PictureInPython::picture() const {
  Picture result{
      {columns, rows,
       std::vector(channels, std::vector<float>(values.size() / std::max<std::size_t>(1, channels)))},
      space,
      report,
      provenance,
      facts};
  for (std::size_t i = 0; i < values.size(); ++i)
    result.planes.values[i % channels][i / channels] = values[i];
  return result;
}

namespace {

Array<float> picture_view(nb::handle self) {
  auto& p = nb::cast<PictureInPython&>(self);
  const std::size_t shape[] = {static_cast<std::size_t>(p.rows), static_cast<std::size_t>(p.columns),
                               p.channels};
  return Array<float>(p.values.data(), 3, shape, self);
}

PictureInPython picture_of_array(
    const nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>& values,
    const std::string& space) {
  PictureInPython p;
  p.rows = static_cast<int>(values.shape(0)), p.columns = static_cast<int>(values.shape(1)),
  p.channels = values.shape(2);
  p.values.assign(values.data(), values.data() + values.size());
  p.space = display_space(space);
  return p;
}

void bind_picture(nb::module_& module) {
  nb::class_<PictureInPython>(
      module, "Picture", nb::type_slots(explained_constructor),
      "A developed picture: linear light of a display, (row, column, channel), 1 is white.")
      .def(nb::new_(&picture_of_array), nb::arg("values"), nb::arg("space") = "srgb",
           "Of an array (row, column, channel) of linear float32, which is copied.")
      .def_prop_ro("values", picture_view,
                   "A view (row, column, channel) of float32, linear, without a copy.")
      .def_prop_ro(
          "space", [](const PictureInPython& p) { return std::string(word_of(p.space, space_words)); },
          "srgb or display-p3: the primaries.")
      .def_ro("columns", &PictureInPython::columns)
      .def_ro("rows", &PictureInPython::rows)
      .def_prop_ro("shape",
                   [](const PictureInPython& p) { return nb::make_tuple(p.rows, p.columns, p.channels); })
      .def_prop_ro(
          "neutral", [](const PictureInPython& p) { return tuple_of(p.report.neutral); },
          "Response of the channels to what was taken for white.")
      .def_prop_ro("demosaic", [](const PictureInPython& p) { return p.report.demosaic; })
      .def_ro("provenance", &PictureInPython::provenance)
      .def(
          "encoded",
          [](const PictureInPython& p) {
            std::vector<std::uint8_t> codes(p.values.size());
            for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = quantised_8(srgb_encoded(p.values[i]));
            return array_of(std::move(codes), {static_cast<std::size_t>(p.rows),
                                               static_cast<std::size_t>(p.columns), p.channels});
          },
          "Code values (row, column, channel) of uint8 with the display's transfer curve, as a .png has "
          "them: for imshow.")
      .def(
          "save",
          [](const PictureInPython& p, const std::string& path, int bits,
             const std::vector<std::string>& insets) {
            std::vector<PictureInset> places;
            for (const std::string& text : insets) places.push_back(PictureInset::parse(text));
            write_picture(path, places.empty() ? p.picture() : with_insets(p.picture(), places), bits);
          },
          nb::arg("path"), nb::arg("bits") = 8, nb::arg("insets") = std::vector<std::string>(),
          "Writes .png or .tif (8 or 16 bits, with the display's profile), or linear as .exr or .npy. "
          "`insets` are "
          "parts enlarged beside it: \"310,20,8\" (about a pixel, eight times), \"top-right\", \"centre,6\".")
      .def(
          "to_xarray", [](nb::handle self) { return call_python("petzval._xarray", "picture", self); },
          "As xarray.DataArray (y, x, channel), sharing the memory.")
      .def(
          "__array__",
          [](nb::handle self, const nb::object& dtype, const nb::object& copy) {
            return call_python("petzval._arrays", "array", picture_view(self), dtype, copy);
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none())
      .def("__dlpack__",
           [](nb::handle self, const nb::kwargs& k) {
             return nb::cast(picture_view(self)).attr("__dlpack__")(**k);
           })
      .def("__dlpack_device__",
           [](nb::handle self) { return nb::cast(picture_view(self)).attr("__dlpack_device__")(); })
      .def("__reduce__",
           [](nb::handle self) {
             return nb::make_tuple(nb::module_::import_("petzval._states").attr("picture"),
                                   nb::make_tuple(picture_view(self), self.attr("space")));
           })
      .def("_repr_png_",
           [](const PictureInPython& p) {
             return png_of([&](const std::string& path) { write_picture(path, p.picture()); });
           })
      .def("__repr__", [](const PictureInPython& p) {
        return fmt::format("<Picture {} x {}, {} channels of linear {}>", p.columns, p.rows, p.channels,
                           word_of(p.space, space_words));
      });
}

}  // namespace

void bind_raw(nb::module_& module) {
  bind_raw_image(module);
  bind_picture(module);
  const auto add = [&](nb::handle type, const char* name, auto function, auto... extra) {
    nb::cpp_function_def(function, nb::scope(type), nb::name(name), nb::is_method(), extra...);
  };
  add(nb::type<Sensor>(), "expose", expose_function<Sensor>(expose_options), nb::arg("light"), nb::kw_only(),
      PETZVAL_EXPOSE_KEYWORDS, nb::arg("frames") = 1, PETZVAL_SEEDED_CALL_KEYWORDS, expose_text);
  add(nb::type<CameraInPython>(), "expose", expose_function<CameraInPython>(expose_options), nb::arg("light"),
      nb::kw_only(), PETZVAL_EXPOSE_KEYWORDS, nb::arg("frames") = 1, PETZVAL_SEEDED_CALL_KEYWORDS,
      expose_text);
  module.def("develop", develop_raw, nb::arg("raw"), nb::kw_only(), nb::arg("white_balance") = "as-shot",
             nb::arg("sensor").none() = nb::none(), nb::arg("demosaic").none() = nb::none(),
             nb::arg("colours") = true, nb::arg("flat").none() = nb::none(), nb::arg("defects") = true,
             nb::arg("denoise") = 0.0, nb::arg("sharpen") = 0.0, nb::arg("sharpen_sigma_px") = 1.0,
             nb::arg("exposure_ev") = 0.0, nb::arg("tone") = "none", nb::arg("space") = "srgb",
             nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(),
             "Develops a Raw to a Picture. `white_balance`: as-shot, grey-world, a light (D65, A, 3200K, a "
             "file) or responses of the channels. "
             "`sensor`: with a light, whose colours the matrix is fitted to. `demosaic`: None (the usual one "
             "of the mosaic), bilinear, malvar, "
             "hamilton-adams, gradient or general. `flat`: a Raw of a uniform surface. `tone`: none or soft. "
             "`space`: srgb, display-p3 or rec2100-pq (high dynamic range, as .png).");
}

}  // namespace petzval::python
