// SPDX-License-Identifier: BSD-3-Clause
// Ray transfers in the native lens file (docs/RAY_TRANSFER.md).
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/native.h>

#include <cmath>

namespace petzval {

namespace {

constexpr const char* variable_names[] = {"invariants", "turned"};

std::vector<double> transfer_numbers(const JsonEntry& entry) {
  std::vector<double> numbers;
  for (const JsonEntry& item : entry.items("a list of numbers")) numbers.push_back(item.number("a number"));
  return numbers;
}

std::array<int, 3> read_term(const JsonEntry& entry) {
  const std::vector<double> powers = transfer_numbers(entry);
  if (powers.size() != 3) entry.fail("must be three powers, such as [1, 0, 2]");
  std::array<int, 3> term{};
  for (std::size_t v = 0; v < 3; ++v) {
    if (!(powers[v] >= 0 && powers[v] < 100) || powers[v] != std::floor(powers[v]))
      entry.fail("must hold powers, whole numbers from 0 up");
    term[v] = static_cast<int>(powers[v]);
  }
  return term;
}

RayTransfer::Band read_native_band(const JsonEntry& entry) {
  entry.allow_only({"wavelength_nm", "coefficients", "ellipses"});
  RayTransfer::Band band;
  band.wavelength_nm = entry.at("wavelength_nm").number("a wavelength in nm");
  for (const JsonEntry& each : entry.at("coefficients").items("a list of polynomials"))
    band.coefficients.push_back(transfer_numbers(each));
  const auto ellipses = entry.find("ellipses");
  if (!ellipses || ellipses->is_null()) return band;
  ellipses->allow_only({"plane_mm", "positions_mm", "radius_x_mm", "radius_y_mm", "centre_y_mm"});
  band.ellipses = RayTransfer::Ellipses{
      ellipses->at("plane_mm").number("a distance in mm"), transfer_numbers(ellipses->at("positions_mm")),
      transfer_numbers(ellipses->at("radius_x_mm")), transfer_numbers(ellipses->at("radius_y_mm")),
      transfer_numbers(ellipses->at("centre_y_mm"))};
  return band;
}

std::string transfer_list(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(number_text(number));
  return fmt::format("[{}]", fmt::join(texts, ","));
}

std::string native_band_text(const RayTransfer::Band& band) {
  std::vector<std::string> polynomials;
  for (const std::vector<double>& each : band.coefficients) polynomials.push_back(transfer_list(each));
  std::string text = fmt::format("{{\"wavelength_nm\": {}, \"coefficients\": [\n        {}]",
                                 number_text(band.wavelength_nm), fmt::join(polynomials, ",\n        "));
  if (band.ellipses) {
    const RayTransfer::Ellipses& e = *band.ellipses;
    text += fmt::format(
        ",\n       \"ellipses\": {{\"plane_mm\": {}, \"positions_mm\": {}, \"radius_x_mm\": {}, "
        "\"radius_y_mm\": {}, \"centre_y_mm\": {}}}",
        number_text(e.plane_mm), transfer_list(e.positions_mm), transfer_list(e.radius_x_mm),
        transfer_list(e.radius_y_mm), transfer_list(e.centre_y_mm));
  }
  return text + "}";
}

}  // namespace

std::shared_ptr<const RayTransfer> read_transfer(const JsonEntry& entry) {
  entry.allow_only(
      {"length_mm", "unit_mm", "largest_radius_mm", "variables", "apertures_mm", "terms", "bands"});
  RayTransfer transfer;
  transfer.length_mm = entry.at("length_mm").number("a distance in mm");
  transfer.unit_mm = entry.at("unit_mm").number("a length in mm");
  transfer.largest_radius_mm = entry.at("largest_radius_mm").number("a radius in mm");
  const JsonEntry variables = entry.at("variables");
  const std::string name = variables.text("\"invariants\" or \"turned\"");
  if (name != variable_names[0] && name != variable_names[1])
    variables.fail("must be \"invariants\" or \"turned\"");
  transfer.variables = name == variable_names[0] ? TransferVariables::invariants : TransferVariables::turned;
  transfer.aperture_radii_mm = transfer_numbers(entry.at("apertures_mm"));
  for (const JsonEntry& term : entry.at("terms").items("a list of three powers each"))
    transfer.terms.push_back(read_term(term));
  for (const JsonEntry& band : entry.at("bands").items("a list of wavelengths with their polynomials"))
    transfer.bands.push_back(read_native_band(band));
  try {
    return made_ready(std::move(transfer));
  } catch (const InputError& error) {
    entry.fail(fmt::format("cannot be used: {}", error.what()));
  }
}

std::string transfer_text(const RayTransfer& transfer) {
  std::vector<std::string> terms, bands;
  for (const auto& [a, b, c] : transfer.terms) terms.push_back(fmt::format("[{},{},{}]", a, b, c));
  for (const RayTransfer::Band& band : transfer.bands) bands.push_back(native_band_text(band));
  return fmt::format(
      "{{\"length_mm\": {}, \"unit_mm\": {}, \"largest_radius_mm\": {}, \"variables\": \"{}\", "
      "\"apertures_mm\": {},\n      \"terms\": [{}],\n      \"bands\": [{}]}}",
      number_text(transfer.length_mm), number_text(transfer.unit_mm), number_text(transfer.largest_radius_mm),
      variable_names[static_cast<std::size_t>(transfer.variables)], transfer_list(transfer.aperture_radii_mm),
      fmt::join(terms, ","), fmt::join(bands, ",\n      "));
}

}  // namespace petzval
