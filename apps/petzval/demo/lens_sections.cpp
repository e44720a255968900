// SPDX-License-Identifier: BSD-3-Clause
// Figures 5, 6, 7, 8 and 9: the lens by itself.
#include <fmt/format.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/ray_count.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/optics/table_interpolation.h>
#include <petzval/report/colours.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/lens_drawing.h>

#include <algorithm>
#include <cmath>

#include "demo.h"

namespace petzval::app {

namespace {

constexpr int curve_points = 121;
/// Of the independent check in Fig. 8: rays over the hemisphere, squared.
constexpr int counted_rays_a_side = 1500;
/// Fig. 9: frames of 32 µm, as in the paper.
constexpr int frame_samples = 128;
constexpr double frame_spacing_um = 0.25;

std::string drawing_of(const Lens& lens, const std::vector<double>& fields,
                       const std::vector<std::string>& names) {
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  LensDrawingOptions options;
  options.title = lens.name;
  std::vector<DrawnRay> rays;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string colour = series_colour(i).hex();
    for (const MeridionalPath& path : meridional_fan(tracer, fields[i], 7, 0.3 * lens.total_track_mm()))
      rays.push_back({path, colour});
    options.legend.push_back({names[i], colour});
  }
  return draw_lens(lens, rays, options);
}

/// Largest difference of the real image heights of 486.13 and 656.27 nm over the field [µm].
double lateral_colour_um(const Lens& lens) {
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.wavelengths_nm = {486.1327, 656.2725};
  request.field_kind = Fields::Kind::paraxial_image_height_mm;
  request.fields = {1, 1.5, 2, 2.5, 3};
  const std::vector<DistortionRow> rows = distortion_table(lens, request);
  double largest = 0;
  for (std::size_t i = 0; i < rows.size(); i += 2)
    largest = std::max(largest, std::abs(rows[i].image_height_mm - rows[i + 1].image_height_mm) * um_per_mm);
  return largest;
}

double distortion_percent(const Lens& lens, Fields::Kind kind, double height_mm) {
  FieldTableRequest request{kind, {height_mm}, {paper_wavelength_nm}, Tracer::Clip::apertures};
  return distortion_table(lens, request).front().distortion_percent;
}

std::vector<double> evenly(double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(last * i / (count - 1));
  return values;
}

/// The least-squares polynomials of the paper through the points of a table, as dashed lines.
void add_fits(Plot& plot, const std::vector<double>& x, const std::vector<double>& y, Powers powers,
              std::vector<std::vector<TableCell>>& residuals, const std::string& quantity, double scale) {
  for (const int order : {4, 6, 8}) {
    const PolynomialFit fit = fit_polynomial(x, y, order, powers);
    std::vector<double> at = evenly(x.back(), curve_points), values;
    for (const double h : at) values.push_back(fit(h));
    plot.line(fmt::format("order {}", order), at, values).stroke = PlotStroke::dashed;
    residuals.push_back(
        {quantity, static_cast<double>(order), fit.rms_residual * scale, fit.max_residual * scale});
  }
}

}  // namespace

void layout_section(Demo& demo) {
  const Lens& lens = demo.edmund;
  std::vector<double> fields;
  std::vector<std::string> names;
  for (const double height : lens.fields.values) {
    fields.push_back(object_field(lens, lens.fields.kind, height));
    names.push_back(fmt::format("{:g} mm paraxial image height", height));
  }
  const FirstOrder data = first_order(lens);
  FieldTracer tracer(lens, paper_wavelength_nm);
  const double sine = std::sqrt(tracer.g_sensor_sr(*tracer.chief_ray(0)) / pi);
  const std::string drawing = drawing_of(lens, fields, names);
  demo.write("fig05-layout.svg", drawing);
  demo.page.section("The lens (figure 5)", "Lens")
      .add(html::figure(
          html::drawing(drawing),
          "Edmund Optics R54-852 with rays of three object points 250 mm away, at 587.56 nm. All rays "
          "pass the real stop and every clear aperture."))
      .add(html::comparison(
          {{"focal length", "6.0 mm", fmt::format("{:.4f} mm", data.efl_mm), ""},
           {"image-space NA", "0.264", fmt::format("{:.4f} real, {:.4f} paraxial", sine, data.image_space_na),
            "the real marginal ray; its paraxial limit is that of the working f-number 1.8"},
           {"magnification", "−0.024", with_minus(fmt::format("{:.5f}", data.magnification)), ""},
           {"full field of view", "52.4°", fmt::format("{:.2f}°", data.field_of_view_deg),
            "to the paraxial image height of 3 mm"},
           {"distortion at the edge", "roughly −10 %",
            with_minus(fmt::format("{:.2f} % at 3 mm paraxial, {:.2f} % at 3 mm real",
                                   distortion_percent(lens, Fields::Kind::paraxial_image_height_mm, 3),
                                   distortion_percent(lens, Fields::Kind::real_image_height_mm, 3))),
            "the corner of the sensor lies at 3 mm real image height"},
           {"lateral colour", "< 15 µm", fmt::format("{:.1f} µm", lateral_colour_um(lens)),
            "486.13 to 656.27 nm, up to 3 mm paraxial; the paper does not state its wavelengths"}},
          "paper", "here"));
}

