// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/iset_transfer.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/ray_transfer.h>

#include <nlohmann/json.hpp>

namespace petzval {

namespace {

std::string iset_list(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(number_text(number));
  return fmt::format("[{}]", fmt::join(texts, ","));
}

std::string polynomial_text(const char* name, const std::vector<std::array<int, 3>>& terms,
                            const std::vector<double>& coefficients) {
  std::vector<double> kept, powers[3];
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (coefficients[i] == 0) continue;
    kept.push_back(coefficients[i]);
    for (std::size_t v = 0; v < 3; ++v) powers[v].push_back(terms[i][v]);
  }
  if (kept.empty()) {
    kept = {0};
    for (std::vector<double>& list : powers) list = {0};
  }
  return fmt::format(
      "    {{\"outputname\": \"{}\", \"coeff\": {}, \"termr\": {}, \"termdx\": {}, \"termdy\": {}}}", name,
      iset_list(kept), iset_list(powers[0]), iset_list(powers[1]), iset_list(powers[2]));
}

std::string iset_band_text(const RayTransfer& transfer, const RayTransfer::Band& band) {
  const RayTransfer::Ellipses& e = *band.ellipses;
  const std::vector<double> zeros(e.positions_mm.size(), 0.0);
  std::string text = fmt::format(
      "  {{\"wavelength_nm\": {},\n   \"passnopass\": {{\"method\": \"minimalellipse\", \"positions\": {}, "
      "\"radiiX\": {}, \"radiiY\": {}, \"centersX\": {}, \"centersY\": {}, \"intersectPlaneDistance\": "
      "{}}},\n"
      "   \"poly\": [\n",
      number_text(band.wavelength_nm), iset_list(e.positions_mm), iset_list(e.radius_x_mm),
      iset_list(e.radius_y_mm), iset_list(zeros), iset_list(e.centre_y_mm), number_text(e.plane_mm));
  text += polynomial_text("outx", transfer.terms, band.coefficients[0]) + ",\n";
  text += polynomial_text("outy", transfer.terms, band.coefficients[1]) + ",\n";
  text += polynomial_text("outz", {{0, 0, 0}}, {0}) + ",\n";
  text += polynomial_text("outdx", transfer.terms, band.coefficients[2]) + ",\n";
  text += polynomial_text("outdy", transfer.terms, band.coefficients[3]) + ",\n";
  text += polynomial_text("outdz", {{0, 0, 0}}, {1});
  return text + "]}";
}

}  // namespace

std::string iset_transfer_text(const Lens& lens) {
  if (!lens.surfaces.front().transfer)
    throw InputError(
        "ISET's ray-transfer files hold a lens known by its ray transfer; one fitted to this lens would be "
        "right");
  const RayTransfer transfer = turned_form(*lens.surfaces.front().transfer);
  std::vector<std::string> bands;
  for (const RayTransfer::Band& band : transfer.bands) bands.push_back(iset_band_text(transfer, band));
  // The planes are ours to choose: the lens lies between them, and they touch it.
  return fmt::format(
      "{{\"description\": {},\n \"name\": {},\n \"thickness\": {},\n \"planeoffsetoutput\": 0,\n "
      "\"planeoffsetinput\": 0,\n \"useDZpolynomial\": false,\n \"polynomials\": [\n{}]}}\n",
      nlohmann::json(lens.source).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      nlohmann::json(lens.name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      number_text(transfer.length_mm), fmt::join(bands, ",\n"));
}

}  // namespace petzval
