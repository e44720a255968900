// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/mtf.h>
#include <petzval/base/stop.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

void check(const FieldTableRequest& request, const MtfOptions& options) {
  if (options.frequencies_cpmm.empty())
    throw InputError("`frequencies_cpmm` is empty; spatial frequencies in cycles/mm would be right");
  for (const double frequency : options.frequencies_cpmm)
    if (!(frequency >= 0) || !std::isfinite(frequency))
      throw InputError(fmt::format("a spatial frequency of {:g} cycles/mm; it must be 0 or more", frequency));
  for (const double shift : options.sensor_shifts_mm)
    if (!std::isfinite(shift)) throw InputError("a sensor shift is not finite; give mm");
  if (options.weights.empty()) return;
  if (options.weights.size() != request.wavelengths_nm.size())
    throw InputError(fmt::format("{} weights for {} wavelengths; give one a wavelength",
                                 options.weights.size(), request.wavelengths_nm.size()));
  double sum = 0;
  for (const double weight : options.weights) {
    if (!(weight >= 0) || !std::isfinite(weight))
      throw InputError(fmt::format("a weight of {:g}; weights must be 0 or more", weight));
    sum += weight;
  }
  if (!(sum > 0)) throw InputError("all weights are zero; at least one wavelength must count");
}

/// Both OTFs of a field and wavelength on one sensor, frequency by frequency.
struct SensorOtf {
  std::array<double, 2> image_mm{};  ///< of the chief ray: x', y'
  std::vector<std::complex<double>> tangential, sagittal;
};

struct OtfRow {
  double field = 0, wavelength_nm = 0;
  std::vector<SensorOtf> sensors;  ///< [sensor shift]
};

template <class Otf>
SensorOtf fill(const std::vector<double>& frequencies, const std::array<double, 2>& image_mm, Otf&& otf) {
  SensorOtf result;
  result.image_mm = image_mm;
  for (const double frequency : frequencies) {
    check_stop();
    result.tangential.push_back(otf(MtfDirection::tangential, frequency));
    result.sagittal.push_back(otf(MtfDirection::sagittal, frequency));
  }
  return result;
}

/// Where rays are on a sensor behind the image surface, from the chief ray's point there.
std::vector<PupilRay> on_moved_sensor(std::vector<PupilRay> rays, const ChiefRay& chief, double shift_mm) {
  const std::array<double, 3>& direction = chief.at_image.direction;
  const double chief_slope = direction[1] / direction[2], chief_slope_x = direction[0] / direction[2];
  for (PupilRay& ray : rays) {
    const double gamma = std::sqrt(1 - ray.alpha * ray.alpha - ray.beta * ray.beta);
    ray.x_mm += shift_mm * (ray.alpha / gamma - chief_slope_x);
    ray.y_mm += shift_mm * (ray.beta / gamma - chief_slope);
  }
  return rays;
}

/// How far two OTFs of the same frequencies differ, at most.
double difference(const std::vector<SensorOtf>& a, const std::vector<SensorOtf>& b) {
  double most = 0;
  for (std::size_t s = 0; s < a.size(); ++s)
    for (std::size_t k = 0; k < a[s].tangential.size(); ++k)
      most = std::max({most, std::abs(a[s].tangential[k] - b[s].tangential[k]),
                       std::abs(a[s].sagittal[k] - b[s].sagittal[k])});
  return most;
}

/// By rays alone, twice as many each way until that makes no difference: the more periods of the pattern fit
/// into the spot, the more rays it takes. \returns empty where no ray passes.
template <class Place>
std::vector<SensorOtf> geometric_otfs(const FieldTracer& tracer, const ChiefRay& chief,
                                      const std::vector<double>& frequencies,
                                      const std::vector<double>& shifts, Place&& image_mm) {
  constexpr double close = 1e-5;
  constexpr PupilSampling first{32, 192};
  constexpr int most_radial_nodes = 512;  // enough for a hundred periods in the spot, where little is left
  std::vector<SensorOtf> coarse;
  for (PupilSampling at = first; at.radial_nodes <= most_radial_nodes;
       at.radial_nodes *= 2, at.azimuths *= 2) {
    check_stop();
    const std::vector<PupilRay> rays = light_rays(tracer, chief, at);
    if (rays.empty()) return {};
    std::vector<SensorOtf> fine;
    for (const double shift : shifts) {
      check_stop();
      const std::vector<PupilRay> moved = on_moved_sensor(rays, chief, shift);
      fine.push_back(fill(frequencies, image_mm(shift), [&](MtfDirection direction, double frequency) {
        return geometric_otf(moved, direction, frequency);
      }));
    }
    const bool done = !coarse.empty() && difference(coarse, fine) < close;
    coarse = std::move(fine);
    if (done) break;
  }
  return coarse;
}

