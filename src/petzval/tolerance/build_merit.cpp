// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/spot_moments.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/tolerance/build_merit.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

constexpr PupilSampling sampling{8, 48};

/// Points that share an azimuth share their tracers.
struct AzimuthFields {
  double azimuth_deg;
  std::vector<double> fields;
  std::vector<std::size_t> points;
};

std::vector<AzimuthFields> by_azimuth(const std::vector<FieldPoint>& points) {
  std::vector<AzimuthFields> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto same = [&](const AzimuthFields& each) { return each.azimuth_deg == points[i].azimuth_deg; };
    auto group = std::ranges::find_if(groups, same);
    if (group == groups.end()) group = groups.insert(groups.end(), {points[i].azimuth_deg, {}, {}});
    group->fields.push_back(points[i].field);
    group->points.push_back(i);
  }
  return groups;
}

FieldTableRequest request_of(const JudgeRequest& request, const AzimuthFields& group) {
  FieldTableRequest at = request.at;
  at.fields = group.fields;
  at.azimuth_deg = group.azimuth_deg;
  return at;
}

/// The spot of every point, all wavelengths alike.
std::vector<SpotMoments> spots_of(const Lens& lens, const JudgeRequest& request,
                                  const std::vector<AzimuthFields>& groups, std::size_t points) {
  const std::size_t wavelengths = request.at.wavelengths_nm.size();
  const std::vector<double> shares(wavelengths, 1.0 / static_cast<double>(wavelengths));
  std::vector<SpotMoments> spots(points);
  for (const AzimuthFields& group : groups) {
    const std::vector<SpotMoments> rows = field_rows<SpotMoments>(
        lens, request_of(request, group),
        [](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<SpotMoments> {
          const std::vector<PupilRay> rays = light_rays(tracer, chief, sampling);
          if (rays.empty()) return {};
          return spot_moments(rays, chief, RayWeight::light);
        });
    for (std::size_t f = 0; f < group.points.size(); ++f)
      spots[group.points[f]] = mixed(std::span(rows).subspan(f * wavelengths, wavelengths), shares);
  }
  return spots;
}

std::vector<double> mtf_at_points(const Lens& lens, const JudgeRequest& request,
                                  const std::vector<AzimuthFields>& groups, std::size_t points,
                                  double shift_mm) {
  MtfOptions options;
  options.frequencies_cpmm = {request.merit.frequency_cpmm};
  options.weights.assign(request.at.wavelengths_nm.size(), 1);
  options.sensor_shifts_mm = {shift_mm};
  options.detail = PupilDetail::quick();
  std::vector<double> values(points);
  for (const AzimuthFields& group : groups) {
    const std::vector<MtfRow> rows = mtf_table(lens, request_of(request, group), options);
    for (std::size_t f = 0; f < group.points.size(); ++f)
      values[group.points[f]] = 0.5 * (rows[f].tangential + rows[f].sagittal);
  }
  return values;
}

}  // namespace

std::string Merit::name() const {
  return kind == Kind::rms_spot ? "RMS spot" : fmt::format("MTF at {:g}/mm", frequency_cpmm);
}

std::vector<FieldPoint> points_of(const Lens& lens, const JudgeRequest& request) {
  const FieldTableRequest at = with_own_lists(request.at, lens);
  if (request.azimuths_deg.empty()) throw InputError("there are no azimuths; 0,90,180,270 would be right");
  std::vector<FieldPoint> points;
  for (const double field : at.fields) {
    for (const double azimuth : request.azimuths_deg) {
      if (!std::isfinite(azimuth)) throw InputError("an azimuth is not finite; degrees would be right");
      points.push_back({field, azimuth});
      if (field == 0) break;
    }
    if (field == 0) points.back().azimuth_deg = request.azimuths_deg.front();
  }
  return points;
}

Judgement judge(const Lens& lens, const JudgeRequest& asked) {
  JudgeRequest request = asked;
  request.at = with_own_lists(request.at, lens);
  const std::vector<FieldPoint> points = points_of(lens, request);
  const std::vector<AzimuthFields> groups = by_azimuth(points);
  const std::vector<SpotMoments> spots = spots_of(lens, request, groups, points.size());
  Judgement judgement;
  judgement.refocus_mm = request.refocus ? best_shift_mm(spots) : 0;
  const double count = static_cast<double>(points.size());
  if (request.merit.kind == Merit::Kind::mtf) {
    judgement.at_points = mtf_at_points(lens, request, groups, points.size(), judgement.refocus_mm);
    judgement.overall = std::accumulate(judgement.at_points.begin(), judgement.at_points.end(), 0.0) / count;
    judgement.worst = std::ranges::min(judgement.at_points);
    return judgement;
  }
  double sum = 0;
  for (const SpotMoments& spot : spots) {
    const double variance = spot.variance(judgement.refocus_mm);
    judgement.at_points.push_back(std::sqrt(variance) * um_per_mm);
    sum += variance;
  }
  judgement.overall = std::sqrt(sum / count) * um_per_mm;
  judgement.worst = std::ranges::max(judgement.at_points);
  return judgement;
}

}  // namespace petzval
