// SPDX-License-Identifier: BSD-3-Clause
#include "target_output.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/tiff.h>

#include <algorithm>
#include <cmath>

#include "field_option.h"
#include "output_option.h"

namespace petzval::app {

namespace {

/// Code values; values outside 0 … 1 are clipped.
std::vector<std::uint16_t> code_values(const TargetImage& image, int bits, bool linear) {
  std::vector<std::uint16_t> codes;
  codes.reserve(image.values.size());
  for (const double value : image.values) {
    const double encoded = linear ? value : srgb_encoded(value);
    codes.push_back(bits == 8 ? quantised_8(encoded) : quantised_16(encoded));
  }
  return codes;
}

void write_picture_png(const std::string& path, const TargetImage& image, int bits, bool linear) {
  PngImage png;
  png.columns = image.columns, png.rows = image.rows, png.channels = 1, png.bits = bits;
  png.transfer = linear ? PngTransfer::linear : PngTransfer::srgb;
  png.samples = code_values(image, bits, linear);
  write_png(path, png);
}

void write_picture_tiff(const std::string& path, const TargetImage& image, int bits, bool linear) {
  TiffImage tiff;
  tiff.columns = image.columns, tiff.rows = image.rows, tiff.channels = 1;
  tiff.description = linear ? "petzval target, linear" : "petzval target, sRGB";
  const std::vector<std::uint16_t> codes = code_values(image, bits, linear);
  if (bits == 8)
    tiff.samples = std::vector<std::uint8_t>(codes.begin(), codes.end());
  else
    tiff.samples = codes;
  write_tiff(path, tiff);
}

void write_exr(const std::string& path, const TargetImage& image, const TargetOptics& optics) {
  if (optics.wavelengths_nm.size() != 1)
    throw InputError(path, "an .exr holds the irradiance of one wavelength; write .npy or .tif");
  const std::string aperture = optics.site().text();
  SpectralImage spectral(image.columns, image.rows, {optics.wavelengths_nm.front()}, optics.pitch_um,
                         aperture == "box"     ? PixelAperture::box
                         : aperture == "point" ? PixelAperture::point
                                               : PixelAperture::photosite);
  if (spectral.pixel_aperture() == PixelAperture::photosite) spectral.photosite = aperture;
  std::transform(image.values.begin(), image.values.end(), spectral.band(0).begin(),
                 [](double value) { return static_cast<float>(value); });
  spectral.provenance =
      fmt::format("petzval target, relative irradiance; psf {}, f/{}", optics.psf, optics.f_number);
  write_irradiance(path, spectral);
}

/// Real OTF along the x axis through optics and photosite.
double modulation(const Otf& otf, const TargetOptions& options, double cpp, double angle_rad) {
  return std::abs(transfer(otf, options, cpp * std::cos(angle_rad), cpp * std::sin(angle_rad)));
}

struct NamedEdge {
  std::size_t polygon, edge;
  double angle_deg, length;
};

std::vector<NamedEdge> edges_of(const TargetScene& scene) {
  std::vector<NamedEdge> edges;
  for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
    std::size_t index = 0;
    for (const Contour& contour : scene.polygons[p].contours)
      for (std::size_t i = 0; i < contour.size(); ++i) {
        const Vertex &a = contour[i], &b = contour[(i + 1) % contour.size()];
        edges.push_back(
            {p + 1, ++index, std::atan2(b.y - a.y, b.x - a.x) * 180 / pi, std::hypot(b.x - a.x, b.y - a.y)});
      }
  }
  return edges;
}

}  // namespace

void TargetOutput::add_to(CLI::App& command) {
  command
      .add_option("-o,--output", paths,
                  "Picture to write, repeatable: .png, .tif, .npy (float64), .exr (float)")
      ->check(output_file())
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--black", black,
                  "Linear level of dark areas, 1 being full scale; with --sensor: saturation")
      ->capture_default_str();
  command.add_option("--white", white, "Linear level of the light ground")->capture_default_str();
  command.add_option("--bits", bits, "Bits of .png and .tif")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
  command.add_flag("--linear", linear, "Code values of .png and .tif are linear in light; default: sRGB");
}

