// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/clearance_batch.h>
#include <petzval/trace/kernel_path.h>

#include <algorithm>
#include <cmath>

namespace petzval {

ClearanceBatch::ClearanceBatch(const Tracer& tracer, const Pencil& pencil, Tracer::Clip clip)
    : tracer_(tracer),
      pencil_(pencil),
      clip_(clip),
      path_(kernel_path<double>(tracer, pencil.backward(), clip)),
      iterated_(std::any_of(tracer.surfaces().begin(), tracer.surfaces().end(),
                            [](const Tracer::PreparedSurface& s) { return s.shape.is_iterated(); })) {}

void ClearanceBatch::measure(std::span<const double> u, std::span<const double> v, std::span<double> worst) {
  rays_.resize(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    // A label without a ray gets one that runs nowhere.
    const Ray ray = pencil_.ray(u[i], v[i]).value_or(Ray{{0, 0, 0}, {NAN, NAN, NAN}});
    rays_.x_mm[i] = ray.point_mm[0];
    rays_.y_mm[i] = ray.point_mm[1];
    rays_.z_mm[i] = ray.point_mm[2];
    rays_.l[i] = ray.direction[0];
    rays_.m[i] = ray.direction[1];
    rays_.n[i] = ray.direction[2];
  }
  measure_columns(path_,
                  {rays_.x_mm.data(), rays_.y_mm.data(), rays_.z_mm.data(), rays_.l.data(), rays_.m.data(),
                   rays_.n.data(), nullptr, nullptr, u.size()},
                  worst.data());
  if (!iterated_) return;
  // The lanes give up sooner than the scalar trace does.
  for (std::size_t i = 0; i < u.size(); ++i)
    if (std::isinf(worst[i])) worst[i] = pencil_.clearance(tracer_, u[i], v[i], clip_).worst;
}

}  // namespace petzval
