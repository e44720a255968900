// SPDX-License-Identifier: BSD-3-Clause
// The camera as Python holds it: it refers to its lens and sensor, as Python's objects do.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bind.h"

namespace petzval::python {

struct CameraInPython {
  std::shared_ptr<Lens> lens;      ///< null: that of the three-dimensional scene
  std::shared_ptr<Sensor> sensor;  ///< null: what fits the scene
  Focus focus = {};
  std::optional<double> f_number = {};
  std::optional<StopBlades> blades = {};
  std::optional<double> image_distance_mm = {};
  double move_lens_mm = 0;
  std::optional<double> focus_wavelength_nm = {};
  double defocus_mm = 0;
  Camera::Apertures apertures = Camera::Apertures::as_given;
  Losses losses = {};

  /// A copy of all of it, which other threads do not alter. \throws InputError unless the lens is valid.
  Camera value() const;
};

/// A Lens or the name of one; None: null.
std::shared_ptr<Lens> lens_from(const nb::object& lens);
std::shared_ptr<Sensor> sensor_from(const nb::object& sensor);

/// The lens of a Camera as it is used, or a Lens as it stands. \throws InputError unless it is valid.
Lens lens_to_look_at(const nb::object& lens_or_camera);

/// The class of lens data tables; it has a maker that takes a Camera.
void bind_table(nb::module_& module);
nb::class_<TableCamera> bind_table_camera(nb::module_& module);
void bind_clip(nb::class_<CameraInPython>& camera, nb::class_<TableCamera>& table_camera,
               nb::module_& module);
void bind_render(nb::class_<CameraInPython>& camera, nb::module_& module);
void bind_selection(nb::class_<CameraInPython>& camera, nb::module_& module);

}  // namespace petzval::python
