// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/iset_transfer.h>
#include <petzval/lens/lens_fault.h>
#include <petzval/lens/ray_transfer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace petzval {

namespace {

using Powers = std::array<int, 3>;
/// One polynomial: its coefficients by the powers of r, dx and dy.
using Polynomial = std::map<Powers, double>;

/// A number by itself is a list of one: so MATLAB writes them.
std::vector<double> numbers_of(const JsonEntry& entry, const char* meaning) {
  if (!entry.is_list()) return {entry.number(meaning)};
  std::vector<double> numbers;
  for (const JsonEntry& item : entry.items(meaning)) numbers.push_back(item.number(meaning));
  return numbers;
}

Polynomial read_polynomial(const JsonEntry& entry) {
  entry.allow_only({"outputname", "coeff", "termr", "termdx", "termdy"});
  const std::vector<double> coefficients = numbers_of(entry.at("coeff"), "a list of coefficients");
  std::array<std::vector<double>, 3> powers;
  constexpr const char* keys[] = {"termr", "termdx", "termdy"};
  for (std::size_t v = 0; v < 3; ++v) {
    const JsonEntry list = entry.at(keys[v]);
    powers[v] = numbers_of(list, "a list of powers");
    if (powers[v].size() != coefficients.size())
      list.fail(fmt::format("has {} powers for {} coefficients", powers[v].size(), coefficients.size()));
    for (const double power : powers[v])
      if (!(power >= 0 && power < 100) || power != std::floor(power))
        list.fail("must hold powers, whole numbers from 0 up");
  }
  Polynomial polynomial;
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    polynomial[{static_cast<int>(powers[0][i]), static_cast<int>(powers[1][i]),
                static_cast<int>(powers[2][i])}] += coefficients[i];
  return polynomial;
}

RayTransfer::Ellipses read_ellipses(const JsonEntry& entry) {
  const JsonEntry method = entry.at("method");
  if (method.text("a text") != "minimalellipse")
    method.fail("must be \"minimalellipse\"; other ways to say what passes are not read");
  RayTransfer::Ellipses ellipses;
  ellipses.positions_mm = numbers_of(entry.at("positions"), "a list of places in mm");
  ellipses.radius_x_mm = numbers_of(entry.at("radiiX"), "a list of radii in mm");
  ellipses.radius_y_mm = numbers_of(entry.at("radiiY"), "a list of radii in mm");
  ellipses.centre_y_mm = numbers_of(entry.at("centersY"), "a list of places in mm");
  ellipses.plane_mm = entry.at("intersectPlaneDistance").number("a distance in mm");
  if (ellipses.positions_mm.size() < 2)
    entry.at("positions").fail("has fewer than two places; the domain is empty");
  // A round lens has its ellipses on the meridian, and on the axis a circle about it.
  if (!ellipses.centre_y_mm.empty()) ellipses.centre_y_mm.front() = 0;
  if (!ellipses.radius_x_mm.empty() && !ellipses.radius_y_mm.empty()) {
    double &x = ellipses.radius_x_mm.front(), &y = ellipses.radius_y_mm.front();
    if (x > 0 && y > 0) x = y = std::sqrt(x * y);
  }
  return ellipses;
}

struct IsetBand {
  double wavelength_nm = 0;
  std::map<std::string, Polynomial> polynomials;
  RayTransfer::Ellipses ellipses;
};

IsetBand read_band(const JsonEntry& entry) {
  IsetBand band;
  band.wavelength_nm = entry.at("wavelength_nm").number("a wavelength in nm");
  for (const JsonEntry& each : entry.at("poly").items("a list of polynomials")) {
    const JsonEntry name = each.at("outputname");
    if (!band.polynomials.emplace(name.text("the name of an output"), read_polynomial(each)).second)
      name.fail("is a second polynomial of that name");
  }
  for (const char* needed : {"outx", "outy", "outz", "outdx", "outdy"})
    if (!band.polynomials.count(needed))
      entry.at("poly").fail(fmt::format("has no polynomial \"{}\"", needed));
  band.ellipses = read_ellipses(entry.at("passnopass"));
  return band;
}

/// Rays are left on one plane: what moves along the axis by more is refused [mm].
constexpr double plane_tolerance_mm = 1e-3;

void require_plane(const IsetBand& band, double offset_mm, const JsonEntry& entry) {
  const Powers constant{0, 0, 0};
  double largest = 0;
  const double radius = band.ellipses.positions_mm.back();
  for (const auto& [powers, coefficient] : band.polynomials.at("outz")) {
    const double at_edge = std::abs(coefficient) * std::pow(radius, powers[0]);
    if (powers != constant) largest = std::max(largest, at_edge);
  }
  if (largest > plane_tolerance_mm)
    entry.at("poly").fail(
        fmt::format("has an \"outz\" that moves by {:.3g} mm; rays that leave on one plane, "
                    "{:g} mm in front of the lens, are read",
                    largest, offset_mm));
}

std::vector<std::array<int, 3>> terms_of(const std::vector<IsetBand>& bands) {
  std::map<Powers, bool> all;
  for (const IsetBand& band : bands)
    for (const char* name : {"outx", "outy", "outdx", "outdy"})
      for (const auto& [powers, unused] : band.polynomials.at(name)) all[powers] = true;
  std::vector<std::array<int, 3>> terms;
  for (const auto& [powers, unused] : all) terms.push_back(powers);
  return terms;
}

/// The table goes on for one more step: the film's corner often lies just beyond it.
double reach_mm(const RayTransfer::Ellipses& ellipses) {
  const std::vector<double>& at = ellipses.positions_mm;
  return 2 * at.back() - at[at.size() - 2];
}

std::shared_ptr<const RayTransfer> transfer_of(std::vector<IsetBand> bands, double length_mm) {
  RayTransfer transfer;
  transfer.length_mm = length_mm;
  transfer.variables = TransferVariables::turned;
  std::sort(bands.begin(), bands.end(),
            [](const IsetBand& a, const IsetBand& b) { return a.wavelength_nm < b.wavelength_nm; });
  transfer.terms = terms_of(bands);
  transfer.aperture_radii_mm = {
      bands.front().ellipses.radius_x_mm.empty() ? 0.0 : bands.front().ellipses.radius_x_mm.front()};
  if (!(transfer.aperture_radii_mm.front() > 0))
    throw InputError("its domain is empty: no ray of the axis passes");
  for (const IsetBand& from : bands) {
    RayTransfer::Band band{from.wavelength_nm, {}, from.ellipses};
    for (const char* name : {"outx", "outy", "outdx", "outdy"}) {
      std::vector<double> coefficients;
      const Polynomial& polynomial = from.polynomials.at(name);
      for (const Powers& powers : transfer.terms) {
        const auto found = polynomial.find(powers);
        // The ray along the axis stays there, whatever constant a fit has left.
        const bool constant = powers == Powers{0, 0, 0};
        coefficients.push_back(found == polynomial.end() || constant ? 0 : found->second);
      }
      band.coefficients.push_back(std::move(coefficients));
    }
    transfer.largest_radius_mm = std::max(transfer.largest_radius_mm, reach_mm(from.ellipses));
    transfer.bands.push_back(std::move(band));
  }
  return made_ready(std::move(transfer));
}

std::string transfer_label(const JsonEntry& top, const char* key) {
  const auto entry = top.find(key);
  return entry ? trimmed(entry->text("a text")) : "";
}

Lens lens_of(const std::shared_ptr<const RayTransfer>& transfer) {
  Lens lens;
  Surface front, rear;
  front.thickness_mm = transfer->length_mm;
  front.stop = true;
  front.semi_diameter_mm = transfer->aperture_radii_mm.front();
  front.transfer = transfer;
  rear.thickness_mm = 1;  // until the focus is known
  rear.semi_diameter_mm = transfer->largest_radius_mm;
  lens.surfaces = {front, rear};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, transfer->aperture_radii_mm.front()};
  lens.wavelengths_nm.clear();
  for (const RayTransfer::Band& band : transfer->bands) lens.wavelengths_nm.push_back(band.wavelength_nm);
  lens.reference_wavelength_nm = lens.wavelengths_nm[lens.wavelengths_nm.size() / 2];
  const double edge_mm = transfer->bands.front().ellipses->positions_mm.back();
  lens.fields = {Fields::Kind::paraxial_image_height_mm, {0, 0.5 * edge_mm, 0.7 * edge_mm, 0.9 * edge_mm}};
  return lens;
}

}  // namespace

