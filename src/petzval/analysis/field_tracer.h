// SPDX-License-Identifier: BSD-3-Clause
// Chief rays, pupils and illumination of a lens at one wavelength.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/losses.h>
#include <petzval/trace/pencil.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <optional>

namespace petzval {

/// The real chief ray of one object field.
struct ChiefRay {
  double object_field = 0;       ///< degrees (object at infinity) or object height in mm
  double v = 0;                  ///< its label in Pencil
  double image_height_mm = 0;    ///< y' on the image surface, signed
  double u = 0, image_x_mm = 0;  ///< 0 of a centred lens: label, and x' on the image surface
  Ray at_image;
};

/// A lens at one wavelength, asked field by field. Object fields are degrees when the object is at infinity,
/// else object heights in mm. From several threads at once all but chief_ray() may be asked, which remembers
/// the last one.
class FieldTracer {
 public:
  /// \param clip  apertures: every clear aperture counts; stop_only: --ignore-apertures.
  /// \param azimuth_deg  of the fields, anticlockwise from +y as seen from the film. All else here is in axes
  /// turned with them, so that the field lies in the y-z plane. \throws InputError as Tracer.
  FieldTracer(const Lens& lens, double wavelength_nm, Tracer::Clip clip = Tracer::Clip::apertures,
              double azimuth_deg = 0);
  FieldTracer(const FieldTracer&) = delete;
  FieldTracer& operator=(const FieldTracer&) = delete;

  /// From now on g_sensor, g_source and the waves of PSFs count these losses. \throws InputError as
  /// LensTransmittance.
  void set_losses(const Losses& losses);

  const Lens& lens() const { return lens_; }
  const Tracer& tracer() const { return tracer_; }
  /// Of the losses that were set; null: none are counted.
  const LensTransmittance* transmittance() const { return transmittance_ ? &*transmittance_ : nullptr; }
  Tracer::Clip clip() const { return clip_; }

  /// Nothing where no chief ray reaches the image surface. Of a lens with poses it goes through the middle of
  /// the stop where that stands.
  std::optional<ChiefRay> chief_ray(double object_field);
  /// Where the chief ray of an object lands [mm]: x' and y', in the axes of all else here. \param object_x,
  /// object_y  its field as a vector: the angle from the axis [degrees], or the place in its plane [mm].
  /// Nothing where no chief ray reaches the image surface.
  std::optional<std::array<double, 2>> landing_mm(double object_x, double object_y);
  /// The vignetted pupil in object space; nothing where no ray passes.
  std::optional<PupilBoundary> object_pupil(const ChiefRay& chief, int azimuths = default_azimuths) const;
  /// The same with a round stop, whatever its blades.
  std::optional<PupilBoundary> round_object_pupil(const ChiefRay& chief, int azimuths) const;
  /// object_pupil() seen from the chief ray's image point.
  std::optional<PupilBoundary> image_pupil(const ChiefRay& chief, int azimuths = default_azimuths) const;

  /// Whether image_pupil is all the light that reaches the chief ray's image point: the pupil neither falls
  /// into parts nor has a hole. By a grid of rays; parts smaller than a hundredth of its width go unseen.
  bool image_pupil_in_one_piece(const ChiefRay& chief) const;

  /// (n'/n)² ∬ dα dβ over the directions that reach the object through every aperture [sr]: what a uniform
  /// wall of unit radiance gives in irradiance at the chief ray's image point; 0 where no ray passes.
  double g_sensor_sr(const ChiefRay& chief) const;
  /// The flux of one object point per area of its chief-ray image, per radiance [sr]; 0 where no ray passes.
  /// (docs/CONVENTIONS.md, "Radiometry".)
  double g_source_sr(const ChiefRay& chief);
  /// ∬ T dq over the object pupil [mm² or sr]: g_source without object_area_per_image_area(); 0 where no ray
  /// passes.
  double object_flux(const ChiefRay& chief) const;

  /// ∬ T du dv over a pupil, T of the losses that are counted, in the unit of PupilBoundary::area().
  double lit_area(const Pencil& pencil, const PupilBoundary& pupil) const;

  /// dA_object/dA_chief: solid angle [sr/mm²] (infinity) or object area [mm²/mm²] per area of chief-ray
  /// image. \throws InputError where the chief ray's image stops moving outwards.
  double object_area_per_image_area(const ChiefRay& chief);

  /// The smallest object field whose chief ray lands at this image height (signed as object fields give it).
  /// Nothing if no chief ray does.
  std::optional<double> object_field_at_image_height(double image_height_mm);

  static constexpr int default_azimuths = 256;

 private:
  Pencil image_pencil(const ChiefRay& chief) const;
  /// Of a lens with poses: turns the designed lens's chief ray into that of a tracer.
  std::optional<ChiefRay> aimed_chief(const Tracer& tracer, ChiefRay chief) const;
  /// Where the chief ray lands (x', y') of an object in this direction, or at this place [mm].
  std::optional<std::array<double, 2>> image_of(double across, double along, double forward);
  double object_area_by_neighbours(const ChiefRay& chief);

  Lens lens_;
  Tracer tracer_;
  std::optional<Tracer> designed_;  ///< of a lens with poses: without them, where the chief ray is sought
  Tracer::Clip clip_;
  ChiefRayMarch march_;
  std::optional<LensTransmittance> transmittance_;  ///< nothing: no loss
};

}  // namespace petzval
