// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/cell_psf.h>
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/frame_kernels.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace petzval {

namespace {

/// A vector along x' and y' in the axes of a PSF, and back.
struct PsfAxes {
  double cosine, sine;  ///< of its azimuth

  std::array<double, 2> to_own(double x, double y) const {
    return {cosine * x + sine * y, cosine * y - sine * x};
  }
  std::array<double, 2> to_frame(double s, double t) const {
    return {cosine * s - sine * t, sine * s + cosine * t};
  }
};

/// field_shares() of a lattice's axis, whose places have no axis of symmetry among them.
std::array<FieldShare, 4> lattice_shares(const std::vector<double>& places_mm, double at_mm) {
  thread_local std::vector<double> from_first;
  from_first.clear();
  for (const double place : places_mm) from_first.push_back(1 + place - places_mm.front());
  return field_shares(from_first, 1 + at_mm - places_mm.front());
}

}  // namespace

PsfReach frame_reach(const LensDataTable& table, double wavelength_nm, double cell_um,
                     const LightCentres& centres) {
  PsfReach reach;
  for (const auto& [wavelength, weight] : bracketing_wavelengths(table, wavelength_nm)) {
    const PsfLattice lattice = psf_lattice(table, wavelength);
    const std::size_t columns = table.frame->x_mm.size();
    for (std::size_t place = 0; place < table.places(); ++place) {
      if (!lattice.holds(place % columns, place / columns)) continue;
      const std::size_t entry = table.index(place, wavelength);
      const Psf& psf = table.psf.at(entry);
      if (!has_light(psf))
        throw InputError(
            fmt::format("the lens data table holds a PSF at {} nm that is empty, dark or damaged; "
                        "samples of sum 1 at a positive spacing are right",
                        table.wavelengths_nm[wavelength]));
      const double azimuth = radians(table.frame->psf_azimuth_deg[entry]);
      const auto [x_mm, y_mm] = centres.frame_offset_mm(entry);
      const auto [s_mm, t_mm] = PsfAxes{std::cos(azimuth), std::sin(azimuth)}.to_own(x_mm, y_mm);
      add_to_reach(psf, extent_of(psf, t_mm * um_per_mm, s_mm * um_per_mm), cell_um, reach);
    }
  }
  return reach;
}

FrameKernels::FrameKernels(const LensDataTable& table, double wavelength_nm, double cell_um,
                           const LightCentres& centres, LatticeSteps steps)
    : table_(table),
      cell_um_(cell_um),
      steps_(static_cast<double>(steps)),
      centres_(table, centres, wavelength_nm),
      reach_(frame_reach(table, wavelength_nm, cell_um, centres)) {
  for (const auto& [wavelength, weight] : bracketing_wavelengths(table, wavelength_nm)) {
    Layer layer;
    layer.wavelength = wavelength;
    layer.weight = weight;
    layer.lattice = psf_lattice(table, wavelength);
    for (const std::size_t column : layer.lattice.columns) layer.x_mm.push_back(table.frame->x_mm[column]);
    for (const std::size_t row : layer.lattice.rows) layer.y_mm.push_back(table.frame->y_mm[row]);
    layer.entries = std::make_unique<Entry[]>(table.places());
    for (std::size_t place = 0; place < table.places(); ++place) {
      const double azimuth = radians(table.frame->psf_azimuth_deg[table.index(place, wavelength)]);
      layer.cosines.push_back(std::cos(azimuth));
      layer.sines.push_back(std::sin(azimuth));
    }
    find_spreads(centres, layer);
    layers_.push_back(std::move(layer));
  }
}

void FrameKernels::find_spreads(const LightCentres& centres, Layer& layer) const {
  std::vector<Spread> spreads(table_.places());
  parallel_for(spreads.size(), [&](std::size_t place) {
    const std::size_t entry = table_.index(place, layer.wavelength);
    if (!table_.has_psf(entry)) return;
    const LightMoments light = light_moments(table_.psf[entry], 0);
    const auto mean = [&](double sum) { return sum / light.sum; };
    const double s = mean(light.sums.mean[0]), t = mean(light.sums.mean[1]);
    const double ss = mean(light.sums.uu) - s * s, st = mean(light.sums.uv) - s * t,
                 tt = mean(light.sums.vv) - t * t;
    const double c = layer.cosines[place], n = layer.sines[place], square = cell_um_ * cell_um_;
    const std::array<double, 2> at_um = PsfAxes{c, n}.to_frame(s, t), offset = centres.frame_offset_mm(entry);
    spreads[place] = {
        {(at_um[0] - offset[0] * um_per_mm) / cell_um_, (at_um[1] - offset[1] * um_per_mm) / cell_um_},
        (c * c * ss - 2 * c * n * st + n * n * tt) / square,
        (c * n * (ss - tt) + (c * c - n * n) * st) / square,
        (n * n * ss + 2 * c * n * st + c * c * tt) / square};
  });
  const auto spline = [&](const auto& of) {
    return spline_of_psfs(*table_.frame, layer.lattice,
                          [&](std::size_t place) { return of(spreads[place]); });
  };
  layer.mean_x = spline([](const Spread& spread) { return spread.mean[0]; });
  layer.mean_y = spline([](const Spread& spread) { return spread.mean[1]; });
  layer.xx = spline([](const Spread& spread) { return spread.xx; });
  layer.xy = spline([](const Spread& spread) { return spread.xy; });
  layer.yy = spline([](const Spread& spread) { return spread.yy; });
}

FrameKernels::Spread FrameKernels::Layer::spread_at(double x_mm, double y_mm) const {
  // Between places a spline may swing; light is never spread by less than nothing.
  const double across = std::max(0.0, xx(x_mm, y_mm)), down = std::max(0.0, yy(x_mm, y_mm));
  const double most = std::sqrt(across * down);
  return {{mean_x(x_mm, y_mm), mean_y(x_mm, y_mm)}, across, std::clamp(xy(x_mm, y_mm), -most, most), down};
}

const SmoothPsf& FrameKernels::psf(const Layer& layer, std::size_t place) const {
  Entry& entry = layer.entries[place];
  std::call_once(entry.made, [&] {
    const Psf& table = table_.psf[table_.index(place, layer.wavelength)];
    // About the chief ray; the way to the centre of light is taken as kernels are sampled.
    const double spacing_um = cell_um_ / steps_;
    const double half_side_um = extent_of(table, 0).half_side_um + table.spacing_um;
    Kernel lattice(static_cast<int>(std::ceil(half_side_um / spacing_um)));
    const MergedPsf merged = merged_psf(table, 0, cell_um_);
    deposit(merged, {1, {1, 1}, false}, spacing_um, lattice);
    const Moments& sums = merged.moments();
    const auto mean = [&](double sum) { return sum / merged.sum(); };
    const double square = cell_um_ * cell_um_;
    const Moments own{{-mean(sums.mean[0]) / cell_um_, mean(sums.mean[1]) / cell_um_},  // columns: −s
                      mean(sums.uu) / square,
                      -mean(sums.uv) / square,
                      mean(sums.vv) / square};
    entry.psf = std::make_unique<SmoothPsf>(lattice, 1 / steps_, own);
  });
  return *entry.psf;
}

std::vector<FrameKernels::Share> FrameKernels::shares_at(const Layer& layer,
                                                         const std::array<double, 2>& chief_mm) const {
  const auto across = lattice_shares(layer.x_mm, chief_mm[0]), down = lattice_shares(layer.y_mm, chief_mm[1]);
  std::vector<Share> shares;
  for (const FieldShare& row : down)
    for (const FieldShare& column : across)
      if (const double weight = row.weight * column.weight; weight != 0)
        shares.push_back(
            {table_.frame->place(layer.lattice.columns[column.field], layer.lattice.rows[row.field]),
             weight});
  return shares;
}

std::array<double, 2> FrameKernels::known_chief_mm(double x_mm, double y_mm) const {
  const std::vector<double>&x = table_.frame->x_mm, &y = table_.frame->y_mm;
  // Tiles end beyond the grid, and so do the places of their kernels.
  const auto [chief_x, chief_y] =
      centres_.chief_mm(std::clamp(x_mm, x.front(), x.back()), std::clamp(y_mm, y.front(), y.back()));
  return {std::clamp(chief_x, x.front(), x.back()), std::clamp(chief_y, y.front(), y.back())};
}

Kernel FrameKernels::kernel_at(double x_mm, double y_mm) const {
  const std::array<double, 2> chief_mm = known_chief_mm(x_mm, y_mm);
  Kernel kernel(reach_.radius), part(reach_.radius);
  for (const Layer& layer : layers_) {
    const Spread spread = layer.spread_at(chief_mm[0], chief_mm[1]);
    for (const Share& share : shares_at(layer, chief_mm)) {
      const double c = layer.cosines[share.place], n = layer.sines[share.place];
      const auto [s, t] = PsfAxes{c, n}.to_own(spread.mean[0], spread.mean[1]);
      const double ss = c * c * spread.xx + 2 * c * n * spread.xy + n * n * spread.yy,
                   tt = n * n * spread.xx - 2 * c * n * spread.xy + c * c * spread.yy;
      // Columns of a lattice run along −s, its rows along t, which points to (−sin, cos) of the azimuth.
      const Moments wanted{{-s, t}, ss + s * s, 0, tt + t * t};
      std::fill(part.weights.begin(), part.weights.end(), 0.0);
      const WeightedPsf one{&psf(layer, share.place), 1};
      sample_mixture({&one, 1}, 1 / steps_, wanted, {-n, c}, part);
      const double weight = layer.weight * share.weight;
      for (std::size_t i = 0; i < kernel.weights.size(); ++i) kernel.weights[i] += weight * part.weights[i];
    }
  }
  const double sum = kernel.sum();
  for (double& weight : kernel.weights) weight /= sum;
  return kernel;
}

void FrameKernels::prepare(const std::vector<std::array<double, 2>>& places_mm) const {
  std::set<std::pair<std::size_t, std::size_t>> needed;  // layer, place
  for (const auto& [x_mm, y_mm] : places_mm)
    for (std::size_t i = 0; i < layers_.size(); ++i)
      for (const Share& share : shares_at(layers_[i], known_chief_mm(x_mm, y_mm)))
        needed.emplace(i, share.place);
  const std::vector<std::pair<std::size_t, std::size_t>> order(needed.begin(), needed.end());
  parallel_for(order.size(), [&](std::size_t i) { psf(layers_[order[i].first], order[i].second); });
}

double FrameKernels::coefficients() const {
  const double size = 2.0 * reach_.radius + 1;
  constexpr double shares = 16;
  return shares * double(layers_.size()) * size * size;
}

}  // namespace petzval
