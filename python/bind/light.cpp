// SPDX-License-Identifier: BSD-3-Clause
// Light on the sensor: SpectralImage.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/image/formats/irradiance.h>

#include "bind.h"
#include "call.h"
#include "constructor.h"

namespace petzval::python {

namespace {

/// Of "box", "point", or the text of a photosite (Sensor.photosite).
PixelAperture aperture_of(const std::string& text) {
  return text == "box"     ? PixelAperture::box
         : text == "point" ? PixelAperture::point
                           : PixelAperture::photosite;
}

std::string aperture_text(const SpectralImage& image) {
  if (image.pixel_aperture() == PixelAperture::photosite) return image.photosite;
  return image.pixel_aperture() == PixelAperture::box ? "box" : "point";
}

Array<float> values_view(nb::handle self) {
  auto& image = nb::cast<SpectralImage&>(self);
  return bands_view(image.bands() > 0 ? image.band(0).data() : nullptr, image.rows(), image.columns(),
                    image.bands(), self);
}

SpectralImage of_array(const FloatsIn& values, const Numbers& wavelengths_nm, double pitch_um,
                       const std::string& aperture) {
  const std::vector<float> bands = bands_of("values", values, wavelengths_nm);
  SpectralImage image(static_cast<int>(values.shape(1)), static_cast<int>(values.shape(0)), wavelengths_nm,
                      pitch_um, aperture_of(aperture));
  if (image.pixel_aperture() == PixelAperture::photosite) image.photosite = aperture;
  for (int band = 0; band < image.bands(); ++band)
    image.store_band(band,
                     {bands.data() + static_cast<std::size_t>(band) * image.band_size(), image.band_size()});
  return image;
}

using Curve = std::pair<Numbers, Numbers>;
/// Everything but the values, for pickle.
using State = std::tuple<Numbers, double, std::string, std::string,
                         std::optional<std::tuple<std::string, double, double, double, Numbers, Numbers>>,
                         std::optional<Curve>>;

State state_of(const SpectralImage& image) {
  State state{image.wavelengths_nm(), image.pitch_um(), aperture_text(image), image.provenance, {}, {}};
  if (const auto& lens = image.lens)
    std::get<4>(state) = {lens->name, lens->focal_length_mm, lens->f_number, lens->exit_pupil_mm,
                          lens->warp, lens->vignetting};
  if (const auto& light = image.illuminant) std::get<5>(state) = {light->wavelengths_nm(), light->values()};
  return state;
}

SpectralImage of_state(const FloatsIn& values, const State& state) {
  const auto& [wavelengths_nm, pitch_um, aperture, provenance, lens, light] = state;
  SpectralImage image = of_array(values, wavelengths_nm, pitch_um, aperture);
  image.provenance = provenance;
  if (lens) {
    const auto& [name, focal_length_mm, f_number, exit_pupil_mm, warp, vignetting] = *lens;
    image.lens = LensFacts{name, focal_length_mm, f_number, exit_pupil_mm, warp, vignetting};
  }
  if (light) image.illuminant = Spectrum(light->first, light->second);
  return image;
}

/// In a whole file's bytes: what a notebook shows.
nb::bytes png_of(const SpectralImage& image) {
  PictureOptions options;
  options.scene_white = image.illuminant;
  return nb::cast<nb::bytes>(
      call_python("petzval._display", "png_bytes",
                  nb::cpp_function([&](const std::string& path) { write_picture(path, image, options); })));
}

}  // namespace

std::vector<float> bands_of(const char* parameter, const FloatsIn& values, const Numbers& wavelengths_nm) {
  if (values.ndim() != 3 || values.shape(2) != wavelengths_nm.size())
    throw InputError(fmt::format(
        "`{}` of shape ({}) and {} `wavelengths_nm`; an array (row, column, wavelength) would be right",
        parameter, fmt::join(values.shape_ptr(), values.shape_ptr() + values.ndim(), ", "),
        wavelengths_nm.size()));
  const std::size_t rows = values.shape(0), columns = values.shape(1), count = values.shape(2);
  std::vector<float> bands;
  bands.reserve(values.size());
  for (std::size_t band = 0; band < count; ++band)
    for (std::size_t row = 0; row < rows; ++row) {
      const float* value = values.data() + static_cast<std::int64_t>(row) * values.stride(0) +
                           static_cast<std::int64_t>(band) * values.stride(2);
      for (std::size_t column = 0; column < columns; ++column, value += values.stride(1))
        bands.push_back(*value);
    }
  return bands;
}

void bind_light(nb::module_& module) {
  module.def("_light_from_state", of_state);
  nb::class_<LensFacts>(module, "LensFacts", "The lens that light came through, as far as a camera notes it.")
      .def_ro("name", &LensFacts::name)
      .def_ro("focal_length_mm", &LensFacts::focal_length_mm)
      .def_ro("f_number", &LensFacts::f_number, "The working f-number.")
      .def_ro("exit_pupil_mm", &LensFacts::exit_pupil_mm,
              "From the sensor, negative in front of it; 0: unknown or infinite.")
      .def_prop_ro(
          "warp", [](const LensFacts& f) { return tuple_of(f.warp); },
          "What undoes distortion, as in DNG's WarpRectilinear: w0 to w3 of r (w0 + w1 r^2 + ...), r = 1 in "
          "the corners; empty: unknown.")
      .def_prop_ro(
          "vignetting", [](const LensFacts& f) { return tuple_of(f.vignetting); },
          "What undoes fall-off, as in DNG's FixVignetteRadial: v0 to v4 of 1 + v0 r^2 + ...; empty: "
          "unknown.")
      .def("__repr__", [](const LensFacts& f) {
        return fmt::format("<LensFacts '{}': {:.4g} mm f/{:.3g}>", f.name, f.focal_length_mm, f.f_number);
      });
  nb::class_<SpectralImage>(
      module, "SpectralImage", nb::type_slots(explained_constructor),
      "Spectral irradiance on the sensor [W/(m2 nm)], (row, column, wavelength), upright, row 0 on top.")
      .def(nb::new_(&of_array), nb::arg("values"), nb::arg("wavelengths_nm"), nb::arg("pitch_um"),
           nb::arg("pixel_aperture") = "box",
           "Of an array (row, column, wavelength) of float32, which is copied.")
      .def_static(
          "load",
          [](const std::string& path, const Numbers& wavelengths_nm, double pitch_um) {
            return read_irradiance(path, {.wavelengths_nm = wavelengths_nm, .pitch_um = pitch_um});
          },
          nb::arg("path"), nb::arg("wavelengths_nm") = Numbers(), nb::arg("pitch_um") = 0.0,
          "Reads what `save` wrote as .exr or .npz; .npy with its wavelengths and its pixel pitch.")
      .def_prop_ro("values", values_view,
                   "A view (row, column, wavelength) of float32, without a copy; it may be written to.")
      .def_prop_ro("wavelengths_nm", [](const SpectralImage& i) { return tuple_of(i.wavelengths_nm()); })
      .def_prop_ro("columns", &SpectralImage::columns)
      .def_prop_ro("rows", &SpectralImage::rows)
      .def_prop_ro("shape",
                   [](const SpectralImage& i) { return nb::make_tuple(i.rows(), i.columns(), i.bands()); })
      .def_prop_ro("pitch_um", &SpectralImage::pitch_um)
      .def_prop_ro("pixel_aperture", aperture_text,
                   "box, point, or what the photosite is like (Sensor.photosite).")
      .def_ro("provenance", &SpectralImage::provenance, "How it came about, in one line.")
      .def_ro("lens", &SpectralImage::lens, nb::rv_policy::copy, "LensFacts, or None.")
      .def(
          "save",
          [](const SpectralImage& self, const std::vector<std::string>& paths) {
            OutputOptions options;
            options.picture = OutputOptions::Shows::irradiance;
            options.shown.scene_white = self.illuminant;
            SpectralImage copy = self;
            Call call;
            call([&](const Context& context) {
              return write_outputs(std::move(copy), paths, {}, options, context).raw.has_value();
            });
          },
          nb::arg("paths"))
      .def(
          "save",
          [](nb::handle self, const std::string& path) { self.attr("save")(nb::cast(std::vector{path})); },
          nb::arg("path"),
          "Irradiance as .exr or .npy, a picture of it as .png or .tif; all of several files, or none.")
      .def(
          "to_xarray", [](nb::handle self) { return call_python("petzval._xarray", "light", self); },
          "As xarray.DataArray (y, x, wavelength) in mm of the upright picture, sharing the memory.")
      .def(
          "__array__",
          [](nb::handle self, const nb::object& dtype, const nb::object& copy) {
            return call_python("petzval._arrays", "array", values_view(self), dtype, copy);
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none())
      .def("__dlpack__",
           [](nb::handle self, const nb::kwargs& k) {
             return nb::cast(values_view(self)).attr("__dlpack__")(**k);
           })
      .def("__dlpack_device__",
           [](nb::handle self) { return nb::cast(values_view(self)).attr("__dlpack_device__")(); })
      .def("__reduce__",
           [](nb::handle self) {
             return nb::make_tuple(
                 nb::module_::import_("petzval._states").attr("light"),
                 nb::make_tuple(values_view(self), state_of(nb::cast<const SpectralImage&>(self))));
           })
      .def("_repr_png_", png_of)
      .def("__repr__", [](const SpectralImage& i) {
        const std::string bands =
            i.bands() == 0
                ? "no bands"
                : fmt::format("{} band{} from {:g} to {:g} nm", i.bands(), i.bands() == 1 ? "" : "s",
                              i.wavelengths_nm().front(), i.wavelengths_nm().back());
        return fmt::format("<SpectralImage {} x {} pixels of {:g} um, {}>", i.columns(), i.rows(),
                           i.pitch_um(), bands);
      });
}

}  // namespace petzval::python
