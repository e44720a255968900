// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/psf_deposit.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Centre of gravity along t, from the chief ray [mm]; 0 for a dark PSF.
double tangential_centre_mm(const Psf& psf) {
  double light = 0, moment = 0;
  for (int i = 0; i < psf.size; ++i) {
    double row = 0;
    for (int j = 0; j < psf.size; ++j) row += double(psf.at(i, j));
    light += row;
    moment += row * (i - psf.size / 2);
  }
  return light > 0 ? moment / light * psf.spacing_um * mm_per_um : 0;
}

/// The centres of fields without PSFs: the cubics through those about them, which turn over at the axis.
void fill_between(const LensDataTable& table, std::size_t wavelength, std::vector<double>& centres_mm) {
  std::vector<double> height_mm;
  std::vector<std::size_t> entries;
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const std::size_t entry = table.index(f, wavelength);
    if (!table.has_psf(entry)) continue;
    entries.push_back(entry);
    height_mm.push_back(table.real_image_height_mm[entry]);
  }
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const std::size_t entry = table.index(f, wavelength);
    if (table.has_psf(entry)) continue;
    for (const FieldShare& share : field_shares(height_mm, table.real_image_height_mm[entry]))
      centres_mm[entry] +=
          (share.across_axis ? -share.weight : share.weight) * centres_mm[entries[share.field]];
  }
}

/// The centres of places without PSFs, along x' and y': the spline through those with one.
void fill_between(const LensDataTable& table, std::size_t wavelength,
                  std::vector<std::array<double, 2>>& centres_mm) {
  const FramePlaces& frame = *table.frame;
  const PsfLattice lattice = psf_lattice(table, wavelength);
  if (lattice.columns.size() * lattice.rows.size() == frame.count()) return;
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    const LatticeSpline between = spline_of_psfs(
        frame, lattice, [&](std::size_t place) { return centres_mm[table.index(place, wavelength)][axis]; });
    for (std::size_t j = 0; j < frame.y_mm.size(); ++j)
      for (std::size_t i = 0; i < frame.x_mm.size(); ++i)
        if (!lattice.holds(i, j))
          centres_mm[table.index(frame.place(i, j), wavelength)][axis] =
              between(frame.x_mm[i], frame.y_mm[j]);
  }
}

}  // namespace

LatticeSpline spline_of_psfs(const FramePlaces& frame, const PsfLattice& lattice,
                             const std::function<double(std::size_t place)>& value) {
  std::vector<double> x_mm, y_mm, values;
  for (const std::size_t column : lattice.columns) x_mm.push_back(frame.x_mm[column]);
  for (const std::size_t row : lattice.rows) {
    y_mm.push_back(frame.y_mm[row]);
    for (const std::size_t column : lattice.columns) values.push_back(value(frame.place(column, row)));
  }
  return {std::move(x_mm), std::move(y_mm), std::move(values)};
}

std::vector<std::pair<std::size_t, double>> bracketing_wavelengths(const LensDataTable& table,
                                                                   double wavelength_nm) {
  const std::vector<double>& table_nm = table.wavelengths_nm;
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

void LightCentres::find_over_frame(const LensDataTable& table) {
  const FramePlaces& frame = *table.frame;
  frame_offsets_mm_.resize(table.psf.size());
  parallel_for(frame_offsets_mm_.size(), [&](std::size_t entry) {
    if (!table.has_psf(entry)) return;
    const LightMoments light = light_moments(table.psf[entry], 0);
    if (!(light.sum > 0)) return;
    const double s = light.sums.mean[0] / light.sum * mm_per_um,
                 t = light.sums.mean[1] / light.sum * mm_per_um;
    const double a = radians(frame.psf_azimuth_deg[entry]);
    frame_offsets_mm_[entry] = {s * std::cos(a) - t * std::sin(a), s * std::sin(a) + t * std::cos(a)};
  });
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) fill_between(table, w, frame_offsets_mm_);
  constexpr double most_of_step = 0.5;
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
    bool tame = true;
    const auto compare = [&](std::size_t a, std::size_t b, double step_mm) {
      const auto &from = frame_offsets_mm_[table.index(a, w)], &to = frame_offsets_mm_[table.index(b, w)];
      tame = tame && std::hypot(to[0] - from[0], to[1] - from[1]) < most_of_step * step_mm;
    };
    for (std::size_t j = 0; j < frame.y_mm.size(); ++j)
      for (std::size_t i = 0; i < frame.x_mm.size(); ++i) {
        if (i > 0) compare(frame.place(i - 1, j), frame.place(i, j), frame.x_mm[i] - frame.x_mm[i - 1]);
        if (j > 0) compare(frame.place(i, j - 1), frame.place(i, j), frame.y_mm[j] - frame.y_mm[j - 1]);
      }
    if (!tame)
      for (std::size_t place = 0; place < frame.count(); ++place)
        frame_offsets_mm_[table.index(place, w)] = {};
  }
}

LightCentres::LightCentres(const LensDataTable& table) {
  if (table.frame) {
    find_over_frame(table);
    return;
  }
  offsets_mm_.resize(table.psf.size());
  constexpr double least_stretch = 0.5, most_stretch = 2;
  std::vector<double> own_mm(table.psf.size());
  parallel_for(own_mm.size(),
               [&](std::size_t entry) { own_mm[entry] = tangential_centre_mm(table.psf[entry]); });
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
    fill_between(table, w, own_mm);
    for (std::size_t f = 1; f < table.fields.size(); ++f) {
      const std::size_t here = table.index(f, w), before = table.index(f - 1, w);
      const double step = table.real_image_height_mm[here] - table.real_image_height_mm[before];
      offsets_mm_[here] =
          offsets_mm_[before] + std::clamp(own_mm[here] - offsets_mm_[before], (least_stretch - 1) * step,
                                           (most_stretch - 1) * step);
    }
  }
}

LightProfile::LightProfile(RadialProfile chief)
    : chief_(std::move(chief)), max_height_mm_(chief_.max_height_mm()) {}

LightProfile::LightProfile(RadialProfile chief, const LensDataTable& table, const LightCentres& centres,
                           double wavelength_nm)
    : LightProfile(std::move(chief)) {
  if (centres.none()) return;
  const auto wavelengths = bracketing_wavelengths(table, wavelength_nm);
  std::vector<double> chief_mm, centre_mm;
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    chief_mm.push_back(f == 0 ? 0 : chief_.image_height_mm(table.fields[f]));
    double offset_mm = 0;
    for (const auto& [w, weight] : wavelengths) offset_mm += weight * centres.offset_mm(table.index(f, w));
    centre_mm.push_back(chief_mm.back() + offset_mm);
  }
  centre_ = MonotoneCubic(std::move(chief_mm), std::move(centre_mm), MonotoneCubic::Start::odd,
                          MonotoneCubic::Beyond::linear);
  max_height_mm_ = centre_(max_height_mm_);
  moved_ = true;
}

double LightProfile::g_source_sr(double height_mm) const {
  if (!moved_) return chief_.g_source_sr(height_mm);
  const double chief_mm = chief_height_mm(height_mm), radial = centre_.derivative(chief_mm);
  const double tangential = chief_mm > 0 ? centre_(chief_mm) / chief_mm : radial;
  return chief_.g_source_sr(chief_mm) / (radial * tangential);
}

}  // namespace petzval
