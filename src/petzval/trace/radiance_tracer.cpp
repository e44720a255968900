// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/kernel_path.h>
#include <petzval/trace/radiance_tracer.h>

namespace petzval {

void RadianceRays::resize(std::size_t count) {
  for (std::vector<float>* column : {&x_mm, &y_mm, &z_mm, &l, &m, &n}) column->resize(count, 0.0f);
  passes.resize(count, 0);
}

RadianceTracer::RadianceTracer(const Tracer& tracer, Direction direction, Tracer::Clip clip)
    : path_(kernel_path<float>(tracer, direction == Direction::backward, clip)) {}

void RadianceTracer::trace(RadianceRays& rays) const {
  trace_columns(path_,
                RayColumns<float>{rays.x_mm.data(), rays.y_mm.data(), rays.z_mm.data(), rays.l.data(),
                                  rays.m.data(), rays.n.data(), nullptr, rays.passes.data(), rays.size()});
}

}  // namespace petzval
