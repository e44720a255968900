// SPDX-License-Identifier: BSD-3-Clause
// Surfaces as Python holds them.
#pragma once

#include <memory>

#include "bind.h"

namespace petzval::python {

/// A surface by itself, or the one at a place of a lens: then it is the lens that is altered.
class SurfaceView {
 public:
  explicit SurfaceView(Surface own) : own_(std::move(own)) {}
  SurfaceView(std::shared_ptr<Lens> lens, std::size_t place) : lens_(std::move(lens)), place_(place) {}

  /// \throws nb::index_error when the lens no longer has so many surfaces.
  Surface& get() {
    if (!lens_) return own_;
    if (place_ >= lens_->surfaces.size()) throw nb::index_error("the lens no longer has this surface");
    return lens_->surfaces[place_];
  }

 private:
  Surface own_ = {};
  std::shared_ptr<Lens> lens_ = nullptr;
  std::size_t place_ = 0;
};

/// The surfaces of a lens as a list.
struct SurfaceList {
  std::shared_ptr<Lens> lens;

  /// Of a Python index, which counts from the end below 0. \throws nb::index_error.
  std::size_t place(std::ptrdiff_t index) const {
    const auto count = static_cast<std::ptrdiff_t>(lens->surfaces.size());
    if (index < 0) index += count;
    if (index < 0 || index >= count) throw nb::index_error("the lens has no such surface");
    return static_cast<std::size_t>(index);
  }
};

/// Copies of the surfaces of a Python sequence.
std::vector<Surface> surfaces_from(const nb::iterable& surfaces);

void bind_surface(nb::module_& module);

}  // namespace petzval::python
