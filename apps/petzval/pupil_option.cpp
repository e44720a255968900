// SPDX-License-Identifier: BSD-3-Clause
#include "pupil_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

namespace petzval::app {

namespace {

constexpr std::size_t largest_file = 1 << 20;

template <typename Number>
bool whole(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

using Complain = std::function<void(const std::string& what)>;

void put(std::vector<double>& coefficients, ZernikeOrder order, std::string_view index_text,
         std::string_view value_text, const Complain& complain) {
  int index = 0;
  double value = 0;
  if (!whole(index_text, index) || !whole(value_text, value) || !std::isfinite(value))
    return complain(
        fmt::format("\"{}\" and \"{}\": the number of a Zernike term and its coefficient are right",
                    quotable(index_text), quotable(value_text)));
  try {
    zernike_term(order, index);
  } catch (const InputError& error) {
    return complain(error.what());
  }
  const auto at = static_cast<std::size_t>(index - 1);
  if (at >= coefficients.size()) coefficients.resize(at + 1);
  if (coefficients[at] != 0) return complain(fmt::format("Zernike term {} is given twice", index));
  coefficients[at] = value;
}

/// "4=0.25,7=-0.1".
std::vector<double> from_list(const std::string& text, ZernikeOrder order) {
  std::vector<double> coefficients;
  const Complain complain = [&](const std::string& what) {
    throw InputError(fmt::format("--zernike {}: {}", quotable(text), what));
  };
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    const std::string_view part(text.data() + from, end - from);
    const std::size_t sign = part.find('=');
    if (sign == part.npos) complain("TERM=COEFFICIENT with commas between, or a file, would be right");
    put(coefficients, order, part.substr(0, sign), part.substr(sign + 1), complain);
    from = end + 1;
  }
  return coefficients;
}

/// Lines of a term and its coefficient, a comma or blanks between; # begins a comment.
std::vector<double> from_file(const std::string& path, ZernikeOrder order) {
  std::vector<double> coefficients;
  for (const TextLine& line : text_lines(decoded_text(read_whole_file(path, largest_file)))) {
    std::string text = line.text.substr(0, line.text.find('#'));
    std::replace(text.begin(), text.end(), ',', ' ');
    const std::vector<std::string> words = split_words(text);
    if (words.empty()) continue;
    const Complain complain = [&](const std::string& what) { throw InputError(path, line.number, what); };
    if (words.size() != 2)
      complain(fmt::format("\"{}\": a term and its coefficient, as in \"4 0.25\", are right",
                           quotable(line.text)));
    put(coefficients, order, words[0], words[1], complain);
  }
  if (coefficients.empty()) throw InputError(path, "no Zernike coefficient");
  return coefficients;
}

}  // namespace

void PupilChoice::add_to(CLI::App& command) {
  command.add_option("--w020", w020, "Defocus at the rim of the pupil [waves of the first wavelength]");
  command.add_option("--w040", w040, "Spherical aberration at the rim [waves]");
  command.add_option("--w060", w060, "Term in the sixth power of the radius [waves]");
  command.add_option("--w080", w080, "Term in the eighth power of the radius [waves]");
  command.add_option("--zernike", zernike,
                     "Zernike coefficients: TERM=COEFFICIENT,... or a file of lines TERM COEFFICIENT");
  command.add_option("--zernike-order", zernike_order, "Which set: fringe (rim 1) or noll (RMS 1)")
      ->check(CLI::IsMember({"fringe", "noll"}))
      ->capture_default_str();
  command
      .add_option("--zernike-unit", zernike_unit,
                  "Unit of the coefficients: waves (of the first wavelength) or um")
      ->check(CLI::IsMember({"waves", "um"}))
      ->capture_default_str();
  command.add_option("--obstruction", obstruction, "Radius of a central obstruction over the pupil's");
  command.add_option("--blades", blades,
                     "Number of aperture blades; their corners lie on the pupil's circle");
  command.add_option("--blade-rotation", blade_rotation_deg,
                     "Direction of a corner [degrees, +x' towards +y']");
  command.add_option("--blade-curvature", blade_curvature,
                     "Curvature of the blades' edges over the circle's: 0 straight, 1 round");
}

GeneralPupil PupilChoice::at(double wavelength_nm) const {
  if (blades == 0 && (blade_rotation_deg != 0 || blade_curvature != 0))
    throw InputError("--blade-rotation and --blade-curvature belong to --blades");
  GeneralPupil pupil;
  pupil.shape = {blades, blade_rotation_deg * pi / 180, blade_curvature, obstruction};
  pupil.w_waves = {w020.value_or(0), w040.value_or(0), w060.value_or(0), w080.value_or(0)};
  pupil.order = zernike_order == "noll" ? ZernikeOrder::noll : ZernikeOrder::fringe;
  if (!zernike.empty()) {
    pupil.zernike_waves = zernike.find('=') != std::string::npos ? from_list(zernike, pupil.order)
                                                                 : from_file(zernike, pupil.order);
    if (zernike_unit == "um")
      for (double& value : pupil.zernike_waves) value *= 1e3 / wavelength_nm;
  }
  pupil.validate();
  return pupil;
}

}  // namespace petzval::app
