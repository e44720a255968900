// SPDX-License-Identifier: BSD-3-Clause
// The analyses of a lens, all asked alike: a lens and a request in, tables and plots out.
#pragma once

#include <petzval/analysis/encircled_energy.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/spots.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/analysis/wavefront_zernike.h>
#include <petzval/base/context.h>
#include <petzval/lens/scatter.h>
#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace petzval {

/// What veiling glare is asked.
struct GlareRequest {
  std::optional<Scatter> surfaces_scatter = {};  ///< of surfaces that say nothing themselves
  double hole_percent = 10;  ///< diameter of the black hole's image, of the frame's diagonal
  double surround_deg = 60;  ///< how far the surround reaches from the axis
  bool ghosts = false;       ///< count what surfaces reflect twice, too
};

/// What an analysis is asked. Each takes what it knows of; the rest may stay as it is.
struct AnalysisRequest {
  FieldTableRequest at =
      {};              ///< fields, wavelengths, apertures, losses; lists that are empty: the lens's own
  bool plots = false;  ///< the plots too, which may cost more rays than the tables
  RayWeight spot_weight = RayWeight::stop_area;
  int fan_rays = 21;
  std::optional<FrameSize> frame = {};  ///< of TV distortion; absent: 4:3, to the largest field
  bool opd_fans = false;                ///< plots have the wavefront, not the transverse aberration
  int map_samples = 64;                 ///< a side
  ZernikeOrder zernike_order = ZernikeOrder::fringe;
  int zernike_terms = 0;  ///< 0: 37 of Fringe, 36 of Noll
  MtfOptions mtf = {};  ///< no frequencies: 0 to 100 cycles/mm by 10, or three for curves over field or focus
  bool polychromatic_mtf = false;                   ///< all wavelengths alike, unless `mtf` weighs them
  bool mtf_over_field = false;                      ///< at 21 even fields
  std::optional<double> mtf_through_focus_mm = {};  ///< at 33 sensors up to this far on both sides
  EncircledEnergyOptions encircled_energy = {};
  double sensor_reflectance = 0;      ///< for ghosts: 0: of the sensor there are none
  double source_diameter_deg = 0.53;  ///< of what makes ghosts, as the lens sees it; the Sun's
  int ghost_reflections = 2;          ///< or 4: ghosts of light that is reflected four times, too
  double focus_frequency_cpmm = 40;   ///< of the MTF by which best focus is sought
  GlareRequest glare = {};
};

struct AnalysisTable {
  std::string key;      ///< "rows"
  std::string heading;  ///< what the numbers are, as people read it; may be empty
  Table table;
};

struct AnalysisResult {
  std::string lens;
  Fields::Kind field_kind = Fields::Kind::angle_deg;
  double reference_wavelength_nm = 0;
  /// What else programs may want to know, by its name.
  std::vector<std::pair<std::string, std::variant<std::string, std::vector<double>>>> facts = {};
  std::vector<AnalysisTable> tables = {};
  std::vector<std::string> remarks = {};  ///< lines for people, below the tables
  std::vector<Plot> plots = {};           ///< none unless asked for
  int plots_across = 1;
  std::string plots_title = {};

  /// The table of the analysis itself: that of "rows".
  const Table& rows() const;
};

struct Analysis {
  std::string name;  ///< "encircled-energy", as `petzval lens` has it
  std::string description;
  AnalysisResult (*run)(const Lens& lens, const AnalysisRequest& request, const Context& context);
};

/// All of them. Who adds one adds it here: program and pages take it from there.
std::span<const Analysis> analyses();

/// Runs an analysis by its name, on the lens as a camera uses it.
///
///     const Lens lens = lens_in_use(camera);
///     std::cout << to_text(analyse("spots", lens).rows());
///
/// \throws InputError for a name that there is not, naming those that there are, and as the analysis does.
AnalysisResult analyse(std::string_view name, const Lens& lens, const AnalysisRequest& request = {},
                       const Context& context = {});

}  // namespace petzval
