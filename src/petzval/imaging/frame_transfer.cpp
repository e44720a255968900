// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/frame_transfer.h>
#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/smooth_psf.h>
#include <petzval/numeric/fft.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace petzval {

namespace {

/// The transform of what a PSF sends along one axis, about its centroid, at the middles of DetailBands.
/// \param step  of the samples [pixels].
std::vector<std::complex<float>> otf_of(const std::vector<double>& light, double step) {
  double sum = 0, moment = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    sum += light[i];
    moment += double(i) * light[i];
  }
  const double centroid = moment / sum;
  // So long that straight lines between its frequencies do: of a Gaussian whose standard deviation is a
  // quarter of the PSF's window they miss 1 in 1000.
  std::size_t size = 1;
  while (size < 16 * light.size()) size *= 2;
  const RealFft2<float> fft(1, static_cast<int>(size));
  AlignedVector<float> line(fft.size());
  for (std::size_t i = 0; i < light.size(); ++i) line[i] = static_cast<float>(light[i] / sum);
  AlignedVector<std::complex<float>> spectrum(fft.spectrum_size());
  fft.forward(line, spectrum);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= std::complex<float>(std::polar(1.0, 2 * pi * double(k) * centroid / double(size)));
  std::vector<std::complex<float>> otf;
  for (std::size_t band = 0; band < DetailBands::count; ++band) {
    const double at = DetailBands::middle_cpp(band) * step * double(size);
    if (!(at < double(spectrum.size() - 1))) break;  // the samples say no more
    const auto below = static_cast<std::size_t>(at);
    const auto beyond = static_cast<float>(at - double(below));
    otf.push_back((1 - beyond) * spectrum[below] + beyond * spectrum[below + 1]);
  }
  return otf;
}

/// What a PSF sends down and across; nothing of a dark one. \param step  of its samples [pixels].
std::optional<std::array<std::vector<std::complex<float>>, 2>> otfs_of(const Psf& psf, double step) {
  const auto size = static_cast<std::size_t>(psf.size);
  std::vector<double> of_rows(size), of_columns(size);
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column) {
      const double light = double(psf.values[row * size + column]);
      of_columns[column] += light;
      of_rows[row] += light;
    }
  if (!(std::accumulate(of_rows.begin(), of_rows.end(), 0.0) > 0)) return {};
  return std::array{otf_of(of_rows, step), otf_of(of_columns, step)};
}

/// In each ring what lies along a line that makes this angle with the radius, and what across.
std::array<double, FrameZones::count> by_direction(const std::array<double, FrameZones::rings>& shares,
                                                   double square_of_cosine) {
  std::array<double, FrameZones::count> weights{};
  for (std::size_t ring = 0; ring < FrameZones::rings; ++ring) {
    weights[FrameZones::along_radius(ring)] = shares[ring] * square_of_cosine;
    weights[FrameZones::across_radius(ring)] = shares[ring] * (1 - square_of_cosine);
  }
  return weights;
}

}  // namespace

