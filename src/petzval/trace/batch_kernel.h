// SPDX-License-Identifier: BSD-3-Clause
// The batch trace on whatever SIMD the machine has: lanes are rays. T is double, with optical path, or float,
// for radiance, without.
#pragma once

#include <petzval/lens/bend_data.h>
#include <petzval/lens/shapes/shape_data.h>
#include <petzval/lens/transfer_data.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace petzval {

/// A frame in the sense of travel: its own axes turned into those of the lens, and its place.
template <class T>
struct KernelFrame {
  std::array<T, 3> offset_mm{};
  std::array<std::array<T, 3>, 3> rows{};
};

/// An ApertureFigure: a place (x, y) in its own axes is (ax + by + e, cx + dy + f), 1 at the edge.
template <class T>
struct KernelAperture {
  bool rectangle = false, obscures = false;
  T a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;
};

/// One surface in the order of travel, with everything that does not depend on the ray worked out.
template <class T>
struct KernelSurface {
  ShapeData<T> shape;
  bool clips = false;
  T curvature = 0;     ///< as seen in the sense of travel
  T flip = 1;          ///< −1: the sense of travel is against that of the shape
  T to_vertex_mm = 0;  ///< added to z on arrival: the previous vertex minus this one
  T index_before = 1;  ///< on the side the ray comes from
  T index_ratio = 1;   ///< before / behind
  T index_ratio_sq = 1, one_minus_index_ratio_sq = 0;
  T clear_radius_sq = 0, per_clear_radius_sq = 0;  ///< count where `clips`
  /// Of a stop that is a polygon besides: unit normals of its edges, and how far they are from its middle.
  std::vector<std::array<T, 2>> edges;
  T edge_distance = 0, per_edge_distance = 0;
  bool posed = false;
  KernelFrame<T> frame;  ///< counts where `posed`
  bool mirror = false;   ///< throws light back; what comes next is seen in the mirror z → −z
  std::vector<KernelAperture<T>> apertures;  ///< count where `clips`
  T figure_tolerance = 0;                    ///< by so much, as a share, their edges give way
  /// Carries rays between the planes of this surface and of the one behind it; then nothing else above counts
  /// but the clip, in the coordinates of the transfer's stop.
  std::shared_ptr<const TransferData<T>> transfer;
  bool clips_others = false;                ///< at the transfer's other apertures
  std::shared_ptr<const BendData<T>> bend;  ///< in the sense of travel, in place of refraction
  bool counts_path = true;                  ///< through the transfer; costs ten times the way itself
};

/// The surfaces in the order of travel. A backward trace is a forward trace through the mirror image z → −z,
/// and so is what follows a mirror.
template <class T>
struct KernelPath {
  std::vector<KernelSurface<T>> surfaces;
  T flip = 1;  ///< +1 forward, −1 backward: what z and n are multiplied by on the way in and out
  T first_vertex_z_mm = 0, last_vertex_z_mm = 0;  ///< flipped
  bool to_image = true;                           ///< carry on to the image plane
  T image_z_mm = 0, image_index = 1;
  bool sensor_posed = false;
  KernelFrame<T> sensor;     ///< counts where `sensor_posed`
  T sensor_to_first_mm = 0;  ///< from the sensor's vertex to the first one, for a backward trace
};

/// `count` rays in columns; `opl` only in double. passes[i] becomes 1, or 0 for a ray that fails or is
/// clipped, which is left as it was.
template <class T>
struct RayColumns {
  T *x, *y, *z, *l, *m, *n, *opl;
  std::uint8_t* passes;
  std::size_t count;
};

/// Traces in place, by the widest instruction set of the machine (or what hwy::SetSupportedTargetsForTest
/// allows). The last bits depend on the instruction set, not on the position in the batch. Method: the
/// one-division form of the quadratic with z relative to the next vertex; three vectors in flight, so that
/// the latencies of roots and divisions overlap; other shapes by Newton from their conic, to 1e-12 mm in
/// double and to rounding in float.
void trace_columns(const KernelPath<double>& path, const RayColumns<double>& rays);
void trace_columns(const KernelPath<float>& path, const RayColumns<float>& rays);

/// For each ray the largest (r/r_clear)² over all clipping surfaces, minus 1, into worst[i]; infinity for a
/// ray that misses or is totally reflected. The rays stay as they are; `passes` and `opl` are not used.
void measure_columns(const KernelPath<double>& path, const RayColumns<double>& rays, double* worst);

}  // namespace petzval
