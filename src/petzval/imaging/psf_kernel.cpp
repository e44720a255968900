// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/otf_interpolation.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

/// Distance from the chief ray to the farthest sample that holds light [µm].
double reach_um(const Psf& psf) {
  int farthest_squared = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const int t = i - psf.size / 2, s = j - psf.size / 2;
      if (psf.at(i, j) != 0.0F) farthest_squared = std::max(farthest_squared, t * t + s * s);
    }
  return std::sqrt(double(farthest_squared)) * psf.spacing_um;
}

bool is_mirror_symmetric(const Psf& psf) {
  // A few units in the last place of the brightest sample: what float storage leaves of an exact symmetry.
  const float tolerance = 1e-6F * *std::max_element(psf.values.begin(), psf.values.end());
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j <= psf.size / 2; ++j) {
      const int mirrored =
          2 * (psf.size / 2) - j;  // a window of even size has no partner for its first column
      const float partner = mirrored < psf.size ? psf.at(i, mirrored) : 0.0F;
      if (std::abs(psf.at(i, j) - partner) > tolerance) return false;
    }
  return true;
}

void check(const Psf& psf, double wavelength_nm) {
  const bool whole =
      psf.size > 0 && std::isfinite(psf.spacing_um) && psf.spacing_um > 0 &&
      psf.values.size() == static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size);
  const double sum = whole ? std::accumulate(psf.values.begin(), psf.values.end(), 0.0) : 0.0;
  if (!(sum > 0) || !std::isfinite(sum))
    throw InputError(
        fmt::format("the lens data table holds a PSF at {} nm that is empty, dark or damaged; "
                    "samples of sum 1 at a positive spacing are right",
                    wavelength_nm));
}

/// The two table wavelengths about λ and their weights; one of them where λ meets it. A table of one
/// wavelength serves the same surroundings as RadialProfiles::at_wavelength() says.
std::vector<std::pair<std::size_t, double>> bracketing(const std::vector<double>& table_nm,
                                                       double wavelength_nm) {
  constexpr double around_single_nm = 0.5;
  const double around = table_nm.size() == 1 ? around_single_nm : 0;
  if (table_nm.empty() ||
      !(wavelength_nm >= table_nm.front() - around && wavelength_nm <= table_nm.back() + around))
    throw InputError(fmt::format("{} nm lies outside the lens data table, which covers {} to {} nm",
                                 wavelength_nm, table_nm.empty() ? 0.0 : table_nm.front(),
                                 table_nm.empty() ? 0.0 : table_nm.back()));
  if (table_nm.size() == 1) return {{0, 1.0}};
  const std::size_t i = bracket(table_nm, wavelength_nm);
  const double t = (wavelength_nm - table_nm[i]) / (table_nm[i + 1] - table_nm[i]);
  if (t == 0) return {{i, 1.0}};
  if (t == 1) return {{i + 1, 1.0}};
  return {{i, 1 - t}, {i + 1, t}};
}

}  // namespace

PsfField::PsfField(const LensDataTable& table, double wavelength_nm, double cell_um,
                   PsfInterpolation interpolation)
    : cell_um_(cell_um), interpolation_(interpolation) {
  constexpr double max_radius = 2000;  // beyond it a single kernel would take minutes and 128 MB
  for (const auto& [wavelength, weight] : bracketing(table.wavelengths_nm, wavelength_nm)) {
    Layer layer;
    layer.weight = weight;
    for (std::size_t field = 0; field < table.fields.size(); ++field) {
      const Psf& psf = table.psf.at(table.index(field, wavelength));
      check(psf, table.wavelengths_nm[wavelength]);
      const double radius = std::ceil((reach_um(psf) + psf.spacing_um / 2) / cell_um);
      if (!(radius <= max_radius))
        throw InputError(
            fmt::format("a PSF reaches {} µm, {} cells of {} µm: at most {} cells are right; a larger "
                        "pitch or less supersampling helps",
                        reach_um(psf), radius, cell_um, max_radius));
      radius_ = std::max(radius_, static_cast<int>(radius));
      mirror_symmetric_ = mirror_symmetric_ && is_mirror_symmetric(psf);
      least_captured_ = std::min(least_captured_, psf.captured);
      layer.height_mm.push_back(table.real_image_height_mm.at(table.index(field, wavelength)));
      layer.psfs.emplace_back(psf);
    }
    if (layer.psfs.empty()) throw InputError("the lens data table has no fields");
    layers_.push_back(std::move(layer));
  }
}

