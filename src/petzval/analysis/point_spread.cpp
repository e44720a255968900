// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/analysis/traced_spot.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/units.h>
#include <petzval/wave/ray_density.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double spacing_per_lambda_n = 0.45;
/// Cells wider than λN/2 hold the sum over samples of this spacing at most, wide ones (as spots of a hundred
/// λN have them) over coarser ones: the error is a few thousandths of the cells' rms, less for wide spots.
constexpr double sample_per_lambda_n = 0.4, coarse_sample_per_lambda_n = 0.6;
constexpr double coarse_cell_lambda_n = 2;
/// Coarse light in windows beyond this has lost the contrast that samples farther apart would mistake.
constexpr double blurred_window_lambda_n = 115;
/// Its samples lie at a sixth of a cell then.
constexpr double samples_a_coarse_cell = 6;
/// Coarse light is that of rays in windows beyond this, and fills so many cells at least.
constexpr double widest_coarse_wave_window_lambda_n = 64;
constexpr int fewest_coarse_cells = 40;
/// Around the ray spot, and at least in all: the square that holds 99 % of an Airy pattern.
constexpr double margin_lambda_n = 12;
constexpr double least_half_width_lambda_n = 18.5;
/// A window that holds too little is widened by this until it does, so many times at most.
constexpr double window_growth = 1.25;
constexpr int most_growths = 8;
constexpr int smallest_size = 32;
constexpr int size_step = 8;
constexpr int scout_radial = 6, scout_azimuths = 24;

/// Extent of the light at the image point.
struct Extent {
  double widest = 0, narrowest = 0;                    ///< of the pupil in direction cosines
  double reach_s_mm = 0, low_t_mm = 0, high_t_mm = 0;  ///< of the rays about the chief ray's image
  double lambda_mm = 0;                                ///< in the image space
  /// In no direction before others: the largest distance of a ray, and the width of an ellipse of the
  /// pupil's moments where it is narrowest; 0: not known.
  double reach_about_mm = 0, narrowest_about = 0;

  double lambda_n_mm() const { return lambda_mm / widest; }
  /// The largest distance of a ray from the chief ray, along s or t.
  double reach_mm() const {
    return narrowest_about > 0 ? reach_about_mm : std::max({reach_s_mm, -low_t_mm, high_t_mm});
  }
  /// How much of a window lies around the rays.
  double margin_mm() const {
    const double airy_mm = lambda_mm / (narrowest_about > 0 ? narrowest_about : narrowest);
    return std::max(margin_lambda_n * airy_mm, least_half_width_lambda_n * airy_mm - reach_mm());
  }
};

Extent extent_of(const SmoothPupil& pupil) {
  return {pupil.widest(), pupil.narrowest(), pupil.reach_s_mm,
          pupil.low_t_mm, pupil.high_t_mm,   pupil.lambda_n_mm() * pupil.widest()};
}

/// The moments of a pupil over its exit directions, as sums over its nodes.
struct PupilMoments {
  double sum = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;

  void add(double weight, double alpha, double beta) {
    sum += weight, a += weight * alpha, b += weight * beta;
    aa += weight * alpha * alpha, ab += weight * alpha * beta, bb += weight * beta * beta;
  }
  /// Of the ellipse that has them; a disk's width is four times its deviation along a direction.
  double narrowest() const {
    const double x = aa / sum - a * a / (sum * sum), y = bb / sum - b * b / (sum * sum),
                 xy = ab / sum - a * b / (sum * sum);
    return 4 * std::sqrt(std::max(0.0, 0.5 * (x + y - std::hypot(x - y, 2 * xy))));
  }
};

