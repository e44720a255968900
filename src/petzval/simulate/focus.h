// SPDX-License-Identifier: BSD-3-Clause
// Where the sensor stands, for every command and every way to the sensor.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>
#include <string>
#include <string_view>

namespace petzval {

/// What a camera is focused on.
///
///     camera.focus = Focus::at_m(1.2);
///     camera.focus = Focus::parse("1.2m+best-mtf@40");
struct Focus {
  enum class Kind {
    automatic,  ///< what is in front of the camera: the scene's distance, or the middle of its depths
    design,     ///< the sensor stays where the prescription has it
    infinity,
    distance,   ///< an object this far from the sensor plane
    paraxial,   ///< the sensor stands in the paraxial image of the lens's object
    best_spot,  ///< the least RMS spot over the lens's fields and wavelengths
    best_mtf    ///< the greatest mean MTF over them
  };
  Kind kind = Kind::automatic;
  /// Of Kind::distance, from the sensor plane; of the last three the object that they are sought for, inf: at
  /// infinity, 0: the lens's own.
  double distance_m = 0;
  double frequency_cpmm = 0;  ///< of Kind::best_mtf [cycles/mm]

  static Focus automatic() { return {}; }
  static Focus design() { return {Kind::design}; }
  static Focus infinity() { return {Kind::infinity}; }
  /// At infinity if the distance is. \throws InputError unless it is positive.
  static Focus at_m(double distance_m);

  /// "auto", "design", "infinity", a distance with its unit ("1.2m", "250mm"), "paraxial", "best-spot" or
  /// "best-mtf@40"; one of the last three of an object at a distance is "1.2m+best-spot".
  /// \throws InputError saying what would be right.
  static Focus parse(std::string_view text);
  /// What parse() takes.
  std::string text() const;

  /// Whether the place of the sensor is sought by what the lens does to light.
  bool sought() const { return kind >= Kind::paraxial; }
  bool operator==(const Focus&) const = default;
};

/// The object distance that a focus asks for [m], infinite for infinity; nothing where it names none.
std::optional<double> asked_distance_m(const Focus& focus);

}  // namespace petzval
