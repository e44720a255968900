// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/frame_kernels.h>
#include <petzval/imaging/place_choice.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

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

  ChosenPlaces places(const ProgressCallback& progress) {
    const std::array only{wavelength_};
    constexpr std::array grades{LatticeGrade{4, 0}, LatticeGrade{4, 1}, LatticeGrade{4, 2},
                                LatticeGrade{2, 1}};
    ChosenPlaces chosen{std::vector<std::size_t>(frame().count()), 0};
    std::iota(chosen.places.begin(), chosen.places.end(), std::size_t{0});
    for (const LatticeGrade& grade : grades) {
      const PsfLattice lattice{grade.of(frame().x_mm.size()), grade.of(frame().y_mm.size())};
      const std::vector<Mesh> meshes = meshes_of(lattice);
      if (meshes.empty()) break;
      std::vector<std::size_t> middles;
      for (const Mesh& mesh : meshes) middles.push_back(mesh.middle);
      parts_.add_psfs(places_of(lattice), only, progress);
      parts_.add_psfs(middles, only, progress);
      const Missing missing = missing_by(places_of(lattice), meshes);
      // All places miss no more than the densest lattice that was looked at.
      chosen.error = over_meshes * missing.in_middles;
      if (!missing.is_little(wanted_.tolerance)) continue;
      chosen.places = places_of(lattice);
      break;
    }
    for (std::size_t place = 0; place < frame().count(); ++place) parts_.remove_psf(place, wavelength_);
    return chosen;
  }

 private:
  /// In the middles a mixture is at its worst: over the meshes it is off by half as much, or less.
  static constexpr double over_meshes = 0.5;
  struct Missing {
    double in_middles;  ///< RMS
    double moved;       ///< by which a wall would differ, the most

    bool is_little(double tolerance) const {
      constexpr double of_centre = 0.3;
      return in_middles <= tolerance && moved <= of_centre * tolerance;
    }
  };
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
    return {table, table.wavelengths_nm[0], wanted_.cell_um, {}, wanted_.steps()};
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

  /// What the PSFs of a lattice miss of how light spreads in the middles of its meshes.
  Missing missing_by(const std::vector<std::size_t>& places, const std::vector<Mesh>& meshes) const {
    const LensDataTable few = spread_at(places);
    const FrameKernels kernels = kernels_of(few);
    const std::size_t columns = frame().x_mm.size();
    std::vector<double> squares(meshes.size()), moved(meshes.size());
    parallel_for(meshes.size(), [&](std::size_t i) {
      const std::size_t place = meshes[i].middle;
      const Kernel said = kernels.kernel_at(frame().x_mm[place % columns], frame().y_mm[place / columns]);
      const LensDataTable one = spread_about(place);
      const Kernel own = kernels_of(one).kernel_at(0, 0);
      squares[i] = meshes[i].share * std::pow(kernel_difference(said, own, wanted_.contrast), 2);
      const auto said_at = said.moments().mean, own_at = own.moments().mean;
      const double mm =
          std::hypot(said_at[0] - own_at[0], said_at[1] - own_at[1]) * wanted_.cell_um * mm_per_um;
      moved[i] = 4 * mm / meshes[i].side_mm;  // as in FieldChoice::misfit()
    });
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    return {std::sqrt(sum), *std::ranges::max_element(moved)};
  }

  FrameTable& parts_;
  const SpreadWanted wanted_;
  std::size_t wavelength_;
};

}  // namespace

ChosenPlaces choose_places(FrameTable& parts, const SpreadWanted& wanted, const ProgressCallback& progress) {
  return PlaceChoice(parts, wanted).places(progress);
}

}  // namespace petzval