FrameTransfer::FrameTransfer(const LensDataTable& table, double wavelength_nm, const SensorGeometry& sensor) {
  const std::size_t wavelength = bracketing_wavelengths(table, wavelength_nm).front().first;
  const FrameZones zones(sensor);
  std::vector<Share> parts;
  if (table.frame) {
    // Places lie evenly; those beyond the frame by less than a mesh stand for its edge.
    const FramePlaces& frame = *table.frame;
    const double half_x = sensor.width_mm() / 2 + (frame.x_mm[1] - frame.x_mm[0]) / 2,
                 half_y = sensor.height_mm() / 2 + (frame.y_mm[1] - frame.y_mm[0]) / 2;
    for (std::size_t place = 0; place < table.places(); ++place) {
      const double x = frame.x_mm[place % frame.x_mm.size()], y = frame.y_mm[place / frame.x_mm.size()];
      const std::size_t entry = table.index(place, wavelength);
      if (std::abs(x) > half_x || std::abs(y) > half_y || table.g_source_sr[entry] == 0 ||
          !table.has_psf(entry))
        continue;
      std::array<double, FrameZones::rings> shares{};
      shares[zones.ring_at(std::hypot(x, y))] = 1;
      const double square = x * x + y * y, of_x = square > 0 ? x * x / square : 0.5;
      parts.push_back({entry, by_direction(shares, 1 - of_x), by_direction(shares, of_x)});
    }
    add(table, parts, sensor.pitch_um);
    fill_empty_zones();
    return;
  }
  std::vector<std::size_t> entries;
  for (std::size_t field = 0; field < table.fields.size(); ++field)
    if (table.has_psf(table.index(field, wavelength))) entries.push_back(table.index(field, wavelength));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto height_mm = [&](std::size_t at) { return table.real_image_height_mm[entries[at]]; };
    const double from = i == 0 ? 0 : (height_mm(i - 1) + height_mm(i)) / 2,
                 to = i + 1 == entries.size() ? std::numeric_limits<double>::infinity()
                                              : (height_mm(i) + height_mm(i + 1)) / 2;
    const std::array<double, FrameZones::rings> shares = zones.shares(from, to);
    if (std::ranges::all_of(shares, [](double share) { return share == 0; })) continue;
    parts.push_back({entries[i], by_direction(shares, 1), by_direction(shares, 0)});
  }
  add(table, parts, sensor.pitch_um);
}

void FrameTransfer::add(const LensDataTable& table, const std::vector<Share>& shares, double pitch_um) {
  std::vector<std::optional<std::array<Otf, 2>>> otfs(shares.size());
  parallel_for(shares.size(), [&](std::size_t i) {
    const Psf& psf = table.psf[shares[i].entry];
    otfs[i] = otfs_of(psf, psf.spacing_um / pitch_um);
  });
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (!otfs[i]) continue;
    auto& [down, across] = *otfs[i];
    lines_.push_back({std::move(down), shares[i].down});
    lines_.push_back({std::move(across), shares[i].across});
  }
}

void FrameTransfer::fill_empty_zones() {
  for (std::size_t zone = 0; zone < FrameZones::count; ++zone) {
    if (std::ranges::any_of(lines_, [&](const Line& line) { return line.weight[zone] > 0; })) continue;
    for (Line& line : lines_) line.weight[zone] = 1;
  }
}

std::vector<PassedWaves> FrameTransfer::passed(std::size_t zone, int cells) const {
  std::vector<PassedWaves> passed(DetailBands::count);
  double weights = 0;
  const auto apart =
      static_cast<std::ptrdiff_t>(DetailBands::a_cycle) * cells;  // of frequencies that look alike
  for (const Line& line : lines_) {
    const double weight = line.weight[zone];
    if (weight == 0) continue;
    weights += weight;
    const auto otf = [&](std::ptrdiff_t band) {
      const auto positive = static_cast<std::size_t>(band < 0 ? -1 - band : band);
      if (positive >= line.otf.size()) return std::complex<double>();
      const std::complex<double> value(line.otf[positive]);
      return band < 0 ? std::conj(value) : value;
    };
    for (std::size_t band = 0; band < passed.size(); ++band) {
      const auto at = static_cast<std::ptrdiff_t>(band);
      const std::complex<double> by_lens = otf(at);
      std::complex<double> on_cells = 0;
      const std::ptrdiff_t nearest = (at + apart / 2) / apart;
      for (std::ptrdiff_t alias = nearest - 1; alias <= nearest + 1; ++alias) {
        const std::ptrdiff_t like = at - alias * apart;
        on_cells += otf(like) * window_transform((double(like) + 0.5) * DetailBands::step_cpp / cells);
      }
      passed[band].by_lens += weight * std::norm(by_lens);
      passed[band].on_cells += weight * std::norm(on_cells);
      passed[band].both += weight * (on_cells * std::conj(by_lens)).real();
    }
  }
  if (weights > 0)
    for (PassedWaves& waves : passed) {
      waves.by_lens /= weights;
      waves.on_cells /= weights;
      waves.both /= weights;
    }
  return passed;
}

}  // namespace petzval
