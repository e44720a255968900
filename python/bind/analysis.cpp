// SPDX-License-Identifier: BSD-3-Clause
// A lens by itself: its analyses, PSFs, rays, drawing.
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/report/colours.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/trace/tracer.h>

#include "analysis.h"
#include "call.h"
#include "camera.h"
#include "lens.h"

namespace petzval::python {

namespace {

Losses losses_of(const nb::object& lens_or_camera) {
  return nb::isinstance<CameraInPython>(lens_or_camera)
             ? nb::cast<const CameraInPython&>(lens_or_camera).losses
             : Losses{};
}

bool ignores_apertures(const nb::object& lens_or_camera) {
  return nb::isinstance<CameraInPython>(lens_or_camera) &&
         nb::cast<const CameraInPython&>(lens_or_camera).apertures == Camera::Apertures::ignored;
}

// ---- analyses

/// A column as Python has it: numbers (a gap is NaN) and yes-no as arrays, text as a list.
nb::object column_of(const Table& table, std::size_t c) {
  bool numbers = true, yes_no = !table.rows.empty();
  for (const auto& row : table.rows) {
    numbers =
        numbers && !std::holds_alternative<std::string>(row[c]) && !std::holds_alternative<bool>(row[c]);
    yes_no = yes_no && std::holds_alternative<bool>(row[c]);
  }
  if (numbers) {
    Numbers values;
    for (const auto& row : table.rows) values.push_back(std::get<double>(row[c]));
    return nb::cast(array_of(std::move(values)));
  }
  nb::list values;
  for (const auto& row : table.rows) std::visit([&](const auto& cell) { values.append(cell); }, row[c]);
  return values;
}

}  // namespace

nb::object table_of(const AnalysisTable& each) {
  nb::dict columns, units;
  for (std::size_t c = 0; c < each.table.columns.size(); ++c) {
    const TableColumn& column = each.table.columns[c];
    const std::string key = column.key.empty() ? column.name : column.key;
    columns[key.c_str()] = column_of(each.table, c);
    units[key.c_str()] = column.unit;
  }
  return call_python("petzval._tables", "Table", columns, units, each.heading, to_text(each.table));
}

nb::object python_of(const std::string& name, const AnalysisResult& result) {
  nb::dict tables, facts;
  for (const AnalysisTable& each : result.tables) tables[each.key.c_str()] = table_of(each);
  for (const auto& [key, value] : result.facts)
    facts[key.c_str()] = std::visit([](const auto& v) { return nb::cast(v); }, value);
  const std::string svg = result.plots.empty() ? ""
                          : result.plots.size() == 1
                              ? result.plots[0].svg()
                              : plot_grid_svg(result.plots, result.plots_across, result.plots_title);
  return call_python("petzval._tables", "Analysis", name, result.lens, to_string(result.field_kind),
                     result.reference_wavelength_nm, tables, facts, result.remarks, svg);
}

FieldTableRequest request_of(const Lens& lens, const Numbers& fields,
                             const std::optional<std::string>& field_type, const Numbers& wavelengths_nm,
                             bool ignore_apertures, const Losses& losses) {
  FieldTableRequest at = FieldTableRequest::of(lens);
  if (field_type) at.field_kind = field_kind_of(*field_type);
  if (!fields.empty()) at.fields = fields;
  if (field_type && fields.empty() && at.field_kind != lens.fields.kind)
    throw InputError("`field_type` without `fields`; fields of that type would be right");
  if (!wavelengths_nm.empty()) at.wavelengths_nm = wavelengths_nm;
  if (ignore_apertures) at.clip = Tracer::Clip::stop_only;
  at.losses = losses;
  return at;
}

namespace {

nb::object run_analysis(const nb::object& self, const std::string& name, const Numbers& fields,
                        const Maybe<std::string>& field_type, const Numbers& wavelengths_nm,
                        bool ignore_apertures, bool plots, const Numbers& frequencies_cpmm, bool geometric,
                        bool polychromatic, const Numbers& weights, bool over_field,
                        Maybe<double> through_focus_mm, const Numbers& radii_um, const std::string& about,
                        int rays, bool opd, int samples, const std::string& zernike_order, int terms,
                        const std::string& spot_weight, double focus_frequency_cpmm,
                        double sensor_reflectance, double source_diameter_deg, int ghost_reflections,
                        double azimuth_deg, bool as_psf, const Maybe<std::string>& scatter,
                        double hole_percent, double surround_deg, bool ghosts, int threads,
                        const nb::object& progress) {
  const Lens lens = lens_to_look_at(self);
  AnalysisRequest request;
  request.at = request_of(lens, fields, field_type, wavelengths_nm,
                          ignore_apertures || ignores_apertures(self), losses_of(self));
  request.at.azimuth_deg = azimuth_deg;
  if (as_psf) request.mtf.model = {PupilModel::Amplitude::light, PupilModel::Phase::plane_waves};
  request.plots = plots;
  request.mtf.frequencies_cpmm = frequencies_cpmm, request.mtf.geometric = geometric,
  request.mtf.weights = weights;
  request.polychromatic_mtf = polychromatic, request.mtf_over_field = over_field,
  request.mtf_through_focus_mm = through_focus_mm;
  request.encircled_energy.radii_um = radii_um;
  request.encircled_energy.about_centroid =
      choice<bool>("about", about, {{"centroid", true}, {"chief-ray", false}});
  request.fan_rays = rays, request.opd_fans = opd, request.map_samples = samples;
  request.zernike_order = choice<ZernikeOrder>(
      "zernike_order", zernike_order, {{"fringe", ZernikeOrder::fringe}, {"noll", ZernikeOrder::noll}});
  request.zernike_terms = terms;
  request.spot_weight = choice<RayWeight>("spot_weight", spot_weight,
                                          {{"area", RayWeight::stop_area}, {"light", RayWeight::light}});
  request.focus_frequency_cpmm = focus_frequency_cpmm;
  request.sensor_reflectance = sensor_reflectance, request.source_diameter_deg = source_diameter_deg;
  request.ghost_reflections = ghost_reflections;
  if (scatter && *scatter != "lens") request.glare.surfaces_scatter = parse_scatter(*scatter);
  request.glare.hole_percent = hole_percent, request.glare.surround_deg = surround_deg,
  request.glare.ghosts = ghosts;
  Call call({threads, 1, progress});
  return python_of(name, call([&](const Context& context) { return analyse(name, lens, request, context); }));
}

// ---- PSFs

PsfStack psfs(const nb::object& self, const Numbers& fields, const Maybe<std::string>& field_type,
              const Numbers& wavelengths_nm, int size, double spacing_um, const std::string& method,
              int pupil_samples, bool ignore_apertures, double azimuth_deg, int threads,
              const nb::object& progress) {
  const bool fft = choice<bool>("method", method, {{"rays", false}, {"fft", true}});
  if (pupil_samples < 8 || pupil_samples > 1024)
    throw InputError(fmt::format("`pupil_samples` {}; 8 to 1024 would be right", pupil_samples));
  const Lens lens = lens_to_look_at(self);
  FieldTableRequest at = request_of(lens, fields, field_type, wavelengths_nm,
                                    ignore_apertures || ignores_apertures(self), losses_of(self));
  at.azimuth_deg = azimuth_deg;
  PsfOptions options;
  options.size = size, options.spacing_um = spacing_um;
  Call call({threads, 1, progress});
  return call(
      [&](const Context& context) { return psf_stack(lens, at, options, context, fft ? pupil_samples : 0); });
}

template <typename T>
Array<T> psf_view(nb::handle self, std::vector<T>& values, bool with_cells) {
  const auto& stack = nb::cast<const PsfStack&>(self);
  const auto side = static_cast<std::size_t>(stack.size);
  const std::size_t shape[] = {stack.fields.size(), stack.wavelengths_nm.size(), side, side};
  return Array<T>(values.data(), with_cells ? 4 : 2, shape, self);
}

/// Of the cells, from the chief ray [um].
OwnArray<double> cell_places(const PsfStack& stack) {
  Numbers places;
  for (int i = 0; i < stack.size; ++i) places.push_back((i - stack.size / 2) * stack.spacing_um);
  return array_of(std::move(places));
}

void bind_psf(nb::module_& module) {
  nb::class_<PsfStack>(module, "PsfStack",
                       "PSFs by field and wavelength on one grid, each centred on its chief ray, with the "
                       "sum 1: (field, wavelength, y, x), y "
                       "away from the axis.")
      .def_prop_ro(
          "values", [](nb::handle self) { return psf_view(self, nb::cast<PsfStack&>(self).values, true); },
          "A view (field, wavelength, y, x) of float32, without a copy.")
      .def_prop_ro(
          "shape",
          [](const PsfStack& s) {
            return nb::make_tuple(s.fields.size(), s.wavelengths_nm.size(), s.size, s.size);
          },
          "(fields, wavelengths, y, x), as of `values`.")
      .def_prop_ro(
          "captured",
          [](nb::handle self) { return psf_view(self, nb::cast<PsfStack&>(self).captured, false); },
          "(field, wavelength): share of the light inside the window.")
      .def_prop_ro(
          "image_height_mm",
          [](nb::handle self) { return psf_view(self, nb::cast<PsfStack&>(self).image_height_mm, false); },
          "(field, wavelength): of the chief ray on the sensor, signed.")
      .def_prop_ro("fields", [](const PsfStack& s) { return array_of(s.fields); })
      .def_prop_ro("field_type", [](const PsfStack& s) { return to_string(s.field_kind); })
      .def_prop_ro("wavelengths_nm", [](const PsfStack& s) { return array_of(s.wavelengths_nm); })
      .def_ro("size", &PsfStack::size, "Cells a side.")
      .def_ro("spacing_um", &PsfStack::spacing_um)
      .def_prop_ro("x_um", cell_places, "Sagittal, of the cells.")
      .def_prop_ro("y_um", cell_places, "Tangential, positive away from the axis.")
      .def(
          "to_xarray", [](nb::handle self) { return call_python("petzval._xarray", "psfs", self); },
          "As xarray.Dataset with units as attributes, sharing the memory.")
      .def(
          "__array__",
          [](nb::handle self, const nb::object& dtype, const nb::object& copy) {
            return call_python("petzval._arrays", "array", self.attr("values"), dtype, copy);
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none())
      .def("__dlpack__",
           [](nb::handle self, const nb::kwargs& k) { return self.attr("values").attr("__dlpack__")(**k); })
      .def("__dlpack_device__",
           [](nb::handle self) { return self.attr("values").attr("__dlpack_device__")(); })
      .def("__repr__", [](const PsfStack& s) {
        return fmt::format("<PsfStack: {} fields, {} wavelengths, {} x {} cells of {:.4g} um>",
                           s.fields.size(), s.wavelengths_nm.size(), s.size, s.size, s.spacing_um);
      });
}

// ---- rays

nb::object traced(const nb::object& self,
                  const nb::ndarray<const double, nb::ndim<2>, nb::device::cpu>& points,
                  const nb::ndarray<const double, nb::ndim<2>, nb::device::cpu>& directions,
                  Maybe<double> wavelength_nm, bool ignore_apertures) {
  if (points.shape(1) != 3 || directions.shape(1) != 3 || points.shape(0) != directions.shape(0))
    throw InputError("`points_mm` and `directions` are arrays (ray, 3) of as many rays");
  const Lens lens = lens_to_look_at(self);
  const Tracer tracer(lens, wavelength_nm.value_or(lens.reference_wavelength_nm));
  const auto clip = ignore_apertures ? Tracer::Clip::none : Tracer::Clip::apertures;
  const std::size_t count = points.shape(0);
  Numbers places(count * 3), cosines(count * 3), paths(count);
  nb::list status;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray;
    double length = 0;
    for (std::size_t c = 0; c < 3; ++c)
      ray.point_mm[c] = points(i, c), length = std::hypot(length, directions(i, c));
    if (!(length > 0))
      throw InputError(
          fmt::format("`directions` of ray {} are all zero; direction cosines would be right", i));
    for (std::size_t c = 0; c < 3; ++c) ray.direction[c] = directions(i, c) / length;
    ray = tracer.trace(ray, clip);
    const bool arrived = ray.status == RayStatus::ok;
    for (std::size_t c = 0; c < 3; ++c) {
      places[3 * i + c] = arrived ? ray.point_mm[c] : NAN;
      cosines[3 * i + c] = arrived ? ray.direction[c] : NAN;
    }
    paths[i] = arrived ? ray.opl_mm : NAN;
    status.append(to_string(ray.status));
  }
  return call_python("petzval._tables", "TracedRays", status, array_of(std::move(places), {count, 3}),
                     array_of(std::move(cosines), {count, 3}), array_of(std::move(paths)));
}

// ---- drawing

nb::object drawing(const nb::object& self, const Numbers& fields, const Maybe<std::string>& field_type,
                   int rays, Maybe<double> wavelength_nm) {
  const Lens lens = lens_to_look_at(self);
  const FieldTableRequest at = request_of(lens, fields, field_type, {}, false);
  FieldTracer tracer(lens, wavelength_nm.value_or(lens.reference_wavelength_nm), at.clip);
  LensDrawingOptions options;
  options.title = fmt::format("{} — rays at {:g} nm", lens.name, tracer.tracer().wavelength_nm());
  std::vector<DrawnRay> drawn;
  for (std::size_t i = 0; i < at.fields.size(); ++i) {
    const std::string colour = series_colour(i).hex();
    for (const MeridionalPath& path : meridional_fan(tracer, object_field(lens, at.field_kind, at.fields[i]),
                                                     rays, 0.25 * lens.total_track_mm()))
      drawn.push_back({path, colour});
    options.legend.push_back({fmt::format("{:g} {}", at.fields[i], field_unit(at.field_kind)), colour});
  }
  return call_python("petzval._display", "Svg", draw_lens(lens, drawn, options));
}

/// For notebooks: a lens that cannot be drawn shows its text.
nb::object svg_repr(const nb::object& self) {
  try {
    return drawing(self, {}, {}, 5, {});
  } catch (const InputError&) {
    return nb::none();
  }
}

constexpr const char* analyse_text =
    "Runs an analysis by its name (petzval.analyses() lists them) and gives an Analysis, whose columns are "
    "arrays. `fields`, "
    "`field_type` (angle_deg, object_height_mm, paraxial_image_height_mm, real_image_height_mm) and "
    "`wavelengths_nm`: where; empty: "
    "the lens's own. `azimuth_deg`: of the fields, from +y towards +x. `as_psf`: the MTF as the exact "
    "transform "
    "of the PSF. Each analysis takes the other keywords that it knows of; docs/ANALYSES.md says which. "
    "`plots`: draws too.";
constexpr const char* psf_text =
    "Diffraction PSFs by field and wavelength on one grid, as a PsfStack. `size` 0 and `spacing_um` 0: "
    "chosen so that all fit. `method`: rays (plane waves of real rays), or fft, the model of the plain FFT "
    "with "
    "`pupil_samples` across the pupil, to compare with other programs (docs/PSF.md).";
constexpr const char* trace_text =
    "Traces rays in lens space to the image surface. `points_mm`, `directions`: arrays (ray, 3). Gives "
    "TracedRays with `status`, "
    "`points_mm`, `directions`, `opl_mm`; numbers of rays that do not arrive are NaN.";
constexpr const char* draw_text =
    "The layout with `rays` rays of each field, as SVG text that notebooks show.";

#define PETZVAL_ANALYSE_ARGUMENTS                                                                            \
  nb::arg("name"),                                                                                           \
      nb::arg("fields") = Numbers(), nb::kw_only(), nb::arg("field_type").none() = nb::none(),               \
      nb::arg("wavelengths_nm") = Numbers(), nb::arg("ignore_apertures") = false, nb::arg("plots") = false,  \
      nb::arg("frequencies_cpmm") = Numbers(), nb::arg("geometric") = false,                                 \
      nb::arg("polychromatic") = false, nb::arg("weights") = Numbers(), nb::arg("over_field") = false,       \
      nb::arg("through_focus_mm").none() = nb::none(), nb::arg("radii_um") = Numbers(),                      \
      nb::arg("about") = "centroid", nb::arg("rays") = 21, nb::arg("opd") = false, nb::arg("samples") = 64,  \
      nb::arg("zernike_order") = "fringe", nb::arg("terms") = 0, nb::arg("spot_weight") = "area",            \
      nb::arg("focus_frequency_cpmm") = 40.0, nb::arg("sensor_reflectance") = 0.0,                           \
      nb::arg("source_diameter_deg") = 0.53, nb::arg("ghost_reflections") = 2, nb::arg("azimuth_deg") = 0.0, \
      nb::arg("as_psf") = false, nb::arg("scatter").none() = nb::none(), nb::arg("hole_percent") = 10.0,     \
      nb::arg("surround_deg") = 60.0, nb::arg("ghosts") = false, nb::arg("threads") = 0,                     \
      nb::arg("progress").none() = nb::none()

/// What a lens and a camera have alike.
void bind_methods(const nb::handle& type) {
  const auto add = [&](const char* name, auto function, auto... extra) {
    nb::cpp_function_def(function, nb::scope(type), nb::name(name), nb::is_method(), extra...);
  };
  add("analyse", run_analysis, PETZVAL_ANALYSE_ARGUMENTS, analyse_text);
  add("psf", psfs, nb::arg("fields") = Numbers(), nb::kw_only(), nb::arg("field_type").none() = nb::none(),
      nb::arg("wavelengths_nm") = Numbers(), nb::arg("size") = 0, nb::arg("spacing_um") = 0.0,
      nb::arg("method") = "rays", nb::arg("pupil_samples") = 256, nb::arg("ignore_apertures") = false,
      nb::arg("azimuth_deg") = 0.0, nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(),
      psf_text);
  add("trace", traced, nb::arg("points_mm"), nb::arg("directions"),
      nb::arg("wavelength_nm").none() = nb::none(), nb::kw_only(), nb::arg("ignore_apertures") = false,
      trace_text);
  add("draw", drawing, nb::arg("fields") = Numbers(), nb::kw_only(),
      nb::arg("field_type").none() = nb::none(), nb::arg("rays") = 5,
      nb::arg("wavelength_nm").none() = nb::none(), draw_text);
  add("_repr_svg_", svg_repr);
  for (const Analysis& each : analyses()) {
    std::string name = each.name == "focus" ? "best_focus" : each.name;  // a camera's `focus` is its setting
    std::ranges::replace(name, '-', '_');
    const std::string text = each.description + ". Takes the keywords of `analyse`.";
    add(
        name.c_str(),
        [name = each.name](const nb::object& self, const Numbers& fields, const nb::kwargs& keywords) {
          return self.attr("analyse")(name, fields, **keywords);
        },
        nb::arg("fields") = Numbers(), nb::arg("keywords"), text.c_str());
  }
}

}  // namespace

void bind_analysis(nb::module_& module) {
  bind_psf(module);
  bind_methods(nb::type<Lens>());
  bind_methods(nb::type<CameraInPython>());
  module.def(
      "analyses",
      [] {
        std::map<std::string, std::string> all;
        for (const Analysis& each : analyses()) all[each.name] = each.description;
        return all;
      },
      "{name: what it tells} of the analyses that `analyse` runs.");
}

}  // namespace petzval::python
