// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/trace/kernel_path.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// The radius ρ, a power of two, at which no term of the polynomial is larger than ρ itself.
double polynomial_unit_mm(const std::vector<double>& terms) {
  double unit = std::numeric_limits<double>::infinity();
  for (std::size_t p = 2; p < terms.size(); ++p)
    if (terms[p] != 0) unit = std::min(unit, std::pow(std::abs(terms[p]), -1 / (static_cast<double>(p) - 1)));
  return std::isfinite(unit) && unit > 0 ? std::exp2(std::floor(std::log2(unit))) : 1.0;
}

/// Even powers by themselves, and in a unit in which the coefficients neither overflow nor vanish in float.
void pack_powers(ShapeData<double>& shape) {
  const std::vector<double> terms = std::move(shape.terms);
  bool even = true;
  for (std::size_t p = 1; p < terms.size(); p += 2) even = even && terms[p] == 0;
  const std::size_t step = even ? 2 : 1;
  const double unit = polynomial_unit_mm(terms);
  shape.form = even ? ShapeForm::even_powers : ShapeForm::powers;
  shape.terms.clear();
  for (std::size_t p = 0; p < terms.size(); p += step)
    shape.terms.push_back(terms[p] * std::pow(unit, static_cast<double>(p)));
  shape.per_unit = even ? 1 / (unit * unit) : 1 / unit;
}

template <class T>
ShapeData<T> kernel_shape(ShapeData<double> from) {
  if (from.form == ShapeForm::powers) pack_powers(from);
  return {from.form,
          from.added,
          static_cast<T>(from.curvature),
          static_cast<T>(from.conic),
          static_cast<T>(from.one_plus_conic),
          std::vector<T>(from.terms.begin(), from.terms.end()),
          static_cast<T>(from.per_unit)};
}

template <class T>
KernelFrame<T> kernel_frame(const Frame& from, double flip) {
  const double sign[3] = {1, 1, flip};
  KernelFrame<T> frame;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.offset_mm[i] = static_cast<T>(sign[i] * from.offset_mm[i]);
    for (std::size_t k = 0; k < 3; ++k)
      frame.rows[i][k] = static_cast<T>(sign[i] * sign[k] * from.rows[i][k]);
  }
  return frame;
}

template <class T>
KernelAperture<T> kernel_aperture(const ApertureFigure& from) {
  const double turn = radians(from.rotation_deg), c = std::cos(turn), s = std::sin(turn);
  const double a = c / from.half_width_x_mm, b = s / from.half_width_x_mm;
  const double e = -s / from.half_width_y_mm, f = c / from.half_width_y_mm;
  return {from.kind == ApertureFigure::Kind::rectangle,
          from.obscures,
          static_cast<T>(a),
          static_cast<T>(b),
          static_cast<T>(e),
          static_cast<T>(f),
          static_cast<T>(-(a * from.decentre_x_mm + b * from.decentre_y_mm)),
          static_cast<T>(-(e * from.decentre_x_mm + f * from.decentre_y_mm))};
}

/// \param flip  −1 where the sense of travel is against +z.
template <class T>
KernelSurface<T> kernel_surface(const Tracer::PreparedSurface& from, bool backward, double flip,
                                double clip_radius_sq) {
  const double before = backward ? from.index_after : from.index_before;
  const double ratio = from.bend     ? 1
                       : from.mirror ? -1
                                     : before / (backward ? from.index_before : from.index_after);
  KernelSurface<T> surface;
  surface.shape = kernel_shape<T>(from.shape);
  surface.flip = static_cast<T>(flip);
  surface.posed = from.posed;
  surface.frame = kernel_frame<T>(from.frame, flip);
  surface.mirror = from.mirror;
  surface.clips = std::isfinite(clip_radius_sq);
  surface.clear_radius_sq = surface.clips ? static_cast<T>(clip_radius_sq) : T(0);
  // Boundaries are sought at the rim itself.
  surface.per_clear_radius_sq =
      surface.clips ? static_cast<T>((1 + Tracer::rim_tolerance) / clip_radius_sq) : T(0);
  surface.curvature = static_cast<T>(flip * from.shape.curvature);
  surface.index_before = static_cast<T>(before);
  surface.index_ratio = static_cast<T>(ratio);
  surface.index_ratio_sq = static_cast<T>(ratio * ratio);
  surface.one_minus_index_ratio_sq = static_cast<T>(1 - ratio * ratio);
  return surface;
}

std::shared_ptr<const TransferData<double>> kernel_transfer(
    const std::shared_ptr<const TransferData<double>>& from, double) {
  return from;
}
std::shared_ptr<const TransferData<float>> kernel_transfer(
    const std::shared_ptr<const TransferData<double>>& from, float) {
  return std::make_shared<const TransferData<float>>(in_float(*from));
}

