// SPDX-License-Identifier: BSD-3-Clause
// The section of a lens report about a sensor.
#include <fmt/format.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/vignetting.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/report/report_section.h>

#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// Those of the image heights that a chief ray reaches, none beyond the first that fails.
std::vector<double> reachable(const Lens& lens, const std::vector<double>& heights_mm) {
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  std::vector<double> reached;
  for (const double height : heights_mm) {
    const std::optional<double> field = tracer.object_field_at_image_height(height);
    const std::optional<ChiefRay> chief = field ? tracer.chief_ray(*field) : std::nullopt;
    if (!chief || !tracer.object_pupil(*chief, 64)) break;
    reached.push_back(height);
  }
  return reached;
}

constexpr double nan_gap = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void add_sensor_section(html::Page& page, const ReportLens& report, const ReportSensor& sensor,
                        const std::string& title_end) {
  constexpr double nyquist = 0.5;  // cycles/pixel
  const double nyquist_cpmm = nyquist / (sensor.pitch_um * mm_per_um);
  std::vector<double> heights;
  for (const double share : {0.0, 0.25, 0.5, 0.7, 0.85, 1.0})
    heights.push_back(share * sensor.half_diagonal_mm);
  FieldTableRequest request = report.request;
  request.field_kind = Fields::Kind::real_image_height_mm;
  request.fields = reachable(report.lens, heights);
  MtfOptions options;
  options.frequencies_cpmm = {nyquist_cpmm};
  options.weights.assign(request.wavelengths_nm.size(), 1);
  const std::vector<MtfRow> mtf = mtf_table(report.lens, request, options);
  FieldTableRequest one = request;
  one.wavelengths_nm = {report.lens.reference_wavelength_nm};
  const std::vector<ChiefRayAngleRow> angles = chief_ray_angle_table(report.lens, one);
  const double across = std::abs(sensor.photosite.transform(nyquist, 0)),
               along = std::abs(sensor.photosite.transform(0, nyquist));
  const bool microlens = sensor.microlens_heights_mm.size() > 1;
  Table table{{{"image height", "mm", 3},
               {"lens MTF, tangential", "", 3},
               {"lens MTF, sagittal", "", 3},
               {"× pixel, tangential", "", 3},
               {"× pixel, sagittal", "", 3},
               {"chief-ray angle", "deg", 2}},
              {}};
  if (microlens) {
    table.columns.push_back({"microlens made for", "deg", 2});
    table.columns.push_back({"mismatch", "deg", 2});
  }
  Plot plot;
  plot.title = "Chief-ray angle over the sensor";
  plot.x = {"real image height", "mm", PlotScale::linear, 0.0, sensor.half_diagonal_mm};
  plot.y = {"angle against the normal", "deg"};
  std::vector<double> x, lens_angle, made_for;
  const MonotoneCubic design =
      microlens ? MonotoneCubic(sensor.microlens_heights_mm, sensor.microlens_angles_deg) : MonotoneCubic();
  for (std::size_t i = 0; i < mtf.size(); ++i) {
    const double angle = angles[i].chief_ray_angle_deg, wanted = microlens ? design(mtf[i].field) : nan_gap;
    table.rows.push_back({mtf[i].field, mtf[i].tangential, mtf[i].sagittal, mtf[i].tangential * along,
                          mtf[i].sagittal * across, angle});
    if (microlens)
      table.rows.back().insert(table.rows.back().end(), {TableCell(wanted), TableCell(angle - wanted)});
    x.push_back(mtf[i].field);
    lens_angle.push_back(angle);
    made_for.push_back(wanted);
  }
  plot.line("lens", x, lens_angle).marker = PlotMarker::dot;
  if (microlens) plot.line("microlenses", x, made_for).stroke = PlotStroke::dashed;
  page.section("On the sensor " + sensor.name + title_end, "sensor" + title_end);
  page.add(html::paragraph(fmt::format(
      "Pixels of {:g} µm resolve {:.1f} cycles/mm (Nyquist, 0.5 cycles/pixel); there the pixel itself passes "
      "{:.3f} across and {:.3f} along. Lens MTF: diffraction, the lens's {} wavelengths together, alike. "
      "Tangential patterns vary away from the axis; the pixel's share is that of the vertical for them and "
      "of the horizontal for sagittal ones, as above and below the centre.",
      sensor.pitch_um, nyquist_cpmm, across, along, request.wavelengths_nm.size())));
  if (mtf.size() < heights.size())
    page.add(
        html::paragraph(fmt::format("**The image does not reach the corner:** no light arrives at {:.3f} mm, "
                                    "where the corner is at {:.3f} mm.",
                                    heights[mtf.size()], sensor.half_diagonal_mm)));
  if (!microlens)
    page.add(
        html::paragraph("The sensor's description does not say for which angles its microlenses are made."));
  page.add(html::table(table));
  page.add(figure_with_data(plot.svg(), "Chief-ray angle of the lens at the reference wavelength.",
                            "sensor.csv", table));
}

}  // namespace petzval
