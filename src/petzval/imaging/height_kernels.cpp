// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/cell_psf.h>
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/height_kernels.h>
#include <petzval/imaging/otf_interpolation.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

namespace petzval {

namespace {

/// Whether all samples that have a mirrored partner are as bright as it: the first column of a window of even
/// size has none.
bool is_mirror_symmetric(const Psf& psf) {
  // A few units in the last place of the brightest sample: what float storage leaves of an exact symmetry.
  const float tolerance = 1e-6F * *std::max_element(psf.values.begin(), psf.values.end());
  const int middle = psf.size / 2;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 1 - psf.size % 2; j < middle; ++j)
      if (std::abs(psf.at(i, j) - psf.at(i, 2 * middle - j)) > tolerance) return false;
  return true;
}

/// In a window of odd size. The column that had no partner shares its light with one: as a centred lens has
/// it, and as a discrete Fourier transform reads it.
Psf with_partner(const Psf& psf) {
  Psf odd = psf;
  odd.size = psf.size + 1;
  odd.values.clear();
  for (int i = 0; i < psf.size; ++i) {
    const float* row = psf.values.data() + static_cast<std::ptrdiff_t>(i) * psf.size;
    odd.values.push_back(row[0] / 2);
    odd.values.insert(odd.values.end(), row + 1, row + psf.size);
    odd.values.push_back(row[0] / 2);
  }
  odd.values.resize(static_cast<std::size_t>(odd.size) * static_cast<std::size_t>(odd.size));
  return odd;
}

/// The fields between which PSFs are mixed: all of a table from a file.
std::vector<std::size_t> fields_with_psf(const LensDataTable& table, std::size_t wavelength) {
  std::vector<std::size_t> fields;
  for (std::size_t field = 0; field < table.fields.size(); ++field)
    if (field == 0 || field + 1 == table.fields.size() || table.has_psf(table.index(field, wavelength)))
      fields.push_back(field);
  return fields;
}

/// The PSFs of one wavelength of a table: how far they extend, field by field, and what that makes of
/// `reach`.
std::vector<PsfExtent> extents_of(const LensDataTable& table, std::size_t wavelength,
                                  const std::vector<std::size_t>& fields, double cell_um,
                                  const LightCentres& centres, PsfReach& reach) {
  if (table.fields.empty()) throw InputError("the lens data table has no fields");
  std::vector<std::optional<PsfExtent>> extents(fields.size());
  parallel_for(extents.size(), [&](std::size_t i) {
    const std::size_t entry = table.index(fields[i], wavelength);
    const Psf& psf = table.psf.at(entry);
    if (has_light(psf)) extents[i] = extent_of(psf, centres.offset_mm(entry) * um_per_mm);
  });
  std::vector<PsfExtent> found;
  for (std::size_t i = 0; i < extents.size(); ++i) {
    if (!extents[i])
      throw InputError(
          fmt::format("the lens data table holds a PSF at {} nm that is empty, dark or damaged; "
                      "samples of sum 1 at a positive spacing are right",
                      table.wavelengths_nm[wavelength]));
    add_to_reach(table.psf[table.index(fields[i], wavelength)], *extents[i], cell_um, reach);
    found.push_back(*extents[i]);
  }
  return found;
}

/// With the light in the corners of its window spread evenly about the middle. The PSF on the axis of a
/// centred lens is the same at every azimuth; a square window is not, and next to the axis, where azimuths
/// change from cell to cell, its corners would show. To leave them out would make the PSF narrower than those
/// of the fields about it, whose corners count.
Psf turned_about_axis(const Psf& psf) {
  const int middle = psf.size / 2, reach = static_cast<int>(std::ceil(std::hypot(middle, middle)));
  const auto ring_of = [&](int row, int column) {  // −1: within the circle that the window holds
    const int squares = row * row + column * column;
    if (squares <= middle * middle) return -1;
    return std::max(-1, static_cast<int>(std::ceil(std::sqrt(squares))) - 1 - middle);
  };
  std::vector<double> light(static_cast<std::size_t>(reach - middle) + 1), cells(light.size());
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      if (const int ring = ring_of(i - middle, j - middle); ring >= 0)
        light[static_cast<std::size_t>(ring)] += double(psf.at(i, j));
  if (std::all_of(light.begin(), light.end(), [](double of_ring) { return of_ring == 0; })) return psf;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      if (const int ring = ring_of(i, j); ring >= 0 && static_cast<std::size_t>(ring) < cells.size())
        ++cells[static_cast<std::size_t>(ring)];
  Psf round = psf;
  round.size = 2 * reach + 1;
  round.values.clear();
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      const int ring = ring_of(i, j);
      if (ring < 0)
        round.values.push_back(i + middle < psf.size && j + middle < psf.size ? psf.at(i + middle, j + middle)
                                                                              : 0);
      else if (const auto at = static_cast<std::size_t>(ring); at < light.size())
        round.values.push_back(static_cast<float>(light[at] / cells[at]));
      else
        round.values.push_back(0);
    }
  return round;
}

}  // namespace

