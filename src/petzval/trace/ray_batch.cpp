// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/ray_batch.h>

namespace petzval {

const char* to_string(RayStatus status) {
  switch (status) {
    case RayStatus::ok:
      return "ok";
    case RayStatus::missed:
      return "missed";
    case RayStatus::vignetted:
      return "vignetted";
    case RayStatus::tir:
      return "tir";
  }
  return "missed";
}

void RayBatch::resize(std::size_t count) {
  for (std::vector<double>* column : {&x_mm, &y_mm, &z_mm, &l, &m, &n, &opl_mm}) column->resize(count, 0.0);
  status.resize(count, RayStatus::ok);
  failed_at.resize(count, -1);
}

void RayBatch::push_back(double x, double y, double z, double dir_l, double dir_m, double dir_n,
                         double path_mm) {
  x_mm.push_back(x);
  y_mm.push_back(y);
  z_mm.push_back(z);
  l.push_back(dir_l);
  m.push_back(dir_m);
  n.push_back(dir_n);
  opl_mm.push_back(path_mm);
  status.push_back(RayStatus::ok);
  failed_at.push_back(-1);
}

}  // namespace petzval