template <class T>
std::shared_ptr<const BendData<T>> kernel_bend(const BendData<double>& given, bool backward) {
  const BendData<double> from = backward ? given.turned_back() : given;
  return std::make_shared<const BendData<T>>(BendData<T>{
      static_cast<typename BendData<T>::Kind>(from.kind), from.mirror, static_cast<T>(from.index_before),
      static_cast<T>(from.index_after), static_cast<T>(from.along_x), static_cast<T>(from.along_y),
      static_cast<T>(from.power), static_cast<T>(from.vergence_before), static_cast<T>(from.vergence_after)});
}

template <class T>
void set_edges(const Tracer& tracer, KernelSurface<T>& stop) {
  const double distance = tracer.stop_radius_mm() * tracer.stop_blades().apothem();
  for (const auto& [x, y] : tracer.stop_blades().normals())
    stop.edges.push_back({static_cast<T>(x), static_cast<T>(y)});
  stop.edge_distance = static_cast<T>(distance * (1 + Tracer::rim_tolerance / 2));
  stop.per_edge_distance = static_cast<T>(1 / distance);
}

template <class T>
void set_figures(const std::vector<ApertureFigure>& figures, Tracer::Clip clip, KernelSurface<T>& surface) {
  if (clip != Tracer::Clip::apertures || figures.empty()) return;
  for (const ApertureFigure& figure : figures) surface.apertures.push_back(kernel_aperture<T>(figure));
  surface.figure_tolerance = static_cast<T>(Tracer::rim_tolerance);
  if (surface.clips) return;
  surface.clips = true;
  surface.clear_radius_sq = std::numeric_limits<T>::infinity();
  surface.per_clear_radius_sq = 0;
}

}  // namespace

template <class T>
KernelPath<T> kernel_path(const Tracer& tracer, bool backward, Tracer::Clip clip) {
  const std::vector<Tracer::PreparedSurface>& surfaces = tracer.surfaces();
  // The sense of travel at the sensor, and of a path where it begins, against +z.
  const double sense = tracer.image_sense();
  double flip = backward ? -sense : 1;
  KernelPath<T> path;
  path.flip = static_cast<T>(backward ? -1 : 1);
  path.to_image = !backward;
  path.image_z_mm = static_cast<T>(tracer.image_z_mm());
  path.image_index = static_cast<T>(tracer.image_index());
  double vertex_z = flip * (backward ? surfaces.back() : surfaces.front()).vertex_z_mm;
  path.first_vertex_z_mm = static_cast<T>(vertex_z);
  path.sensor_posed = tracer.sensor_posed();
  path.sensor = kernel_frame<T>(tracer.sensor_frame(), backward ? flip : sense);
  path.sensor_to_first_mm = static_cast<T>(flip * tracer.image_z_mm() - vertex_z);
  for (std::size_t step = 0; step < surfaces.size(); ++step) {
    const std::size_t i = backward ? surfaces.size() - 1 - step : step;
    KernelSurface<T> surface = kernel_surface<T>(surfaces[i], backward, flip, tracer.clip_radius_sq(i, clip));
    const double next = flip * surfaces[i].vertex_z_mm;
    surface.to_vertex_mm = static_cast<T>(vertex_z - next);
    vertex_z = next;
    if (i == tracer.stop_index() && clip != Tracer::Clip::none) set_edges(tracer, surface);
    set_figures(surfaces[i].apertures, clip, surface);
    if (surfaces[i].transfer) {
      surface.transfer = kernel_transfer(surfaces[i].transfer, T(0));
      surface.clips_others = clip == Tracer::Clip::apertures;
    }
    if (surfaces[i].bend) surface.bend = kernel_bend<T>(*surfaces[i].bend, backward);
    path.surfaces.push_back(std::move(surface));
    if (surfaces[i].mirror) flip = -flip, vertex_z = -vertex_z;
  }
  path.last_vertex_z_mm = static_cast<T>(vertex_z);
  if (sense < 0) {
    // Image space is seen in the mirror that has the image surface where it is.
    const double to_image = tracer.image_z_mm() - surfaces.back().vertex_z_mm;
    (backward ? path.first_vertex_z_mm : path.last_vertex_z_mm) =
        static_cast<T>((backward ? -1 : 1) * (tracer.image_z_mm() + to_image));
  }
  return path;
}

template KernelPath<double> kernel_path(const Tracer& tracer, bool backward, Tracer::Clip clip);
template KernelPath<float> kernel_path(const Tracer& tracer, bool backward, Tracer::Clip clip);

}  // namespace petzval
