// SPDX-License-Identifier: BSD-3-Clause
// A tracer's surfaces in the order of travel, for the batch kernel.
#pragma once

#include <petzval/trace/batch_kernel.h>
#include <petzval/trace/tracer.h>

namespace petzval {

/// T is double or float.
template <class T>
KernelPath<T> kernel_path(const Tracer& tracer, bool backward, Tracer::Clip clip);

}  // namespace petzval
