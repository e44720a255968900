// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/formats/retired_glasses.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>

namespace petzval {

namespace {

/// nd and Vd, most of them of SCHOTT's catalogue as Robb and Mercado fitted it (Calculation of refractive
/// indices using Buchdahl's chromatic coordinate, Appl. Opt. 22 (1983) 1198, table V): the test holds the two
/// against each other. Of others, and of those that are later:
/// B270 and F_SILICA are as Zemax's catalogues MISC and INFRARED have them, SF56A is from SCHOTT's .agf of
/// 2013, KZFS4 from Hikari's (table V has another maker's). BASF64A, LASFN31, PSK53A and SFL56 differ from
/// their successors by less than 5e-5 from 450 to 650 nm (SCHOTT's .agf of June 2025, as the package
/// @isaac/glass-catalog compares it). Of LAFN21, SF64A and SFL4 a list of SCHOTT's old glasses at 587.6 nm
/// has nd alone; their Vd is not known. WATER is pure at 20 °C (Daimon and Masumura, Appl. Opt. 46 (2007)
/// 3811), SEAWATER has 35 per mille of salt (Quan and Fry, Appl. Opt. 34 (1995) 3477), both against air.
/// POLYSTYR is as Sultanova, Kasarova and Nikolov measured it (Acta Phys. Pol. A 116 (2009) 585, table I),
/// S-LAL21 as OHARA's catalogue has it.
constexpr RetiredGlass retired[] = {
    {"B270", 1.52308, 58.57, ""},
    {"BAF10", 1.67003, 47.11, "SCHOTT:N-BAF10"},
    {"BAF4", 1.60562, 43.93, "SCHOTT:N-BAF4"},
    {"BAF51", 1.65224, 44.93, "SCHOTT:N-BAF51"},
    {"BAF52", 1.60859, 46.44, "SCHOTT:N-BAF52"},
    {"BAFN10", 1.67003, 47.11, "SCHOTT:N-BAF10"},
    {"BAK1", 1.57250, 57.55, "SCHOTT:N-BAK1"},
    {"BAK2", 1.53996, 59.71, "SCHOTT:N-BAK2"},
    {"BAK4", 1.56883, 56.13, "SCHOTT:N-BAK4"},
    {"BALF4", 1.57957, 53.71, "SCHOTT:N-BALF4"},
    {"BALF5", 1.54739, 53.63, "SCHOTT:N-BALF5"},
    {"BASF2", 1.66446, 35.83, "SCHOTT:N-BASF2"},
    {"BASF64A", 1.70400, 39.38, "SCHOTT:N-BASF64"},
    {"BK1", 1.51009, 63.41, ""},
    {"BK10", 1.49782, 66.95, "SCHOTT:N-BK10"},
    {"BK7", 1.51680, 64.17, "SCHOTT:N-BK7"},
    {"F15", 1.60565, 37.83, ""},
    {"FDS9", 1.84666, 23.86, "HOYA:FDS90"},
    {"FK5", 1.48749, 70.41, "SCHOTT:N-FK5"},
    {"FK51", 1.48656, 84.47, "SCHOTT:N-FK51"},
    {"FK54", 1.43700, 90.66, ""},
    {"FSILICA", 1.45846, 67.82, "MISC:SILICA"},
    {"FUSEDSILICA", 1.45846, 67.82, "MISC:SILICA"},
    {"K5", 1.52249, 59.48, "SCHOTT:N-K5"},
    {"KF9", 1.52341, 51.49, "SCHOTT:N-KF9"},
    {"KZFS4", 1.61340, 44.30, "SCHOTT:N-KZFS4"},
    {"KZFSN5", 1.65412, 39.63, "SCHOTT:N-KZFS5"},
    {"LAF2", 1.74400, 44.72, "SCHOTT:N-LAF2"},
    {"LAF3", 1.71700, 47.96, "SCHOTT:N-LAF3"},
    {"LAFN21", 1.78831, 0, "SCHOTT:N-LAF21"},
    {"LAK10", 1.72000, 50.41, "SCHOTT:N-LAK10"},
    {"LAK14", 1.69680, 55.58, "SCHOTT:N-LAK14"},
    {"LAK21", 1.64049, 60.10, "SCHOTT:N-LAK21"},
    {"LAK8", 1.71300, 53.83, "SCHOTT:N-LAK8"},
    {"LAK9", 1.69100, 54.71, "SCHOTT:N-LAK9"},
    {"LAKN12", 1.67790, 55.20, "SCHOTT:N-LAK12"},
    {"LAKN14", 1.69680, 55.41, "SCHOTT:N-LAK14"},
    {"LAKN22", 1.65113, 55.89, "SCHOTT:N-LAK22"},
    {"LAKN7", 1.65160, 58.52, "SCHOTT:N-LAK7"},
    {"LASF9", 1.85025, 32.17, "SCHOTT:N-LASF9"},
    {"LASFN31", 1.88067, 41.01, "SCHOTT:N-LASF31"},
    {"NBFD5", 1.76200, 40.32, ""},
    {"POLYSTYR", 1.59200, 30.50, ""},
    {"PSK3", 1.55232, 63.46, "SCHOTT:N-PSK3"},
    {"PSK53A", 1.62014, 63.48, "SCHOTT:N-PSK53"},
    {"SEAWATER", 1.33910, 54.90, ""},
    {"SF19", 1.66680, 33.01, "SCHOTT:N-SF19"},
    {"SF3", 1.74000, 28.20, ""},
    {"SF56A", 1.78470, 26.08, "SCHOTT:N-SF56"},
    {"SF64A", 1.70585, 0, "SCHOTT:N-SF64"},
    {"SF8", 1.68893, 31.18, "SCHOTT:N-SF8"},
    {"SFL4", 1.75520, 0, "SCHOTT:N-SF4"},
    {"SFL56", 1.78470, 26.08, "SCHOTT:N-SF56"},
    {"SK1", 1.61025, 56.71, ""},
    {"SK10", 1.62280, 56.90, "SCHOTT:N-SK10"},
    {"SK11", 1.56384, 60.80, "SCHOTT:N-SK11"},
    {"SK14", 1.60311, 60.60, "SCHOTT:N-SK14"},
    {"SK15", 1.62299, 58.06, "SCHOTT:N-SK15"},
    {"SK16", 1.62041, 60.33, "SCHOTT:N-SK16"},
    {"SK19", 1.61342, 57.41, ""},
    {"SK2", 1.60738, 56.65, "SCHOTT:N-SK2"},
    {"SK4", 1.61272, 58.63, "SCHOTT:N-SK4"},
    {"SK5", 1.58913, 61.27, "SCHOTT:N-SK5"},
    {"SLAL21", 1.70300, 52.38, ""},
    {"SSK2", 1.62230, 53.16, "SCHOTT:N-SSK2"},
    {"SSK4", 1.61765, 55.14, ""},
    {"SSKN5", 1.65844, 50.88, "SCHOTT:N-SSK5"},
    {"SSKN8", 1.61772, 49.77, "SCHOTT:N-SSK8"},
    {"UBK7", 1.51680, 64.29, "SCHOTT:N-BK7"},
    {"WATER", 1.33304, 55.75, ""},
    {"ZKN7", 1.50847, 61.19, "SCHOTT:N-ZK7"},
};

}  // namespace

std::span<const RetiredGlass> retired_glasses() {
  return retired;
}

std::optional<RetiredGlass> find_retired_glass(std::string_view name) {
  std::string plain;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      plain += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto found = std::find_if(std::begin(retired), std::end(retired),
                                  [&](const RetiredGlass& glass) { return glass.name == plain; });
  return found == std::end(retired) ? std::nullopt : std::optional(*found);
}

}  // namespace petzval
