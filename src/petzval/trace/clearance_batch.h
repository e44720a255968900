// SPDX-License-Identifier: BSD-3-Clause
// By how much many rays clear the apertures at once.
#pragma once

#include <petzval/trace/batch_kernel.h>
#include <petzval/trace/pencil.h>
#include <petzval/trace/tracer.h>

#include <span>
#include <vector>

namespace petzval {

/// Tracer::Clearance::worst for the rays (u, v) of one pencil, in SIMD lanes. Holds its memory between calls;
/// one for each thread.
class ClearanceBatch {
 public:
  ClearanceBatch(const Tracer& tracer, const Pencil& pencil, Tracer::Clip clip);

  /// worst[i] for the ray (u[i], v[i]): negative inside, +infinity for a ray that does not exist or fails.
  void measure(std::span<const double> u, std::span<const double> v, std::span<double> worst);

 private:
  const Tracer& tracer_;
  Pencil pencil_;
  Tracer::Clip clip_;
  KernelPath<double> path_;
  bool iterated_;
  RayBatch rays_;
};

}  // namespace petzval
