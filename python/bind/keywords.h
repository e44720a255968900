// SPDX-License-Identifier: BSD-3-Clause
// Keywords that several functions share: what they mean is said once.
#pragma once

#include <petzval/simulate/expose.h>
#include <petzval/simulate/image.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bind.h"
#include "call.h"

namespace petzval::python {

/// A sun, or text as Sun parses it: "20,15:80000".
using SunChoice = std::variant<Sun, std::string>;

/// How an image is formed.
ImageOptions image_options(const std::string& method, Maybe<double> tolerance, int supersample,
                           const std::string& surround, const std::string& interpolate,
                           const std::string& fit, Maybe<int> section, Maybe<int> transform, Maybe<int> nodes,
                           Maybe<int> tile, int layers, Maybe<double> least_scene_angle_deg,
                           Maybe<std::array<int, 2>> bands, const std::string& checkpoint);
#define PETZVAL_IMAGE_KEYWORDS                                                                         \
  nb::arg("method") = "product", nb::arg("tolerance").none() = nb::none(), nb::arg("supersample") = 0, \
  nb::arg("surround") = "error", nb::arg("interpolate") = "psf", nb::arg("fit") = "monotone",          \
  nb::arg("section").none() = nb::none(), nb::arg("transform").none() = nb::none(),                    \
  nb::arg("nodes").none() = nb::none(), nb::arg("tile").none() = nb::none(), nb::arg("layers") = 0,    \
  nb::arg("least_scene_angle_deg").none() = nb::none(), nb::arg("bands").none() = nb::none(),          \
  nb::arg("checkpoint") = ""

/// Light that goes astray.
FlareOptions flare_options(const std::vector<SunChoice>& suns, bool ghosts, bool starburst,
                           double ghost_threshold, double ghost_neglect, int ghost_reflections,
                           const Maybe<std::string>& scatter, const std::string& scatter_surround);
#define PETZVAL_FLARE_KEYWORDS                                                                         \
  nb::arg("suns") = std::vector<SunChoice>(), nb::arg("ghosts") = false, nb::arg("starburst") = false, \
  nb::arg("ghost_threshold") = SourceSearch().threshold,                                               \
  nb::arg("ghost_neglect") = FlareOptions().neglected_share, nb::arg("ghost_reflections") = 2,         \
  nb::arg("scatter").none() = nb::none(), nb::arg("scatter_surround") = "dark"

/// How a sensor is exposed once.
ExposeOptions expose_options(const nb::object& exposure, const std::string& metering, double compensation_ev,
                             const std::string& gain_mode, double analog_gain, Maybe<double> temperature_c,
                             Maybe<std::uint64_t> serial, const std::vector<std::string>& without,
                             const Numbers& bracket_ev, const std::string& illuminant, Maybe<double> f_number,
                             Maybe<double> exit_pupil_mm, const std::string& date_time);
#define PETZVAL_EXPOSE_KEYWORDS                                                                           \
  nb::arg("exposure") = "auto", nb::arg("metering") = "highlights", nb::arg("compensation_ev") = 0.0,     \
  nb::arg("gain_mode") = "", nb::arg("analog_gain") = 1.0, nb::arg("temperature_c").none() = nb::none(),  \
  nb::arg("serial").none() = nb::none(), nb::arg("without") = std::vector<std::string>(),                 \
  nb::arg("bracket_ev") = Numbers(), nb::arg("illuminant") = "", nb::arg("f_number").none() = nb::none(), \
  nb::arg("exit_pupil_mm").none() = nb::none(), nb::arg("date_time") = ""

/// How a call works.
#define PETZVAL_CALL_KEYWORDS nb::arg("threads") = 0, nb::arg("progress").none() = nb::none()
#define PETZVAL_SEEDED_CALL_KEYWORDS \
  nb::arg("threads") = 0, nb::arg("seed") = 1, nb::arg("progress").none() = nb::none()

}  // namespace petzval::python