bool is_iset_transfer(const JsonDocument& document) {
  const auto& root = document.root();
  return root.is_object() && !root.contains("format") && root.contains("polynomials");
}

LensFile read_iset_transfer(const JsonDocument& document) {
  const JsonEntry top(document);
  top.allow_only({"description", "name", "thickness", "planeoffsetoutput", "planeoffsetinput",
                  "useDZpolynomial", "polynomials"});
  if (const auto dz = top.find("useDZpolynomial"); dz && !dz->is_null() && dz->truth())
    dz->fail("must be false: directions are read by their dx and dy");
  const double front_mm = top.at("planeoffsetoutput").number("a distance in mm");
  const double length_mm = front_mm + top.at("thickness").number("a distance in mm") +
                           top.at("planeoffsetinput").number("a distance in mm");
  std::vector<IsetBand> bands;
  for (const JsonEntry& entry : top.at("polynomials").items("a list of wavelengths with their polynomials")) {
    bands.push_back(read_band(entry));
    require_plane(bands.back(), front_mm, entry);
  }
  if (bands.empty()) top.at("polynomials").fail("is empty; a lens has them for one wavelength at least");
  LensFile file;
  try {
    file.lens = lens_of(transfer_of(std::move(bands), length_mm));
  } catch (const InputError& error) {
    document.fail("", error.what());
  }
  Lens& lens = file.lens;
  lens.name = transfer_label(top, "name");
  lens.source = transfer_label(top, "description");
  if (const auto fault = find_fault(lens))
    document.fail("", fmt::format("{} {}", fault->path, fault->message));
  const double image_mm = first_order(lens).paraxial_image_mm;
  if (!(image_mm > 0 && std::isfinite(image_mm)))
    document.fail("", fmt::format("its paraxial image of infinity lies {:.6g} mm behind its input plane; a "
                                  "plane in front of the image would be right",
                                  image_mm));
  lens.surfaces.back().thickness_mm = image_mm;
  file.notes.push_back(
      fmt::format("the sensor stands in the paraxial image of infinity, {:.6g} mm behind the "
                  "input plane",
                  image_mm));
  if (lens.wavelengths_nm.size() == 1)
    file.notes.push_back(
        fmt::format("known at {:g} nm alone, and taken for all wavelengths", lens.wavelengths_nm.front()));
  return file;
}

}  // namespace petzval