/// \param about  the measures that no direction is put before others in, too.
std::optional<Extent> scout(const FieldTracer& tracer, const ChiefRay& chief, bool about = false) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, scout_azimuths);
  if (!pupil) return {};
  std::vector<PupilNode> nodes = pupil_nodes(*pupil, scout_radial);
  for (std::size_t i = 0; i < pupil->own(); ++i)  // the rim itself
    nodes.push_back({pupil->rim(i)[0], pupil->rim(i)[1], 0});
  Extent extent;
  double low = 2, high = -2, left = 2, right = -2;
  PupilMoments moments;
  const std::vector<WaveRay> rays = trace_wave_rays(tracer, chief, *pupil, nodes);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const WaveRay& ray = rays[i];
    if (!ray.passes) continue;
    moments.add(nodes[i].weight, ray.alpha, ray.beta);
    if (pupil->mirrored()) moments.add(nodes[i].weight, -ray.alpha, ray.beta);
    if (about) extent.reach_about_mm = std::max(extent.reach_about_mm, std::hypot(ray.s_mm, ray.t_mm));
    low = std::min(low, ray.beta);
    high = std::max(high, ray.beta);
    left = std::min(left, pupil->mirrored() ? -std::abs(ray.alpha) : ray.alpha);
    right = std::max(right, pupil->mirrored() ? std::abs(ray.alpha) : ray.alpha);
    extent.reach_s_mm = std::max(extent.reach_s_mm, std::abs(ray.s_mm));
    extent.low_t_mm = std::min(extent.low_t_mm, ray.t_mm);
    extent.high_t_mm = std::max(extent.high_t_mm, ray.t_mm);
  }
  const double alpha_width = right - left;
  if (!(high > low) || !(alpha_width > 0)) return {};
  extent.widest = std::max(alpha_width, high - low);
  extent.narrowest = std::min(alpha_width, high - low);
  if (about) extent.narrowest_about = moments.narrowest();
  extent.lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm / tracer.tracer().image_index();
  return extent;
}

/// Nodes that integrate e^{iB…} to rounding: B rad of phase at the rim need B + O(B^⅓) azimuths (the
/// trapezoid rule aliases only the B-th harmonic and above). Along a radius it turns by B, of which
/// Gauss-Legendre nodes need a quarter and O(B^⅓).
int azimuths_for(double phase) {
  return 2 * static_cast<int>(std::ceil(0.5 * (phase + 5 * std::cbrt(phase) + 64)));
}
int radial_for(double phase) {
  return static_cast<int>(std::ceil(0.25 * phase + 3 * std::cbrt(0.5 * phase) + 12));
}

/// How far apart samples of coarse light may lie [λN]. A spectrum that ends at 1/λN, repeated at the samples'
/// frequency, stays clear of what cells can hold.
double coarse_sample_lambda_n(const CoarseLight& coarse, double lambda_n_um, double window_um) {
  if (!coarse.any()) return 0;
  const double cell_lambda_n = coarse.cell_um / lambda_n_um;
  const double clear = coarse.loose() ? 1 / (1 + 1 / cell_lambda_n) : 0;
  return window_um > blurred_window_lambda_n * lambda_n_um
             ? std::max(clear, cell_lambda_n / samples_a_coarse_cell)
             : clear;
}

/// \param coarsest_lambda_n  coarse_sample_lambda_n().
int samples_per_cell(double cell_lambda_n, double coarsest_lambda_n) {
  constexpr double rounding = 1e-9;
  if (cell_lambda_n <= 0.5 + rounding) return 1;
  const double most =
      std::max(cell_lambda_n < coarse_cell_lambda_n ? sample_per_lambda_n : coarse_sample_per_lambda_n,
               coarsest_lambda_n);
  return static_cast<int>(std::ceil(cell_lambda_n / most - rounding));
}

/// About the rays of a chosen window. \param growth  of it.
double margin_mm_of(const Extent& extent, const PsfOptions& options, double growth) {
  return growth * options.margin * extent.margin_mm();
}