PsfReach height_reach(const LensDataTable& table, double wavelength_nm, double cell_um,
                      const LightCentres& centres) {
  PsfReach reach;
  for (const auto& [wavelength, weight] : bracketing_wavelengths(table, wavelength_nm))
    extents_of(table, wavelength, fields_with_psf(table, wavelength), cell_um, centres, reach);
  return reach;
}

HeightKernels::HeightKernels(const LensDataTable& table, double wavelength_nm, double cell_um,
                             PsfInterpolation interpolation, const LightCentres& centres, LatticeSteps steps)
    : cell_um_(cell_um), steps_(static_cast<double>(steps)), interpolation_(interpolation) {
  for (const auto& part : bracketing_wavelengths(table, wavelength_nm)) {
    const std::size_t wavelength = part.first;
    Layer layer;
    layer.weight = part.second;
    const std::vector<std::size_t> fields = fields_with_psf(table, wavelength);
    const std::vector<PsfExtent> extents = extents_of(table, wavelength, fields, cell_um, centres, reach_);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::size_t entry = table.index(fields[i], wavelength);
      layer.height_mm.push_back(table.real_image_height_mm.at(entry) + centres.offset_mm(entry));
      const PsfExtent& extent = extents[i];
      const bool on_axis = layer.height_mm.back() == 0;  // its corners go all round
      layer.half_side_um.push_back((on_axis ? extent.reach_um : extent.half_side_um) +
                                   table.psf[entry].spacing_um);
    }
    std::vector<std::optional<MergedPsf>> merged(fields.size());
    std::vector<char> symmetric(fields.size());
    parallel_for(fields.size(), [&](std::size_t field) {
      const std::size_t entry = table.index(fields[field], wavelength);
      const Psf& psf = table.psf[entry];
      const double height_mm = layer.height_mm[field], origin_um = centres.offset_mm(entry) * um_per_mm;
      symmetric[field] = is_mirror_symmetric(psf);
      const Psf whole = symmetric[field] != 0 && psf.size % 2 == 0 ? with_partner(psf) : psf;
      merged[field] = merged_psf(height_mm == 0 ? turned_about_axis(whole) : whole, origin_um, cell_um);
    });
    for (std::size_t field = 0; field < fields.size(); ++field) {
      mirror_symmetric_ = mirror_symmetric_ && symmetric[field] != 0;
      layer.psfs.push_back(std::move(*merged[field]));
    }
    layer.moments = MomentCurves(layer.height_mm, layer.psfs);
    layers_.push_back(std::move(layer));
  }
  const std::size_t intervals = std::max<std::size_t>(1, layers_[0].psfs.size() - 1);
  std::vector<double> coefficients;
  for (std::size_t i = 0; i < intervals; ++i) coefficients.push_back(std::pow(2.0 * half_of(i) + 1, 2));
  series_ = std::make_unique<PsfSeries>(layers_[0].height_mm, coefficients, 2 * cell_um * mm_per_um);
}

double HeightKernels::spacing_um() const {
  return cell_um_ / steps_;
}

int HeightKernels::half_of(std::size_t interval) const {
  double half_side_um = 0;
  // Of all four that go into what lies between two fields.
  for (const Layer& layer : layers_)
    for (std::size_t field = interval - std::min<std::size_t>(interval, 1);
         field < std::min(interval + 3, layer.psfs.size()); ++field)
      half_side_um = std::max(half_side_um, layer.half_side_um[field]);
  return static_cast<int>(std::ceil(half_side_um / spacing_um()));
}