std::optional<OtfRow> otf_row(const FieldTracer& tracer, const ChiefRay& chief, const MtfOptions& options) {
  const std::vector<double>& frequencies = options.frequencies_cpmm;
  const std::vector<double> shifts =
      options.sensor_shifts_mm.empty() ? std::vector<double>{0} : options.sensor_shifts_mm;
  const std::array<double, 3>& direction = chief.at_image.direction;
  const auto image_mm = [&](double shift) {
    return std::array{chief.image_x_mm + shift * (direction[0] / direction[2]),
                      chief.image_height_mm + shift * (direction[1] / direction[2])};
  };
  OtfRow row;
  if (options.geometric) {
    row.sensors = geometric_otfs(tracer, chief, frequencies, shifts, image_mm);
    if (row.sensors.empty()) return {};
    return row;
  }
  std::optional<ExitPupil> pupil = ExitPupil::of(tracer, chief, options.detail);
  if (!pupil) return {};
  std::vector<std::optional<ExitPupilFit>> fits = ExitPupilFit::of(*pupil, options.model, shifts);
  PupilDetail detail = options.detail, more = detail.with_more_rays();
  while (more != detail && std::ranges::any_of(fits, [](const auto& fit) { return !fit; })) {
    detail = std::exchange(more, more.with_more_rays());
    pupil = ExitPupil::of(tracer, chief, detail);
    fits = ExitPupilFit::of(*pupil, options.model, shifts);
  }
  for (std::size_t s = 0; s < shifts.size(); ++s) {
    check_stop();
    const double shift = shifts[s];
    if (!fits[s] && shift != 0)
      throw InputError(
          fmt::format("{}: the wave at field {:g} is too rough to be moved by {:g} mm; set the "
                      "last thickness instead",
                      tracer.lens().name, chief.object_field, shift));
    PupilOverlap overlap =
        fits[s] ? PupilOverlap(tracer, *pupil, *fits[s]) : PupilOverlap(tracer, *pupil, options.model);
    row.sensors.push_back(fill(frequencies, image_mm(shift), [&](MtfDirection direction, double frequency) {
      return overlap.otf(direction, frequency);
    }));
  }
  return row;
}

/// One field over all its wavelengths, each at its own height.
SensorOtf polychromatic(const OtfRow* rows, std::size_t sensor, const MtfOptions& options) {
  const std::size_t frequencies = options.frequencies_cpmm.size();
  SensorOtf result;
  result.tangential.resize(frequencies);
  result.sagittal.resize(frequencies);
  double sum = 0;
  for (const double weight : options.weights) sum += weight;
  for (std::size_t w = 0; w < options.weights.size(); ++w) {
    const SensorOtf& otf = rows[w].sensors[sensor];
    const std::array<double, 2>& first_mm = rows[0].sensors[sensor].image_mm;
    const double beside_mm = otf.image_mm[0] - first_mm[0], above_mm = otf.image_mm[1] - first_mm[1];
    for (std::size_t k = 0; k < frequencies; ++k) {
      const double share = options.weights[w] / sum, frequency = options.frequencies_cpmm[k];
      result.tangential[k] += share * otf.tangential[k] * std::polar(1.0, -2 * pi * frequency * above_mm);
      result.sagittal[k] += share * otf.sagittal[k] * std::polar(1.0, -2 * pi * frequency * beside_mm);
    }
  }
  return result;
}

}  // namespace

std::complex<double> diffraction_otf(const FieldTracer& tracer, const ExitPupil& pupil,
                                     MtfDirection direction, double frequency_cpmm, const PupilModel& model) {
  return PupilOverlap(tracer, pupil, model).otf(direction, frequency_cpmm);
}

std::complex<double> diffraction_otf(const FieldTracer& tracer, const ExitPupil& pupil,
                                     const ExitPupilFit& smooth, MtfDirection direction,
                                     double frequency_cpmm) {
  return PupilOverlap(tracer, pupil, smooth).otf(direction, frequency_cpmm);
}

std::complex<double> geometric_otf(const std::vector<PupilRay>& rays, MtfDirection direction,
                                   double frequency_cpmm) {
  std::complex<double> sum = 0;
  double total = 0;
  for (const PupilRay& ray : rays) {
    total += ray.entrance_measure;
    if (direction == MtfDirection::tangential)
      sum += std::polar(ray.entrance_measure, -2 * pi * frequency_cpmm * ray.y_mm);
    else if (ray.mirrored)  // with its mirror image the phases cancel to a cosine
      sum += ray.entrance_measure * std::cos(2 * pi * frequency_cpmm * ray.x_mm);
    else
      sum += std::polar(ray.entrance_measure, -2 * pi * frequency_cpmm * ray.x_mm);
  }
  return sum / total;
}

std::vector<MtfRow> mtf_table(const Lens& lens, const FieldTableRequest& request, const MtfOptions& options) {
  check(request, options);
  const std::vector<OtfRow> otfs = field_rows<OtfRow>(
      lens, request,
      [&](const FieldTracer& tracer, const ChiefRay& chief) { return otf_row(tracer, chief, options); });
  std::vector<MtfRow> rows;
  const auto add = [&](const OtfRow& at, double wavelength_nm, double shift_mm, const SensorOtf& otf) {
    for (std::size_t k = 0; k < options.frequencies_cpmm.size(); ++k)
      rows.push_back({at.field, wavelength_nm, options.frequencies_cpmm[k], std::abs(otf.tangential[k]),
                      std::abs(otf.sagittal[k]), shift_mm});
  };
  for (std::size_t s = 0; s < std::max<std::size_t>(options.sensor_shifts_mm.size(), 1); ++s) {
    const double shift_mm = options.sensor_shifts_mm.empty() ? 0 : options.sensor_shifts_mm[s];
    if (options.weights.empty())
      for (const OtfRow& row : otfs) add(row, row.wavelength_nm, shift_mm, row.sensors[s]);
    else
      for (std::size_t i = 0; i < otfs.size(); i += options.weights.size())
        add(otfs[i], 0, shift_mm, polychromatic(&otfs[i], s, options));
  }
  return rows;
}

}  // namespace petzval
