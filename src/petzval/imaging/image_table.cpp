// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/frame_kernels.h>
#include <petzval/imaging/height_kernels.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/image_table.h>
#include <petzval/optics/frame_build.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace petzval {

namespace {

/// PSFs at first: both ends and two between, for cubics.
constexpr std::size_t first_intervals = 3;

/// The PSFs of one wavelength of a table at some of its fields.
LensDataTable one_wavelength(const LensDataTable& table, std::size_t wavelength,
                             const std::vector<std::size_t>& fields) {
  LensDataTable part;
  part.wavelengths_nm = {table.wavelengths_nm[wavelength]};
  for (const std::size_t field : fields) {
    const std::size_t entry = table.index(field, wavelength);
    part.fields.push_back(table.fields[field]);
    part.real_image_height_mm.push_back(table.real_image_height_mm[entry]);
    part.psf.push_back(table.psf[entry]);
  }
  return part;
}

/// Of light whose chief ray lands at a height, and about it, by the PSFs of a table of one wavelength.
Kernel kernel_about_chief(const LensDataTable& table, double height_mm, double cell_um) {
  return HeightKernels(table, table.wavelengths_nm[0], cell_um, PsfInterpolation::psf, {},
                       LatticeSteps::coarse)
      .lone_kernel(height_mm);
}

/// √(Σd²/(1 + Σh²)), as ProductPlan::estimated_error.
double difference(const Kernel& few, const Kernel& more) {
  const int radius = std::max(few.radius, more.radius);
  const auto weight = [](const Kernel& kernel, int row, int column) {
    const bool inside = std::abs(row) <= kernel.radius && std::abs(column) <= kernel.radius;
    return inside ? kernel.at(row, column) : 0.0;
  };
  double squares = 0, light = 0;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double here = weight(more, row, column);
      squares += std::pow(weight(few, row, column) - here, 2);
      light += here * here;
    }
  return std::sqrt(squares / (1 + light));
}

/// An interval between two fields with PSFs.
struct Interval {
  std::size_t from, to;
  std::size_t middle() const { return (from + to) / 2; }
};

/// How much of a frame lies between two heights.
class FrameRings {
 public:
  explicit FrameRings(const TableOptions& options) {
    const double side_mm = options.max_image_height_mm / std::sqrt(2.0);
    const std::array<double, 2> half_mm = options.half_frame_mm.value_or(std::array{side_mm, side_mm});
    for (int row = 0; row < places; ++row)
      for (int column = 0; column < places; ++column)
        height_mm_.push_back(
            std::hypot((column + 0.5) / places * half_mm[0], (row + 0.5) / places * half_mm[1]));
    std::sort(height_mm_.begin(), height_mm_.end());
  }
  double share(double from_mm, double to_mm) const {
    const auto below = [&](double mm) {
      return std::lower_bound(height_mm_.begin(), height_mm_.end(), mm) - height_mm_.begin();
    };
    return double(below(to_mm) - below(from_mm)) / double(height_mm_.size());
  }

 private:
  static constexpr int places = 32;  ///< along a side of a quadrant
  std::vector<double> height_mm_;
};

/// Columns or rows of a lattice from one with PSFs to the next, the first and the last interval halved
/// towards the rim so many times: there cubics end, and light changes most.
struct LatticeGrade {
  std::size_t step;
  int rim_halvings;

  std::vector<std::size_t> of(std::size_t count) const {
    constexpr std::size_t fewest = 4;  // a cubic's
    std::size_t apart = step;
    while (apart > 1 && ((count - 1) % apart != 0 || (count - 1) / apart + 1 < fewest)) apart /= 2;
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < count; i += apart) taken.push_back(i);
    std::size_t from_rim = apart;
    for (int i = 0; i < rim_halvings && apart == step && from_rim > 1; ++i) {
      from_rim /= 2;
      taken.insert(taken.begin() + 1, from_rim);
      taken.insert(taken.end() - 1, count - 1 - from_rim);
    }
    return taken;
  }
};