double PsfField::deposited_samples() const {
  double samples = 0;
  for (const Layer& layer : layers_) {
    const RunningPsf& psf = layer.psfs[layer.psfs.size() / 2];
    samples += 2.0 * psf.size() * psf.size();
  }
  return samples;
}

Kernel PsfField::kernel_at(double x_mm, double y_mm) const {
  const double height_mm = std::hypot(x_mm, y_mm);
  const std::array<double, 2> direction =
      height_mm > 0 ? std::array{x_mm / height_mm, y_mm / height_mm} : std::array{0.0, 1.0};
  Kernel kernel = interpolation_ == PsfInterpolation::psf ? interpolated_psf(direction, height_mm)
                                                          : interpolated_otf(direction, height_mm);
  const double sum = kernel.sum();
  for (double& weight : kernel.weights) weight /= sum;
  const std::array<double, 2> wanted = centroid_at(direction, height_mm), deposited = kernel.centroid();
  kernel.shift({wanted[0] - deposited[0], wanted[1] - deposited[1]});
  return kernel;
}

std::array<double, 2> PsfField::centroid_at(const std::array<double, 2>& direction, double height_mm) const {
  double light = 0, moment_s_um = 0, moment_t_um = 0;
  for (const Layer& layer : layers_) {
    const Pair pair = pair_at(layer, height_mm);
    const double high = layer.weight * pair.weight_high;
    for (const auto& [psf, weight] : {std::pair{pair.low, layer.weight - high}, {pair.high, high}}) {
      light += weight * psf->sum();
      moment_s_um += weight * psf->first_moment_um()[0];
      moment_t_um += weight * psf->first_moment_um()[1];
    }
  }
  // Picture columns run along −x', rows along +y'.
  const double s = moment_s_um / (light * cell_um_), t = moment_t_um / (light * cell_um_);
  return {-direction[0] * t - direction[1] * s, direction[1] * t - direction[0] * s};
}

PsfField::Pair PsfField::pair_at(const Layer& layer, double height_mm) {
  if (layer.psfs.size() == 1) return {&layer.psfs[0], &layer.psfs[0], 0};
  const std::size_t i = bracket(layer.height_mm, height_mm);
  const double span = layer.height_mm[i + 1] - layer.height_mm[i];
  return {&layer.psfs[i], &layer.psfs[i + 1], std::clamp((height_mm - layer.height_mm[i]) / span, 0.0, 1.0)};
}

Kernel PsfField::interpolated_psf(const std::array<double, 2>& direction, double height_mm) const {
  Kernel kernel(radius_);
  for (const Layer& layer : layers_) {
    const Pair pair = pair_at(layer, height_mm);
    const double high = layer.weight * pair.weight_high;
    const std::array<WeightedPsf, 2> both{{{pair.low, layer.weight - high}, {pair.high, high}}};
    if (pair.low->same_grid(*pair.high)) {
      deposit(both, direction, cell_um_, kernel);
    } else {
      deposit({&both[0], 1}, direction, cell_um_, kernel);
      deposit({&both[1], 1}, direction, cell_um_, kernel);
    }
  }
  return kernel;
}

Kernel PsfField::interpolated_otf(const std::array<double, 2>& direction, double height_mm) const {
  const auto kernel_of = [&](const RunningPsf* psf) {
    Kernel kernel(radius_);
    const WeightedPsf whole{psf, 1};
    deposit({&whole, 1}, direction, cell_um_, kernel);
    return kernel;
  };
  std::vector<Kernel> of_layers;
  for (const Layer& layer : layers_) {
    const Pair pair = pair_at(layer, height_mm);
    const Kernel low = kernel_of(pair.low), high = kernel_of(pair.high);
    of_layers.push_back(between_otfs(low, high, pair.weight_high));
  }
  return of_layers.size() == 1 ? of_layers[0] : between_otfs(of_layers[0], of_layers[1], layers_[1].weight);
}

}  // namespace petzval