void distortion_section(Demo& demo, const LensDataTable& table) {
  std::vector<double> ideal, real;
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    ideal.push_back(std::abs(ideal_image_height_mm(demo.edmund, table.fields[f], paper_wavelength_nm)));
    real.push_back(table.real_image_height_mm[f]);
  }
  Plot plot;
  plot.title = "Distorted image height, 587.56 nm";
  plot.x = {"ideal image height", "mm", PlotScale::linear, {}, {}};
  plot.y = {"real image height", "mm", PlotScale::linear, {}, {}};
  plot.scatter("ray trace", ideal, real);
  plot.line("no distortion", {0, ideal.back()}, {0, ideal.back()}).stroke = PlotStroke::dotted;
  std::vector<std::vector<TableCell>> residuals;
  add_fits(plot, ideal, real, Powers::no_constant, residuals, "real image height", um_per_mm);
  demo.write("fig06-distortion.svg", plot.svg());
  demo.page.section("Distorted image height (figure 6)", "Distortion")
      .add(html::figure(
          html::drawing(plot.svg()),
          "Real chief rays, aimed at the centre of the real stop, and least-squares polynomials as the "
          "paper uses them. Pictures are made with a monotone interpolant, which meets every point."))
      .add(
          html::table({{{"fit of", "", 0}, {"order", "", 0}, {"rms residual", "µm", 3}, {"largest", "µm", 3}},
                       residuals}));
}