/// Finds the places over a frame that an image needs.
class PlaceChoice {
 public:
  PlaceChoice(FrameTable& parts, const SpreadWanted& wanted)
      : parts_(parts), wanted_(wanted), wavelength_(parts.table().wavelengths_nm.size() / 2) {}

  std::vector<std::size_t> places(const ProgressCallback& progress) {
    const std::array only{wavelength_};
    constexpr std::array grades{LatticeGrade{4, 0}, LatticeGrade{4, 1}, LatticeGrade{4, 2},
                                LatticeGrade{2, 1}};
    std::vector<std::size_t> chosen(frame().count());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    for (const LatticeGrade& grade : grades) {
      const PsfLattice lattice{grade.of(frame().x_mm.size()), grade.of(frame().y_mm.size())};
      const std::vector<Mesh> meshes = meshes_of(lattice);
      if (meshes.empty()) break;
      std::vector<std::size_t> middles;
      for (const Mesh& mesh : meshes) middles.push_back(mesh.middle);
      parts_.add_psfs(places_of(lattice), only, progress);
      parts_.add_psfs(middles, only, progress);
      if (!says_enough(places_of(lattice), meshes)) continue;
      chosen = places_of(lattice);
      break;
    }
    for (std::size_t place = 0; place < frame().count(); ++place) parts_.remove_psf(place, wavelength_);
    return chosen;
  }

 private:
  /// Between columns and rows with PSFs.
  struct Mesh {
    std::size_t middle;
    double share;    ///< of the lattice
    double side_mm;  ///< the shorter
  };

  const FramePlaces& frame() const { return *parts_.table().frame; }
  std::vector<std::size_t> places_of(const PsfLattice& lattice) const {
    std::vector<std::size_t> places;
    for (const std::size_t row : lattice.rows)
      for (const std::size_t column : lattice.columns) places.push_back(frame().place(column, row));
    return places;
  }
  /// Those with a place in the middle, where there is light.
  std::vector<Mesh> meshes_of(const PsfLattice& lattice) const {
    const std::vector<double>&x = frame().x_mm, &y = frame().y_mm;
    const double all = (x.back() - x.front()) * (y.back() - y.front());
    std::vector<Mesh> meshes;
    for (std::size_t j = 0; j + 1 < lattice.rows.size(); ++j)
      for (std::size_t i = 0; i + 1 < lattice.columns.size(); ++i) {
        const std::size_t left = lattice.columns[i], right = lattice.columns[i + 1], top = lattice.rows[j],
                          bottom = lattice.rows[j + 1];
        const std::size_t middle = frame().place((left + right) / 2, (top + bottom) / 2);
        const double width_mm = x[right] - x[left], height_mm = y[bottom] - y[top];
        if (middle != frame().place(left, top) &&
            parts_.table().g_source_sr[parts_.table().index(middle, wavelength_)] > 0)
          meshes.push_back({middle, width_mm * height_mm / all, std::min(width_mm, height_mm)});
      }
    return meshes;
  }
  FrameKernels kernels_of(const LensDataTable& table) const {
    const bool preview = wanted_.tolerance >= ImagingOptions::of_a_preview;
    return {table,
            table.wavelengths_nm[0],
            wanted_.cell_um,
            {},
            preview ? LatticeSteps::coarse : LatticeSteps::fine};
  }
  /// The PSFs of the middle wavelength at some places.
  LensDataTable spread_at(const std::vector<std::size_t>& places) const {
    const LensDataTable& table = parts_.table();
    LensDataTable part;
    part.wavelengths_nm = {table.wavelengths_nm[wavelength_]};
    part.frame = FramePlaces{frame().x_mm, frame().y_mm, {}, {}, {}};
    part.psf.resize(frame().count());
    part.frame->psf_azimuth_deg.resize(frame().count());
    for (const std::size_t place : places) {
      part.psf[place] = table.psf[table.index(place, wavelength_)];
      part.frame->psf_azimuth_deg[place] = frame().psf_azimuth_deg[table.index(place, wavelength_)];
    }
    return part;
  }
  /// The PSF of one place at every place of a mesh.
  LensDataTable spread_about(std::size_t place) const {
    const LensDataTable& table = parts_.table();
    const std::size_t entry = table.index(place, wavelength_);
    const double azimuth = frame().psf_azimuth_deg[entry];
    LensDataTable part;
    part.wavelengths_nm = {table.wavelengths_nm[wavelength_]};
    part.frame = FramePlaces{{0, 1}, {0, 1}, {}, {}, {azimuth, azimuth, azimuth, azimuth}};
    part.psf.assign(part.frame->count(), table.psf[entry]);
    return part;
  }