PsfPlan plan_window(const Extent& extent, const PsfOptions& options, double margin_mm) {
  const double lambda_n_um = extent.lambda_n_mm() * um_per_mm;
  const double width_um = 2 * (extent.reach_mm() + margin_mm) * um_per_mm;
  const int most = options.size > 0 ? options.size : std::max(options.largest_size, smallest_size);
  PsfPlan plan;
  const double coarse_um = std::min(options.coarse.spacing_um(), width_um / fewest_coarse_cells);
  plan.spacing_um = options.spacing_um > 0
                        ? options.spacing_um
                        : std::max({spacing_per_lambda_n * lambda_n_um, width_um / most, coarse_um});
  if (options.size > 0) {
    plan.size = options.size;
  } else {
    const bool exact = options.exact_window && options.spacing_um == 0;
    const int step = exact ? 2 : size_step;
    const double cells = std::ceil(width_um / plan.spacing_um / step) * step;
    plan.size = static_cast<int>(std::clamp(cells, double(smallest_size), double(most)));
    if (exact) plan.spacing_um = width_um / plan.size;
  }
  plan.samples_per_cell =
      samples_per_cell(plan.spacing_um / lambda_n_um,
                       coarse_sample_lambda_n(options.coarse, lambda_n_um, plan.size * plan.spacing_um));
  plan.last_row = plan.size - 1;
  plan.reach = plan.size / 2;
  if (options.size == 0 || options.spacing_um == 0) {  // a chosen window: no farther than the rays need
    const auto cells = [&](double mm) { return mm * um_per_mm / plan.spacing_um; };
    plan.first_row =
        std::max(0, plan.size / 2 + static_cast<int>(std::floor(cells(extent.low_t_mm - margin_mm))));
    plan.last_row = std::min(
        plan.size - 1, plan.size / 2 + static_cast<int>(std::ceil(cells(extent.high_t_mm + margin_mm))));
    plan.reach = std::min(plan.size / 2, static_cast<int>(std::ceil(cells(extent.reach_s_mm + margin_mm))));
  }
  const double corner_mm = std::sqrt(0.5) * plan.size * plan.spacing_um * mm_per_um;
  const double phase =
      2 * pi / extent.lambda_mm * 0.5 * extent.widest * (corner_mm + std::sqrt(2.0) * extent.reach_mm());
  plan.azimuths = options.azimuths > 0 ? options.azimuths : azimuths_for(phase);
  plan.radial_nodes = options.radial_nodes > 0 ? options.radial_nodes : radial_for(phase);
  return plan;
}

/// The sum over the chords of a smooth pupil, or its rays where the window is wide.
Psf sum_smooth(const SmoothPupil& pupil, const PsfPlan& plan, const PsfOptions& options) {
  const double lambda_n_um = pupil.lambda_n_mm() * um_per_mm;
  const double widest = options.coarse.rays_serve(lambda_n_um) ? widest_coarse_wave_window_lambda_n
                                                               : options.widest_wave_window_lambda_n;
  if (plan.size * plan.spacing_um <= widest * lambda_n_um) return sum_chords(pupil, plan.grid());
  return sum_rays(pupil, plan.grid(), options.coarse.loose() ? 1 : 2);
}

/// The sum over traced nodes in the plan's cells, an odd number of samples a side in each, so that the middle
/// one is at the cell's middle.
Psf sum_nodes(const PupilWaves& waves, const PsfPlan& plan) {
  if (plan.samples_per_cell == 1) return sum_plane_waves(waves, plan.size, plan.spacing_um);
  const int side = plan.samples_per_cell | 1;
  // The middle sample of an odd number of cells is the middle of a cell; where their number is even, the last
  // of them is one too many.
  const Psf fine = sum_plane_waves(waves, (plan.size | 1) * side, plan.spacing_um / side);
  const auto size = static_cast<std::size_t>(plan.size);
  Psf psf;
  psf.size = plan.size;
  psf.spacing_um = plan.spacing_um;
  psf.values.assign(size * size, 0.0F);
  double inside = 0;
  for (int i = 0; i < plan.size * side; ++i)
    for (int j = 0; j < plan.size * side; ++j) {
      psf.values[static_cast<std::size_t>(i / side) * size + static_cast<std::size_t>(j / side)] +=
          fine.at(i, j);
      inside += static_cast<double>(fine.at(i, j));
    }
  psf.captured = fine.captured * inside;
  for (float& value : psf.values) value = static_cast<float>(static_cast<double>(value) / inside);
  return psf;
}

/// Sums in a window that grows until it holds the wanted share, if the window is to be chosen.
/// \param most_margin_mm  of it.
template <class Sum>
std::optional<Psf> sum_in_window(const Extent& extent, const PsfOptions& options, double most_margin_mm,
                                 const Sum& sum) {
  const bool fixed = options.size > 0 && options.spacing_um > 0;
  const auto margin_mm = [&](double growth) {
    return std::min(most_margin_mm, margin_mm_of(extent, options, growth));
  };
  double growth = 1;
  std::optional<Psf> psf = sum(plan_window(extent, options, margin_mm(growth)));
  for (int i = 0; i < most_growths && psf && !fixed && psf->captured < options.wanted_share &&
                  margin_mm(growth) < most_margin_mm;
       ++i) {
    growth *= window_growth;
    psf = sum(plan_window(extent, options, margin_mm(growth)));
  }
  return psf;
}

