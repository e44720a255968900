// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/lens_report.h>
#include <petzval/report/pupil_plots.h>
#include <petzval/report/svg_plot.h>

#include <regex>
#include <string>

namespace petzval {
namespace {

ReportLens small_report(const char* name) {
  ReportLens report{read_lens(name).lens, {}};
  report.request = FieldTableRequest::of(report.lens);
  report.request.fields = {0, report.lens.fields.values.back()};
  report.request.wavelengths_nm = {report.lens.reference_wavelength_nm};
  return report;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// The bytes behind the download of that name, from base64 by a decoder of the test's own.
std::string downloaded(const std::string& page, const std::string& name) {
  const std::string start = "download=\"" + name + "\" href=\"data:text/csv;base64,";
  const std::size_t from = page.find(start);
  if (from == std::string::npos) return {};
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, held = 0;
  for (std::size_t i = from + start.size(); page[i] != '"' && page[i] != '='; ++i) {
    bits = (bits << 6 | static_cast<unsigned>(letters.find(page[i]))) & 0xFFFFF;
    held += 6;
    if (held >= 8) bytes += static_cast<char>(bits >> (held -= 8) & 0xFF);
  }
  return bytes;
}

TEST(LensReport, HoldsEveryAnalysisAndLoadsNothing) {
  const std::string page = lens_report_html({small_report("cooke-triplet")}, {});
  for (const char* section :
       {"Layout and first-order data", "Prescription", "Spots", "Ray and OPD fans", "Wavefront",
        "field curves, distortion", "Colour", "Point spread and encircled energy", "MTF",
        "Illumination, vignetting", "Seidel sums", "Zernike"})
    EXPECT_NE(page.find(section), std::string::npos) << section;
  // Nothing from outside: every address is within the page or its data.
  const std::regex address("(?:href|src)=\"([^\"]{0,8})");
  for (std::sregex_iterator it(page.begin(), page.end(), address), end; it != end; ++it) {
    const std::string target = (*it)[1];
    EXPECT_TRUE(target[0] == '#' || target.rfind("data:", 0) == 0) << target;
  }
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("url("), std::string::npos);
  EXPECT_EQ(page.find(">nan"), std::string::npos) << "a number that is none is a dash";
}

TEST(LensReport, TheDataBehindPlotsAreThoseOfTheAnalyses) {
  const ReportLens report = small_report("cooke-triplet");
  const std::string page = lens_report_html({report}, {});
  const std::string spots = downloaded(page, "spots.csv");
  EXPECT_EQ(spots, to_csv(tabulate(report.request.field_kind, spot_table(report.lens, report.request))));
  EXPECT_EQ(count(spots, "\n"), 1U + 2);
  for (const char* name :
       {"fans.csv", "mtf.csv", "mtf_geometric.csv", "psf.csv", "encircled_energy.csv", "mtf_over_field.csv",
        "mtf_through_focus.csv", "spot_diagrams.csv", "wavefront_maps.csv", "longitudinal.csv",
        "field_curvature.csv", "distortion.csv", "lateral_colour.csv", "illumination.csv", "vignetting.csv",
        "chief_ray_angle.csv", "seidel.csv", "zernike.csv", "prescription.csv"})
    EXPECT_GT(count(downloaded(page, name), "\n"), 2U) << name;
}

TEST(LensReport, ComparesSeveralLenses) {
  const std::string page = lens_report_html({small_report("cooke-triplet"), small_report("tessar")}, {});
  const std::string table = downloaded(page, "comparison.csv");
  EXPECT_EQ(count(table, "\n"), 3U);
  EXPECT_NE(page.find("Spots — "), std::string::npos);
  EXPECT_THROW(lens_report_html({}, {}), InputError);
}

TEST(LensReport, PutsTheLensOnASensor) {
  LensReportOptions options;
  options.sensor = ReportSensor{"test sensor", 10, 3, {}, {0, 3}, {0, 12}};
  const std::string page = lens_report_html({small_report("cooke-triplet")}, options);
  const std::string table = downloaded(page, "sensor.csv");
  // Nyquist of 10 µm pixels is 50 cycles/mm, where a full pixel passes 2/π; each row: lens MTF, then times
  // that.
  std::size_t at = table.find('\n') + 1;
  const auto number = [&] {
    std::size_t used = 0;
    const double value = std::stod(table.substr(at), &used);
    at += used + 1;
    return value;
  };
  const double height = number(), tangential = number(), sagittal = number();
  EXPECT_EQ(height, 0);
  EXPECT_NEAR(number(), tangential * 2 / 3.141592653589793, 1e-12);
  EXPECT_NEAR(number(), sagittal * 2 / 3.141592653589793, 1e-12);
  EXPECT_NE(page.find("mismatch"), std::string::npos);
  // A sensor that the image does not fill is said to be so.
  options.sensor->half_diagonal_mm = 60;
  EXPECT_NE(lens_report_html({small_report("cooke-triplet")}, options).find("does not reach the corner"),
            std::string::npos);
}

TEST(PlotGrid, HoldsItsPlotsSideBySide) {
  Plot plot;
  plot.title = "one";
  plot.line("a", {0, 1}, {0, 1});
  Plot other = plot;
  other.title = "other";
  const std::string svg = plot_grid_svg({plot, other, plot}, 2, "all & more");
  EXPECT_EQ(count(svg, "class=\"pz-data\""), 3U);
  EXPECT_NE(svg.find("all &amp; more"), std::string::npos);
  EXPECT_EQ(count(svg, "<svg"), 1U + 3 + 3);  // each panel, and its clipped frame
  EXPECT_EQ(count(svg, "</svg>"), count(svg, "<svg"));
  EXPECT_NO_THROW(plot_grid_svg({}, 2, "nothing"));
}

}  // namespace
}  // namespace petzval