  /// Whether the PSFs of a lattice say closely enough how light spreads in the middles of its meshes.
  bool says_enough(const std::vector<std::size_t>& places, const std::vector<Mesh>& meshes) const {
    // In the middles a mixture is at its worst: over the meshes it is off by half as much, or less.
    constexpr double of_tolerance = 1, of_centre = 0.3;
    const LensDataTable few = spread_at(places);
    const FrameKernels kernels = kernels_of(few);
    const std::size_t columns = frame().x_mm.size();
    std::vector<double> squares(meshes.size()), moved(meshes.size());
    parallel_for(meshes.size(), [&](std::size_t i) {
      const std::size_t place = meshes[i].middle;
      const Kernel said = kernels.kernel_at(frame().x_mm[place % columns], frame().y_mm[place / columns]);
      const LensDataTable one = spread_about(place);
      const Kernel own = kernels_of(one).kernel_at(0, 0);
      squares[i] = meshes[i].share * std::pow(difference(said, own), 2);
      const auto said_at = said.moments().mean, own_at = own.moments().mean;
      const double mm =
          std::hypot(said_at[0] - own_at[0], said_at[1] - own_at[1]) * wanted_.cell_um * mm_per_um;
      moved[i] = 4 * mm / meshes[i].side_mm;  // as in FieldChoice::misfit()
    });
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    return std::sqrt(sum) <= of_tolerance * wanted_.tolerance &&
           *std::ranges::max_element(moved) <= of_centre * wanted_.tolerance;
  }

  FrameTable& parts_;
  const SpreadWanted wanted_;
  std::size_t wavelength_;
};

/// Finds the fields that an image needs.
class FieldChoice {
 public:
  FieldChoice(HeightTable& parts, const TableOptions& options, const SpreadWanted& wanted)
      : parts_(parts),
        frame_(options),
        wanted_(wanted),
        wavelength_(parts.table().wavelengths_nm.size() / 2) {
    const std::size_t last = parts.table().fields.size() - 1;
    for (std::size_t i = 0; i <= first_intervals; ++i) taken_.push_back(i * last / first_intervals);
  }

  /// All of which, and no others, have PSFs of the middle wavelength then.
  const std::vector<std::size_t>& fields(const ProgressCallback& progress) {
    parts_.add_psfs(taken_, std::array{wavelength_}, progress);
    std::vector<Interval> open;
    for (std::size_t i = 0; i + 1 < taken_.size(); ++i) open.push_back({taken_[i], taken_[i + 1]});
    while (true) {
      std::erase_if(open, [](const Interval& interval) { return interval.to - interval.from < 2; });
      if (open.empty()) return taken_;
      open = refined(open, progress);
    }
  }
  std::size_t wavelength() const { return wavelength_; }

