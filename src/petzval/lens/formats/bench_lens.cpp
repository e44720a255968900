// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/bench_lens.h>
#include <petzval/lens/formats/row_lens.h>
#include <petzval/lens/lens_fault.h>

#include <cmath>

namespace petzval {

namespace {

void require_valid(const Lens& lens, const std::string& file) {
  if (const auto fault = find_fault(lens)) throw InputError(file, fault->path + " " + fault->message);
}

void focus(LensFile& made, const std::string& file) {
  Lens& lens = made.lens;
  lens.surfaces.back().thickness_mm = 1;  // any
  require_valid(lens, file);
  const double image_mm = first_order(lens).paraxial_image_mm;
  if (!(image_mm > 0 && std::isfinite(image_mm)))
    throw InputError(file, "gives no image distance, and the lens forms no real image to put the sensor at");
  lens.set_image_distance_mm(image_mm);
  made.notes.push_back(fmt::format(
      "{}: gives no image distance: the sensor is put in the paraxial focus, {:.6g} mm behind the "
      "last surface",
      file, image_mm));
}

}  // namespace

Material bench_material(double nd, double vd, std::size_t surface, std::vector<std::size_t>& no_dispersion) {
  if (nd == 1) return {};
  if (vd > 0) return Material(Material::Model{nd, vd, 0});
  no_dispersion.push_back(surface);
  return Material(Material::Constant{nd});
}

void complete_bench_lens(LensFile& made, const BenchFacts& facts,
                         const std::vector<std::size_t>& no_dispersion, const std::string& file) {
  Lens& lens = made.lens;
  lens.wavelengths_nm = default_wavelengths_nm;
  lens.reference_wavelength_nm = default_reference_wavelength_nm;
  Surface& stop = lens.surfaces[lens.stop_index()];
  if (facts.f_number && *facts.f_number > 0) {
    lens.aperture = {Aperture::Kind::f_number, *facts.f_number};
    stop.semi_diameter_mm.reset();  // of a drawing, and so less exact than the number
  } else if (stop.semi_diameter_mm) {
    lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, *stop.semi_diameter_mm};
  } else {
    throw InputError(file, "says neither an f-number nor how wide the stop is");
  }
  if (facts.full_angle_deg && *facts.full_angle_deg > 0) {
    const double half_deg = *facts.full_angle_deg / 2;
    lens.fields = {Fields::Kind::angle_deg, {0, half_deg / 2, 0.7 * half_deg, half_deg}};
  } else if (facts.image_circle_mm && *facts.image_circle_mm > 0) {
    const double height_mm = *facts.image_circle_mm / 2;
    lens.fields = {Fields::Kind::real_image_height_mm, {0, height_mm / 2, 0.7 * height_mm, height_mm}};
  }
  if (facts.unfocused) focus(made, file);
  require_valid(lens, file);
  if (!no_dispersion.empty())
    made.notes.push_back(fmt::format("{}: surface{} {} {} no Abbe number: one index for all wavelengths",
                                     file, no_dispersion.size() == 1 ? "" : "s",
                                     fmt::join(no_dispersion, ", "),
                                     no_dispersion.size() == 1 ? "has" : "have"));
}

}  // namespace petzval
