// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/mass_spreading.h>
#include <petzval/numeric/spreading_kernel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/numeric/mass_spreading.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

/// SpreadingKernel::values(), for this instruction set.
void kernel_values(const SpreadingKernel& kernel, double offset, double* out) {
  constexpr int lanes = SpreadingKernel::lanes;
  const double t = 2 * offset - 1;
  const double* highest = kernel.coefficients(SpreadingKernel::degree);
  for (int i = 0; i < lanes; ++i) out[i] = highest[i];
  for (int power = SpreadingKernel::degree - 1; power >= 0; --power) {
    const double* coefficients = kernel.coefficients(power);
    for (int i = 0; i < lanes; ++i) out[i] = out[i] * t + coefficients[i];
  }
}

void spread(const SpreadMass& mass, int first, int last, double* cells, std::ptrdiff_t stride) {
  const SpreadingKernel& kernel = spreading_kernel();
  double across[SpreadingKernel::lanes], down[SpreadingKernel::lanes];
  kernel_values(kernel, mass.across_offset, across);
  kernel_values(kernel, mass.down_offset, down);
  for (int row = first; row < last; ++row, cells += stride) {
    const double weight = down[row] * mass.mass;
    for (int i = 0; i < SpreadingKernel::lanes; ++i) cells[i] += weight * across[i];
  }
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(spread);

void spread_mass(const SpreadMass& mass, int first, int last, double* cells, std::ptrdiff_t stride) {
  HWY_DYNAMIC_DISPATCH(spread)(mass, first, last, cells, stride);
}

}  // namespace petzval
#endif