/// About rays whose waves are summed over nodes: a sliver of a pupil spreads light far across itself, but in
/// windows beyond the widest there is little of it, and rays would leave out all that waves spread. Where
/// the rays themselves reach far, a window is as wide as it is to be, and theirs.
double most_margin_mm_of_nodes(const Extent& extent, const PsfOptions& options) {
  constexpr double before_rounding = 0.95;  // up to whole steps of cells
  const double margin_mm =
      before_rounding * options.widest_node_window_lambda_n * extent.lambda_n_mm() - 2 * extent.reach_mm();
  return margin_mm < margin_lambda_n * extent.lambda_n_mm() ? HUGE_VAL : margin_mm;
}

}  // namespace

double CoarseLight::spacing_um() const {
  return loose() ? cell_um * 2 * std::sqrt(tolerance) : 0;
}

bool CoarseLight::rays_serve(double lambda_n_um) const {
  constexpr double beyond = 2 / (pi * pi);
  return loose() && beyond * lambda_n_um < tolerance * 2 * cell_um;
}

std::optional<PsfPlan> plan_psf(const FieldTracer& tracer, const ChiefRay& chief, const PsfOptions& options) {
  if (const std::optional<Extent> extent = scout(tracer, chief))
    return plan_window(*extent, options, margin_mm_of(*extent, options, 1));
  return {};
}

std::optional<PupilWaves> pupil_waves(const FieldTracer& tracer, const ChiefRay& chief, int radial_nodes,
                                      int azimuths) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, azimuths);
  if (!pupil) return {};
  const std::vector<PupilNode> nodes = pupil_nodes(*pupil, radial_nodes);
  const std::vector<WaveRay> rays = trace_wave_rays(tracer, chief, *pupil, nodes);
  PupilWaves waves;
  waves.mirrored = pupil->mirrored();
  const double own = waves.mirrored ? 0.5 : 1;  // its mirror image has the other half of a node's light
  waves.wavelength_nm = tracer.tracer().wavelength_nm();
  waves.image_index = tracer.tracer().image_index();
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const WaveRay& ray = rays[node];
    if (!ray.passes) continue;
    waves.alpha.push_back(ray.alpha);
    waves.beta.push_back(ray.beta);
    waves.phase_waves.push_back(ray.phase_waves);
    // a dα dβ = T du dv / a.
    const double light = nodes[node].weight * ray.transmittance;
    waves.amplitude.push_back(ray.amplitude > 0 ? own * light / ray.amplitude : 0);
    waves.flux += light;
  }
  if (waves.size() == 0) return {};
  return waves;
}

Psf point_spread(const SmoothPupil& pupil, const PsfOptions& options) {
  return *sum_in_window(extent_of(pupil), options, HUGE_VAL, [&](const PsfPlan& plan) -> std::optional<Psf> {
    return sum_smooth(pupil, plan, options);
  });
}

std::optional<Psf> point_spread(const FieldTracer& tracer, const ChiefRay& chief, const PsfOptions& options) {
  const bool bladed = tracer.tracer().stop_blades().count > 0;
  const bool own_nodes =
      bladed || !tracer.tracer().is_centred() || options.radial_nodes > 0 || options.azimuths > 0;
  if (const auto pupil = own_nodes ? std::nullopt : fit_pupil(tracer, chief))
    return point_spread(*pupil, options);
  const std::optional<Extent> extent = scout(tracer, chief, options.exact_window);
  if (!extent) return {};
  const double most_margin_mm = most_margin_mm_of_nodes(*extent, options);
  return sum_in_window(*extent, options, most_margin_mm, [&](const PsfPlan& plan) -> std::optional<Psf> {
    const double width_mm = plan.size * plan.spacing_um * mm_per_um + 2 * extent->reach_mm();
    if (width_mm > 2 * options.widest_node_window_lambda_n * extent->lambda_n_mm())
      return traced_spot(tracer, chief, plan.grid(), options.spot_radial_nodes);
    const std::optional<PupilWaves> waves = pupil_waves(tracer, chief, plan.radial_nodes, plan.azimuths);
    if (!waves) return {};
    return sum_nodes(*waves, plan);
  });
}

}  // namespace petzval