void TargetOutput::validate() const {
  for (const std::string& path : paths)
    require_extension(path, {".png", ".tif", ".tiff", ".npy", ".exr"}, "a target");
  if (!std::isfinite(black) || !std::isfinite(white) || black == white)
    throw InputError(fmt::format("--black {} and --white {}: two different numbers are right", black, white));
}

void TargetOutput::to_levels(TargetImage& image) const {
  if (black == 0 && white == 1) return;
  for (double& value : image.values) value = black + value * (white - black);
}

void TargetOutput::write(const std::string& path, const TargetImage& image,
                         const TargetOptics& optics) const {
  const std::string extension = extension_of(path);
  if (extension == ".png") return write_picture_png(path, image, bits, linear);
  if (extension == ".exr") return write_exr(path, image, optics);
  if (extension != ".npy") return write_picture_tiff(path, image, bits, linear);
  const std::size_t shape[] = {static_cast<std::size_t>(image.rows), static_cast<std::size_t>(image.columns),
                               1};
  write_npy(path, shape, std::span<const double>(image.values));
}

void write_exact_sfr(const std::string& path, const TargetScene& scene, const Otf& otf,
                     const TargetOptions& options) {
  constexpr std::size_t most_edges = 20000;
  const std::vector<NamedEdge> edges = edges_of(scene);
  if (edges.size() > most_edges)
    throw InputError(path, fmt::format("{} edges would make a table of {} rows; up to {} edges are right",
                                       edges.size(), 101 * edges.size(), most_edges));
  std::string text = "polygon,edge,angle_deg,length_px,frequency_cpp,sfr\n";
  for (const NamedEdge& edge : edges)
    for (int i = 0; i <= 100; ++i) {
      const double cpp = i / 100.0, normal = (edge.angle_deg - 90) * pi / 180;
      const std::complex<double> value =
          transfer(otf, options, cpp * std::cos(normal), cpp * std::sin(normal));
      // Symmetric optics have a real transfer function, whose sign tells reversed contrast.
      const double sfr = std::abs(value.imag()) < 1e-12 ? value.real() : std::abs(value);
      text += fmt::format("{},{},{:.6f},{:.4f},{:.2f},{:.10f}\n", edge.polygon, edge.edge, edge.angle_deg,
                          edge.length, cpp, sfr);
    }
  write_whole_file(path, text);
}

void print_target_summary(const TargetOptics& optics, const Otf& otf, const TargetOptions& options,
                          const TargetScene& scene, const TargetImage& image, const Shared& shared) {
  const auto [low, high] = std::minmax_element(image.values.begin(), image.values.end());
  double mtf50 = 0;
  while (mtf50 < 4 && modulation(otf, options, mtf50, 0) > 0.5) mtf50 += 1e-4;
  const double cutoff = otf.cutoff_cpmm() * options.pitch_um * 1e-3;
  const double blur = optics.geometric_blur_um();
  if (shared.json) {
    nlohmann::ordered_json json = {
        {"columns", image.columns}, {"rows", image.rows}, {"polygons", scene.polygons.size()}};
    json["rows_unit"] = "pixels";
    json["cutoff_cpp"] = cutoff;
    json["cutoff_cpmm"] = otf.cutoff_cpmm();
    json["mtf50_cpp"] = mtf50;
    json["geometric_blur_diameter_um"] = blur;
    json["least_value"] = *low;
    json["greatest_value"] = *high;
    return print_json(json);
  }
  fmt::print("{} x {} pixels of {:g} um, {} polygon{}\n", image.columns, image.rows, options.pitch_um,
             scene.polygons.size(), scene.polygons.size() == 1 ? "" : "s");
  fmt::print("  cut-off of the optics        {:10.4f} cycles/pixel, {:.2f} cycles/mm\n", cutoff,
             otf.cutoff_cpmm());
  fmt::print("  MTF50, edges along the grid  {:10.4f} cycles/pixel\n", mtf50);
  if (optics.psf == "wavefront") fmt::print("  geometric blur diameter      {:10.4f} um\n", blur);
  fmt::print("  values                       {:10.6f} to {:.6f}\n", *low, *high);
}

}  // namespace petzval::app