Kernel HeightKernels::mixture_at(double height_mm, std::size_t interval,
                                 const std::array<double, 2>& beyond) const {
  Kernel lattice(half_of(interval));
  for (const Layer& layer : layers_)
    for (const FieldShare& share : field_shares(layer.height_mm, height_mm))
      add(layer, layer.psfs[share.field], share, height_mm, beyond, lattice);
  return lattice;
}

SmoothPsf HeightKernels::psf_at(double height_mm, std::size_t interval) const {
  const Moments wanted = moments_at(height_mm);
  Kernel lattice = mixture_at(height_mm, interval, {1, 1});
  const Moments own = lattice.moments();
  const auto variance = [](double square, double mean) { return square - mean * mean; };
  const double of_lattice = 1 / (steps_ * steps_);
  const std::array<double, 2> own_variance{of_lattice * variance(own.uu, own.mean[0]),
                                           of_lattice * variance(own.vv, own.mean[1])},
      wanted_variance{variance(wanted.uu, wanted.mean[0]), variance(wanted.vv, wanted.mean[1])};
  // What the mixture's spread misses. A little, as what laid it down adds, is the window's to make good.
  constexpr double left_to_window = window_cells * window_cells / 20;
  const auto missing = [&](std::size_t axis) {
    constexpr double least = 0.8, most = 1.25;
    if (!(wanted_variance[axis] > 0 && own_variance[axis] > 0) ||
        std::abs(wanted_variance[axis] - own_variance[axis]) < left_to_window)
      return 1.0;
    return std::clamp(std::sqrt(wanted_variance[axis] / own_variance[axis]), least, most);
  };
  const std::array<double, 2> beyond{missing(0), missing(1)};
  if (beyond != std::array{1.0, 1.0}) lattice = mixture_at(height_mm, interval, beyond);
  return {lattice, 1 / steps_, wanted};
}

double HeightKernels::coefficients() const {
  const std::size_t intervals = std::max<std::size_t>(1, layers_[0].psfs.size() - 1);
  return std::pow(2.0 * half_of(intervals / 2) + 1, 2);
}

namespace {

void bring_to_unit_sum(Kernel& kernel) {
  const double scale = 1 / kernel.sum();
  for (double& weight : kernel.weights) weight *= scale;
}

}  // namespace

Kernel HeightKernels::lone_kernel(double height_mm) const {
  const std::vector<double>& heights_mm = layers_[0].height_mm;
  const SmoothPsf psf = psf_at(height_mm, heights_mm.size() > 1 ? bracket(heights_mm, height_mm) : 0);
  Kernel kernel(reach_.radius);
  sample_mixture(std::array{WeightedPsf{&psf, 1}}, 1 / steps_, moments_at(height_mm), {0, 1}, kernel);
  bring_to_unit_sum(kernel);
  return kernel;
}

Kernel HeightKernels::kernel_at(double x_mm, double y_mm) const {
  const double height_mm = std::hypot(x_mm, y_mm);
  const std::array<double, 2> direction =
      height_mm > 0 ? std::array{x_mm / height_mm, y_mm / height_mm} : std::array{0.0, 1.0};
  Kernel kernel = interpolation_ == PsfInterpolation::psf ? interpolated_psf(direction, height_mm)
                                                          : interpolated_otf(direction, height_mm);
  bring_to_unit_sum(kernel);
  return kernel;
}

HeightKernels::MomentCurves::MomentCurves(const std::vector<double>& height_mm,
                                          const std::vector<MergedPsf>& psfs) {
  using Start = MonotoneCubic::Start;
  const auto curve = [&](Start start, const auto& of) {
    std::vector<double> values;
    for (const MergedPsf& psf : psfs) values.push_back(of(psf.moments()) / psf.sum());
    return MonotoneCubic(height_mm, std::move(values), start);
  };
  s_ = curve(Start::free, [](const Moments& m) { return m.mean[0]; });
  t_ = curve(Start::free, [](const Moments& m) { return m.mean[1]; });
  ss_ = curve(Start::even, [](const Moments& m) { return m.uu; });
  st_ = curve(Start::free, [](const Moments& m) { return m.uv; });
  tt_ = curve(Start::even, [](const Moments& m) { return m.vv; });
}

