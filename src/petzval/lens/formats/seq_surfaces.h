// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a CODE V file.
#pragma once

#include <petzval/lens/formats/seq_glass.h>
#include <petzval/lens/formats/seq_system.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// In the unit of the file.
struct SeqSurface {
  SeqCommand command;  ///< that entered it
  double curvature = 0, thickness = 0, conic = 0;
  std::map<int, double> asphere;
  bool odd_polynomial = false;  ///< SPS ODD
  double odd_radius = 0;        ///< that r is divided by, 0 for none
  bool mirror = false;          ///< REFL
  /// GRT, GRO, GRS (length from line to line) and GRX GRY GRZ, the normal of the planes that cut the lines.
  bool ruled = false;
  double order = 0, spacing = 0;
  std::array<double, 3> ruling_normal{0, 1, 0};
  std::optional<SeqCommand> glass;  ///< the command whose first word names it
  std::optional<double> semi_diameter;
  /// What REX REY, ELX ELY, ADX ADY and ARO say: of what passes light, and of what obscures.
  struct Figure {
    std::optional<double> rectangle_x, rectangle_y, ellipse_x, ellipse_y;
    double x = 0, y = 0, turn_deg = 0;
  };
  Figure clear, obscuring;
  bool has_hole = false;               ///< HOL, in `obscuring`
  bool solves_image_distance = false;  ///< PIM
  /// XDE YDE ZDE, ADE BDE CDE, and what becomes of the axes behind the surface.
  enum class Axes { go_on, come_back, bend, turn_back, other };
  std::array<double, 6> decentre{};
  Axes axes = Axes::go_on;
};

class SeqSurfaces {
 public:
  /// Takes over a command if it is one of these; false: it is another's. \throws InputError
  bool apply(const SeqCommand& command, const SeqContext& context);

  /// Fills in the surfaces and the object distance, in mm. The aperture, fields and wavelengths are not
  /// needed.
  void put_into(Lens& lens, double mm_per_unit, const SeqContext& context, GlassLookup& glasses) const;
  /// Whether the last gap is to be solved: it says PIM and gives no distance.
  bool wants_image_distance() const;
  /// Thickness of the image surface: a shift of focus.
  double focus_shift() const { return surfaces_.empty() ? 0 : surfaces_.back().thickness; }
  /// "S3: " of the current surface, "" before the first.
  std::string where() const;
  /// The line that entered surface `i` of the lens.
  int line_of(std::size_t i) const;

 private:
  bool apply_private(const SeqCommand& command, const SeqContext& context);
  bool enter_surface(const SeqCommand& command, const SeqContext& context);
  bool apply_shape(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                   const SeqContext& context);
  void apply_special(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                     const SeqContext& context);
  void apply_coefficient(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                         const SeqContext& context);
  bool apply_grating(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                     const SeqContext& context);
  void put_grating(const SeqSurface& from, double mm_per_unit, const SeqContext& context,
                   Surface& surface) const;
  void apply_aperture(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                      const SeqContext& context);
  bool apply_decentre(SeqSurface& surface, const SeqCommand& command, std::size_t first,
                      const SeqContext& context);
  void put_apertures(const SeqSurface& from, double mm_per_unit, const SeqContext& context,
                     Surface& surface) const;
  void put_poses(Lens& lens, double mm_per_unit, const SeqContext& context) const;
  double curvature(const SeqCommand& command, std::size_t i, bool is_radius, const SeqContext& context) const;
  /// The surface that a command is for: that of its first word ("S3"), else the current one.
  std::size_t target(const SeqCommand& command, std::size_t& first_word, const SeqContext& context) const;

  bool radius_mode_ = false, in_private_ = false, ended_ = false;
  std::vector<SeqSurface> surfaces_;  ///< the object first
  std::size_t current_ = 0;
  std::optional<std::size_t> stop_;
  std::vector<double> private_wavelengths_nm_;
  PrivateGlasses private_;
};

}  // namespace petzval