 private:
  /// The halves of those that are too wide.
  std::vector<Interval> refined(const std::vector<Interval>& open, const ProgressCallback& progress) {
    std::vector<std::size_t> middles;
    for (const Interval& interval : open) middles.push_back(interval.middle());
    parts_.add_psfs(middles, std::array{wavelength_}, progress);
    std::vector<double> misfits(open.size());
    parallel_for(open.size(), [&](std::size_t i) { misfits[i] = misfit(open[i]); });
    std::vector<Interval> halves;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Interval& interval = open[i];
      if (misfits[i] <= 1) {
        parts_.remove_psf(interval.middle(), wavelength_);
        continue;
      }
      taken_.push_back(interval.middle());
      // Halves of an interval miss a quarter of it or less.
      constexpr double of_halves = 4;
      if (misfits[i] <= of_halves) continue;
      halves.push_back({interval.from, interval.middle()});
      halves.push_back({interval.middle(), interval.to});
    }
    std::sort(taken_.begin(), taken_.end());
    return halves;
  }

  /// Those between which an interval lies, and one more on either side: what cubics go through.
  std::vector<std::size_t> about(const Interval& interval) const {
    const auto from = std::lower_bound(taken_.begin(), taken_.end(), interval.from);
    return {from == taken_.begin() ? from : from - 1, std::min(from + 3, taken_.end())};
  }

  /// What the PSFs about an interval miss in its middle, over what they may.
  double misfit(const Interval& interval) const {
    constexpr double of_tolerance = 0.3, of_centre = 0.1, most_at_rim = 4;
    const LensDataTable& table = parts_.table();
    const auto height_mm = [&](std::size_t field) {
      return table.real_image_height_mm[table.index(field, wavelength_)];
    };
    const double from_mm = height_mm(interval.from), to_mm = height_mm(interval.to),
                 at_mm = height_mm(interval.middle());
    const double evenly = 1 / std::sqrt((first_intervals + 1) * frame_.share(from_mm, to_mm));
    const double allowed = of_tolerance * wanted_.tolerance * std::clamp(evenly, 1.0, most_at_rim);
    const auto kernel_by = [&](const std::vector<std::size_t>& fields) {
      return kernel_about_chief(one_wavelength(table, wavelength_, fields), at_mm, wanted_.cell_um);
    };
    const Kernel said = kernel_by(about(interval)), own = kernel_by({interval.middle()});
    // A bump of the centre's height in an interval moves light together by four times its slope.
    const double moved_mm =
        std::abs(said.moments().mean[1] - own.moments().mean[1]) * wanted_.cell_um * mm_per_um;
    return std::max(4 * moved_mm / (of_centre * wanted_.tolerance * (to_mm - from_mm)),
                    difference(said, own) / allowed);
  }

  HeightTable& parts_;
  const FrameRings frame_;
  const SpreadWanted wanted_;
  std::size_t wavelength_;
  std::vector<std::size_t> taken_;  ///< increasing
};

}  // namespace

LensDataTable build_image_table(const Lens& lens, const TableOptions& options, const SpreadWanted& wanted,
                                const ProgressCallback& progress) {
  const bool over_frame =
      options.places == TableOptions::Places::over_frame ||
      (options.places == TableOptions::Places::automatic && needs_places_over_frame(lens));
  constexpr std::size_t least_fields = 2 * first_intervals + 1;
  if (needs_places_over_frame(lens) && over_frame) {
    FrameTable parts(lens, options);
    const std::vector<std::size_t> places = PlaceChoice(parts, wanted).places({});
    std::vector<std::size_t> wavelengths(parts.table().wavelengths_nm.size());
    std::iota(wavelengths.begin(), wavelengths.end(), std::size_t{0});
    parts.add_psfs(places, wavelengths, progress);
    return std::move(parts).finished();
  }
  if (over_frame || wanted.tolerance < ImagingOptions::of_a_preview)
    return build_lens_data_table(lens, options, progress);
  TableOptions coarse = options;
  coarse.coarse = {wanted.cell_um, wanted.tolerance};
  if (static_cast<std::size_t>(options.field_count) < least_fields)
    return build_lens_data_table(lens, coarse, progress);
  HeightTable parts(lens, coarse);
  FieldChoice choice(parts, coarse, wanted);
  const std::vector<std::size_t>& fields = choice.fields({});
  std::vector<std::size_t> others;
  for (std::size_t w = 0; w < parts.table().wavelengths_nm.size(); ++w)
    if (w != choice.wavelength()) others.push_back(w);
  parts.add_psfs(fields, others, progress);
  return std::move(parts).finished();
}

}  // namespace petzval