Moments HeightKernels::moments_at(double height_mm) const {
  Moments sums;
  for (const Layer& layer : layers_) {
    const Moments moments = layer.moments.at(height_mm);
    const double weight = layer.weight / cell_um_, weight_squared = weight / cell_um_;
    sums.mean[0] -= weight * moments.mean[0];  // columns run along −s
    sums.mean[1] += weight * moments.mean[1];
    sums.uu += weight_squared * moments.uu;
    sums.uv -= weight_squared * moments.uv;
    sums.vv += weight_squared * moments.vv;
  }
  return sums;
}

HeightKernels::Pair HeightKernels::pair_at(const Layer& layer, double height_mm) {
  if (layer.psfs.size() == 1) return {&layer.psfs[0], &layer.psfs[0], 0};
  const std::size_t i = bracket(layer.height_mm, height_mm);
  const double span = layer.height_mm[i + 1] - layer.height_mm[i];
  return {&layer.psfs[i], &layer.psfs[i + 1], std::clamp((height_mm - layer.height_mm[i]) / span, 0.0, 1.0)};
}

void HeightKernels::add(const Layer& layer, const MergedPsf& psf, const FieldShare& share, double height_mm,
                        const std::array<double, 2>& beyond, Kernel& lattice) const {
  if (share.weight == 0) return;
  constexpr double least = 0.5, most = 2;
  const Moments own = psf.moments(), wanted = layer.moments.at(height_mm);
  const double light = psf.sum();
  const auto stretch = [&](double wanted_square, double wanted_mean, double square, double mean) {
    const double variance = square / light - (mean / light) * (mean / light);
    const double wanted_variance = wanted_square - wanted_mean * wanted_mean;
    if (!(variance > 0 && wanted_variance > 0)) return 1.0;
    return std::clamp(std::sqrt(wanted_variance / variance), least, most);
  };
  const double s = stretch(wanted.uu, wanted.mean[0], own.uu, own.mean[0]);
  const double t = stretch(wanted.vv, wanted.mean[1], own.vv, own.mean[1]);
  deposit(psf, {layer.weight * share.weight, {beyond[0] * s, beyond[1] * t}, share.across_axis}, spacing_um(),
          lattice);
}

void HeightKernels::prepare(const std::vector<std::array<double, 2>>& places_mm) const {
  std::vector<double> heights_mm;
  for (const auto& [x_mm, y_mm] : places_mm) heights_mm.push_back(std::hypot(x_mm, y_mm));
  if (interpolation_ == PsfInterpolation::psf)
    series_->prepare(heights_mm, [&](double mm, std::size_t interval) { return psf_at(mm, interval); });
}

Kernel HeightKernels::interpolated_psf(const std::array<double, 2>& direction, double height_mm) const {
  Kernel kernel(reach_.radius);
  const PsfSeries::Mixture psfs =
      series_->at(height_mm, [&](double mm, std::size_t interval) { return psf_at(mm, interval); });
  sample_mixture(psfs, 1 / steps_, moments_at(height_mm), direction, kernel);
  return kernel;
}

Kernel HeightKernels::interpolated_otf(const std::array<double, 2>& direction, double height_mm) const {
  const int half = static_cast<int>(std::ceil(reach_.radius * steps_));
  const auto kernel_of = [&](const Layer& layer, const MergedPsf& psf) {
    Kernel lattice(half), kernel(reach_.radius);
    add(layer, psf, {0, 1, false}, height_mm, {1, 1}, lattice);
    const Moments wanted = moments_at(height_mm);
    const SmoothPsf smooth(lattice, 1 / steps_, wanted);
    sample_mixture(std::array{WeightedPsf{&smooth, 1}}, 1 / steps_, wanted, direction, kernel);
    return kernel;
  };
  std::vector<Kernel> of_layers;
  for (const Layer& layer : layers_) {
    const Pair pair = pair_at(layer, height_mm);
    const Kernel low = kernel_of(layer, *pair.low), high = kernel_of(layer, *pair.high);
    of_layers.push_back(between_otfs(low, high, pair.weight_high));
  }
  return of_layers.size() == 1 ? of_layers[0] : between_otfs(of_layers[0], of_layers[1], layers_[1].weight);
}

}  // namespace petzval
