// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/target/exact_sfr.h>

#include <cmath>

namespace petzval {

namespace {

constexpr int last_step = 100;

double signed_sfr(const Otf& otf, const TargetOptions& options, double cpp, double normal_rad) {
  const std::complex<double> value =
      transfer(otf, options, cpp * std::cos(normal_rad), cpp * std::sin(normal_rad));
  // Symmetric optics have a real transfer function, whose sign tells reversed contrast.
  return std::abs(value.imag()) < 1e-12 ? value.real() : std::abs(value);
}

void require_few_edges(const TargetScene& scene) {
  constexpr std::size_t most = 20000;
  std::size_t count = 0;
  for (const Polygon& polygon : scene.polygons)
    for (const Contour& contour : polygon.contours) count += contour.size();
  if (count > most)
    throw InputError(fmt::format("{} edges would make a table of {} rows; up to {} edges are right", count,
                                 (last_step + 1) * count, most));
}

}  // namespace

std::vector<ExactSfr> exact_sfr(const TargetScene& scene, const Otf& otf, const TargetOptions& options) {
  require_few_edges(scene);
  std::vector<ExactSfr> edges;
  for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
    std::size_t index = 0;
    for (const Contour& contour : scene.polygons[p].contours)
      for (std::size_t i = 0; i < contour.size(); ++i) {
        check_stop();
        const Vertex &a = contour[i], &b = contour[(i + 1) % contour.size()];
        ExactSfr edge{p + 1,
                      ++index,
                      std::atan2(b.y - a.y, b.x - a.x) * 180 / pi,
                      std::hypot(b.x - a.x, b.y - a.y),
                      {}};
        const double normal_rad = (edge.angle_deg - 90) * pi / 180;
        for (int step = 0; step <= last_step; ++step)
          edge.sfr.push_back(signed_sfr(otf, options, step / 100.0, normal_rad));
        edges.push_back(std::move(edge));
      }
  }
  return edges;
}

std::string exact_sfr_csv(const std::vector<ExactSfr>& edges) {
  std::string text = "polygon,edge,angle_deg,length_px,frequency_cpp,sfr\n";
  for (const ExactSfr& edge : edges)
    for (std::size_t step = 0; step < edge.sfr.size(); ++step)
      text += fmt::format("{},{},{:.6f},{:.4f},{:.2f},{:.10f}\n", edge.polygon, edge.edge, edge.angle_deg,
                          edge.length_px, static_cast<double>(step) / 100.0, edge.sfr[step]);
  return text;
}

double mtf50_cpp(const Otf& otf, const TargetOptions& options) {
  double cpp = 0;
  while (cpp < 4 && std::abs(transfer(otf, options, cpp, 0)) > 0.5) cpp += 1e-4;
  return cpp;
}

}  // namespace petzval