void illumination_section(Demo& demo, const LensDataTable& table) {
  std::vector<double> height = table.real_image_height_mm, relative;
  for (const double g : table.g_sensor_sr) relative.push_back(g / table.g_sensor_sr.front());
  Plot fits;
  fits.title = "Relative illumination, 587.56 nm";
  fits.x = {"real image height", "mm", PlotScale::linear, {}, {}};
  fits.y = {"g_sensor / g_sensor on axis", "", PlotScale::linear, {}, {}};
  fits.scatter("ray trace", height, relative);
  std::vector<std::vector<TableCell>> residuals;
  add_fits(fits, height, relative, Powers::all, residuals, "relative illumination", 1e3);
  demo.write("fig07-illumination-fits.svg", fits.svg());

  // Figure 8: the same against cos⁴ of the angle in object space, and against a ray count that knows no
  // pupil.
  const Tracer tracer(demo.edmund, paper_wavelength_nm);
  const double on_axis = counted_g_sensor_sr(tracer, 0, counted_rays_a_side);
  std::vector<double> counted_height = {0, 0.5, 1, 1.5, 2, 2.4, 2.75, 3}, counted, cos4;
  for (std::size_t i = 0; i < counted_height.size(); ++i) {
    counted.push_back(counted_g_sensor_sr(tracer, counted_height[i], counted_rays_a_side) / on_axis);
    if (demo.progress)
      demo.progress(static_cast<double>(i + 1) / static_cast<double>(counted_height.size()), "ray count");
  }
  const FirstOrder data = first_order(demo.edmund, paper_wavelength_nm);
  const RadialProfile profile = RadialProfiles(table).at_wavelength(paper_wavelength_nm);
  const std::vector<double> fine = evenly(height.back(), curve_points);
  std::vector<double> smooth;
  for (const double h : fine) {
    smooth.push_back(profile.g_sensor_sr(h) / table.g_sensor_sr.front());
    // An ideal thin lens at the entrance pupil sees the same object point at this angle.
    const double tangent =
        profile.object_field(h) / (*table.object_distance_mm + data.entrance_pupil.position_mm);
    cos4.push_back(std::pow(1 + tangent * tangent, -2));
  }
  double worst = 0;
  for (std::size_t i = 0; i < counted_height.size(); ++i)
    worst = std::max(
        worst, std::abs(counted[i] * table.g_sensor_sr.front() / profile.g_sensor_sr(counted_height[i]) - 1));
  Plot check;
  check.title = "Relative illumination against cos⁴ and against a ray count";
  check.x = fits.x;
  check.y = {"relative illumination", "", PlotScale::linear, 0.0, {}};
  check.line("g_sensor of the table", fine, smooth);
  check.line("cos⁴ of the field angle", fine, cos4).stroke = PlotStroke::dashed;
  check.scatter("ray count", counted_height, counted);
  demo.write("fig08-illumination-check.svg", check.svg());

  demo.page.section("Relative illumination (figures 7 and 8)", "Illumination")
      .add(html::side_by_side(
          {html::figure(html::drawing(fits.svg()),
                        "What a uniform wall gives on the sensor, from pencils bounded by "
                        "the real apertures, and the paper's polynomials."),
           html::figure(
               html::drawing(check.svg()),
               fmt::format(
                   "Barrel distortion squeezes the light of the edge together and holds up the corner, "
                   "far above cos⁴. The points count {0}² backward rays each and agree with the table "
                   "to {1:.1e}.",
                   counted_rays_a_side, worst))}))
      .add(html::table(
          {{{"fit of", "", 0}, {"order", "", 0}, {"rms residual", "‰", 3}, {"largest", "‰", 3}}, residuals}))
      .add(html::comparison({{"agreement of model and ray trace", "close (LightTools, a plot)",
                              fmt::format("{:.1e} relative", worst), "independent backward ray count"},
                             {"irradiance per radiance on axis", "not given",
                              fmt::format("{:.5f} sr", table.g_sensor_sr.front()), "π sin²U′"}},
                            "paper", "here"));
}

void psf_section(Demo& demo) {
  FieldTracer tracer(demo.edmund, paper_wavelength_nm);
  std::vector<StripFrame> frames;
  PsfOptions options;
  options.size = frame_samples;
  options.spacing_um = frame_spacing_um;
  for (int i = 0; i <= 12; ++i) {
    const double height = 0.25 * i;
    const std::optional<double> field = tracer.object_field_at_image_height(height);
    const std::optional<ChiefRay> chief = field ? tracer.chief_ray(*field) : std::nullopt;
    const std::optional<Psf> psf = chief ? point_spread(tracer, *chief, options) : std::nullopt;
    if (!psf) continue;
    HeatMapOptions map;
    map.gamma = 2;
    map.first_row_on_top = false;
    frames.push_back({heat_map_png(psf->values, psf->size, psf->size, map),
                      fmt::format("{:.2f} mm\n{:.1f} % inside", height, 100 * psf->captured)});
    if (demo.progress) demo.progress((i + 1) / 13.0, "PSFs");
  }
  ImageStripOptions strip;
  strip.frames_per_row = 7;
  strip.frame_width = frame_samples * frame_spacing_um;
  strip.unit = "µm";
  const std::string svg =
      image_strip_svg(frames, strip, "Point-spread functions at 587.56 nm from axis to corner");
  demo.write("fig09-psfs.svg", svg);
  demo.page.section("Point-spread functions (figure 9)", "PSFs")
      .add(html::figure(
          html::drawing(svg),
          "Diffraction PSFs at 587.56 nm in frames of 32 µm, each scaled to its own peak and shown on a "
          "square-root scale; the label is the real image height, and the share of light inside the "
          "frame. Up is away from the axis. Summed as plane waves on the flat sensor, so that oblique "
          "incidence needs no projection (the paper's complaint about the FFT PSF)."));
}

}  // namespace petzval::app
