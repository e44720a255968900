// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/frame_motion.h>
#include <petzval/trace/ray_derivatives.h>

#include <petzval/trace/surface_meet-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace petzval {

namespace {

/// So many derivatives are carried at once: two vectors of eight.
constexpr std::size_t slopes_at_once = 16;

struct Slopes {
  std::array<double, slopes_at_once> by{};

  friend Slopes operator+(Slopes a, const Slopes& b) {
    for (std::size_t i = 0; i < slopes_at_once; ++i) a.by[i] += b.by[i];
    return a;
  }
  friend Slopes operator-(Slopes a, const Slopes& b) {
    for (std::size_t i = 0; i < slopes_at_once; ++i) a.by[i] -= b.by[i];
    return a;
  }
  friend Slopes operator*(Slopes a, double b) {
    for (double& slope : a.by) slope *= b;
    return a;
  }
  friend Slopes operator*(double a, Slopes b) { return b * a; }
  friend Slopes operator/(Slopes a, double b) { return a * (1 / b); }
};

using DualNumber = HWY_NAMESPACE::Dual<double, Slopes>;
using HWY_NAMESPACE::square_root;
using DualPoint = SurfacePoint<DualNumber>;

DualNumber fixed(double value) {
  return {value, {}};
}
DualNumber sine(const DualNumber& angle) {
  return {std::sin(angle.value), angle.slope * std::cos(angle.value)};
}
DualNumber cosine(const DualNumber& angle) {
  return {std::cos(angle.value), angle.slope * -std::sin(angle.value)};
}

struct DerivedPath {
  DualNumber x, y, z, l, m, n, opl;
};

/// The shape with the derivatives of what it is made of.
DualNumber seeded(double value, const std::span<const LensNumber> numbers, LensNumber::Kind kind,
                  std::size_t surface, int power = 0) {
  DualNumber result = fixed(value);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i].kind == kind && numbers[i].surface == surface && numbers[i].power == power)
      result.slope.by[i] = 1;
  return result;
}

ShapeData<DualNumber> seeded_shape(const ShapeData<double>& shape, std::size_t surface,
                                   std::span<const LensNumber> numbers) {
  using Kind = LensNumber::Kind;
  const DualNumber conic = seeded(shape.conic, numbers, Kind::conic, surface);
  ShapeData<DualNumber> result{shape.form,
                               shape.added,
                               seeded(shape.curvature, numbers, Kind::curvature_per_mm, surface),
                               conic,
                               {shape.one_plus_conic, conic.slope},
                               {},
                               fixed(shape.per_unit)};
  const bool powers = shape.form != ShapeForm::added;
  for (const double term : shape.terms) {
    const int power = static_cast<int>(result.terms.size());
    result.terms.push_back(powers ? seeded(term, numbers, Kind::power, surface, power) : fixed(term));
  }
  // Powers that the surface does not have yet.
  for (std::size_t i = 0; powers && i < numbers.size(); ++i) {
    if (numbers[i].kind != Kind::power || numbers[i].surface != surface) continue;
    result.form = ShapeForm::powers;
    while (result.terms.size() <= static_cast<std::size_t>(numbers[i].power))
      result.terms.push_back(seeded(0, numbers, Kind::power, surface, static_cast<int>(result.terms.size())));
  }
  return result;
}

template <class... Kind>
DualPoint added_point(HWY_NAMESPACE::KindList<Kind...>, const ShapeData<DualNumber>& shape,
                      const DualNumber& x, const DualNumber& y) {
  DualPoint point{};
  std::size_t i = 0;
  ((shape.added == i++ ? void(point = Kind::at(shape, x, y)) : void()), ...);
  return point;
}

DualPoint point_at(const ShapeData<DualNumber>& shape, const DualNumber& x, const DualNumber& y) {
  if (shape.form == ShapeForm::added) return added_point(HWY_NAMESPACE::AddedKinds(), shape, x, y);
  if (shape.form >= ShapeForm::powers) return HWY_NAMESPACE::Powers<false>::at(shape, x, y);
  return HWY_NAMESPACE::Conic::at(shape, x, y);
}

using DualFrame = FrameOf<DualNumber>;

/// A pose whose numbers have derivatives.
Motion<DualNumber> seeded_motion(const Pose& pose, std::span<const LensNumber> numbers, LensNumber::Kind kind,
                                 std::size_t of) {
  std::array<DualNumber, pose_numbers.size()> values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = seeded(pose.*pose_numbers[i].value, numbers, kind, of, static_cast<int>(i));
  const DualNumber per_degree = fixed(radians(1));
  return {{values[0], values[1], values[2]},
          {values[3] * per_degree, values[4] * per_degree, values[5] * per_degree}};
}

/// frames_of() with derivatives.
std::vector<DualFrame> seeded_frames(const Lens& lens, std::span<const LensNumber> numbers) {
  using Kind = LensNumber::Kind;
  const std::size_t sensor = lens.surfaces.size();
  std::vector<DualNumber> vertex_mm{fixed(0)};
  for (std::size_t i = 0; i < sensor; ++i)
    vertex_mm.push_back(vertex_mm[i] + seeded(lens.surfaces[i].thickness_mm, numbers, Kind::thickness_mm, i));
  std::vector<DualFrame> frames(sensor + 1);
  for (std::size_t i = 0; i <= sensor; ++i)
    move(i < sensor ? seeded_motion(lens.surfaces[i].pose, numbers, Kind::surface_pose, i)
                    : seeded_motion(lens.sensor_pose, numbers, Kind::sensor_pose, 0),
         fixed(0), frames[i]);
  for (std::size_t g = 0; g < lens.groups.size(); ++g) {
    const SurfaceGroup& group = lens.groups[g];
    const Motion<DualNumber> motion = seeded_motion(group.pose, numbers, Kind::group_pose, g);
    for (std::size_t i = group.first; i <= std::min(group.last, sensor); ++i)
      move(motion, vertex_mm[i] - (vertex_mm[group.first] + fixed(group.pivot_mm)), frames[i]);
  }
  return frames;
}

bool stands_still(const DualNumber& number, double at) {
  return number.value == at && std::ranges::all_of(number.slope.by, [](double slope) { return slope == 0; });
}

/// Whether the place is the one of the prescription, whatever the numbers.
bool stands_still(const DualFrame& frame) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!stands_still(frame.offset_mm[i], 0)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (!stands_still(frame.rows[i][k], i == k ? 1 : 0)) return false;
  }
  return true;
}

void enter(const DualFrame& frame, DerivedPath& path) {
  const auto& [ox, oy, oz] = frame.offset_mm;
  const auto point =
      transposed_product(frame.rows, VectorOf<DualNumber>{path.x - ox, path.y - oy, path.z - oz});
  const auto direction = transposed_product(frame.rows, VectorOf<DualNumber>{path.l, path.m, path.n});
  path = {point[0], point[1], point[2], direction[0], direction[1], direction[2], path.opl};
}

void leave(const DualFrame& frame, DerivedPath& path) {
  const auto& [ox, oy, oz] = frame.offset_mm;
  const auto point = product(frame.rows, VectorOf<DualNumber>{path.x, path.y, path.z});
  const auto direction = product(frame.rows, VectorOf<DualNumber>{path.l, path.m, path.n});
  path = {point[0] + ox, point[1] + oy, point[2] + oz, direction[0], direction[1], direction[2], path.opl};
}

/// To the surface, a signed distance `way_mm` on. From there one more step of Newton's, in dual numbers,
/// moves nothing and has the derivatives of the implicit function.
DualPoint meet_derived(const ShapeData<DualNumber>& shape, double way_mm, double index, DerivedPath& path) {
  const auto advance = [&](const DualNumber& way) {
    path.x = path.x + way * path.l;
    path.y = path.y + way * path.m;
    path.z = path.z + way * path.n;
    path.opl = path.opl + fixed(index) * way;
  };
  advance(fixed(way_mm));
  DualPoint point = point_at(shape, path.x, path.y);
  const DualNumber slope = path.n - path.l * point.slope_x - path.m * point.slope_y;
  advance((point.sag - path.z) / slope);
  return point_at(shape, path.x, path.y);
}

/// \param sense  −1: the light runs towards −z.
void refract_derived(double sense, double ratio, const DualPoint& at, DerivedPath& path) {
  if (ratio == 1) return;
  const DualNumber scale =
      fixed(sense) / square_root(at.slope_x * at.slope_x + at.slope_y * at.slope_y + fixed(1));
  const DualNumber nx = fixed(-1) * at.slope_x * scale, ny = fixed(-1) * at.slope_y * scale;
  const DualNumber cosine = path.l * nx + path.m * ny + path.n * scale, e = fixed(ratio);
  const DualNumber bend = square_root(fixed(1) - e * e * (fixed(1) - cosine * cosine)) - e * cosine;
  path.l = e * path.l + bend * nx;
  path.m = e * path.m + bend * ny;
  path.n = e * path.n + bend * scale;
}

void reflect_derived(const DualPoint& at, DerivedPath& path) {
  const DualNumber square = at.slope_x * at.slope_x + at.slope_y * at.slope_y + fixed(1);
  const DualNumber twice = fixed(2) * (path.n - path.l * at.slope_x - path.m * at.slope_y) / square;
  path.l = path.l + twice * at.slope_x;
  path.m = path.m + twice * at.slope_y;
  path.n = path.n - twice;
}

}  // namespace

struct DerivedTracer::Part {
  std::vector<ShapeData<DualNumber>> shapes;
  std::vector<DualNumber> gaps;                  ///< behind every surface [mm]
  std::vector<std::optional<DualFrame>> frames;  ///< of every surface and the sensor, where they count

  Part(const Lens& lens, const Tracer& tracer, std::span<const LensNumber> numbers) {
    const std::size_t count = tracer.surface_count();
    for (std::size_t i = 0; i < count; ++i) {
      shapes.push_back(seeded_shape(tracer.surfaces()[i].shape, i, numbers));
      const double next = i + 1 < count ? tracer.vertex_z_mm(i + 1) : tracer.image_z_mm();
      gaps.push_back(seeded(next - tracer.vertex_z_mm(i), numbers, LensNumber::Kind::thickness_mm, i));
    }
    for (const DualFrame& frame : seeded_frames(lens, numbers))
      frames.push_back(stands_still(frame) ? std::nullopt : std::optional(frame));
  }

  /// \param met  where the ray meets the surfaces, from the tracer.
  DerivedPath derived(const Tracer& tracer, const Ray& ray, const std::vector<Intersection>& met) const;
};

DerivedPath DerivedTracer::Part::derived(const Tracer& tracer, const Ray& ray,
                                         const std::vector<Intersection>& met) const {
  DerivedPath path{
      fixed(ray.point_mm[0]),  fixed(ray.point_mm[1]),  fixed(ray.point_mm[2] - tracer.vertex_z_mm(0)),
      fixed(ray.direction[0]), fixed(ray.direction[1]), fixed(ray.direction[2]),
      fixed(ray.opl_mm)};
  const std::size_t count = tracer.surface_count();
  for (std::size_t i = 0; i < count; ++i) {
    const Tracer::PreparedSurface& surface = tracer.surfaces()[i];
    double met_z = met[i].point_mm[2];
    if (frames[i]) {
      enter(*frames[i], path);
      met_z = surface.frame.point_from_lens(met[i].point_mm, surface.vertex_z_mm)[2];
    }
    const double way = (met_z - surface.vertex_z_mm - path.z.value) / path.n.value;
    const DualPoint at = meet_derived(shapes[i], way, surface.index_before, path);
    if (surface.mirror)
      reflect_derived(at, path);
    else
      refract_derived(surface.sense, surface.index_before / surface.index_after, at, path);
    if (frames[i]) leave(*frames[i], path);
    path.z = path.z - gaps[i];
  }
  if (frames[count]) enter(*frames[count], path);
  const DualNumber way = fixed(-1) * path.z / path.n;
  path.x = path.x + way * path.l;
  path.y = path.y + way * path.m;
  path.opl = path.opl + fixed(tracer.image_index()) * way;
  return path;
}

namespace {

void check_number(const Lens& lens, const LensNumber& number) {
  if (number.is_pose() && (number.power < 0 || number.power >= static_cast<int>(pose_numbers.size())))
    throw InputError(fmt::format("number {} of a pose; 0 to 5 would be right", number.power));
  if (number.kind == LensNumber::Kind::sensor_pose) return;
  if (number.kind == LensNumber::Kind::group_pose) {
    if (number.surface >= lens.groups.size())
      throw InputError(fmt::format("groups[{}]: the lens has {} groups, counted from 0", number.surface,
                                   lens.groups.size()));
    return;
  }
  if (number.surface >= lens.surfaces.size())
    throw InputError(
        fmt::format("surfaces[{}]: the lens has surfaces 0 to {}", number.surface, lens.surfaces.size() - 1));
  if (number.kind == LensNumber::Kind::power && (number.power < 2 || number.power > 30))
    throw InputError(fmt::format("a power of {}; 2 to 30 would be right", number.power));
}

template <class AnyLens>
auto& pose_of(AnyLens& lens, const LensNumber& number) {
  if (number.kind == LensNumber::Kind::sensor_pose) return lens.sensor_pose;
  return number.kind == LensNumber::Kind::group_pose ? lens.groups[number.surface].pose
                                                     : lens.surfaces[number.surface].pose;
}

double Pose::*value_in_pose(const LensNumber& number) {
  return pose_numbers[static_cast<std::size_t>(number.power)].value;
}

}  // namespace

double value_of(const Lens& lens, const LensNumber& number) {
  check_number(lens, number);
  if (number.is_pose()) return pose_of(lens, number).*value_in_pose(number);
  const Surface& surface = lens.surfaces[number.surface];
  switch (number.kind) {
    case LensNumber::Kind::curvature_per_mm:
      return surface.curvature_per_mm;
    case LensNumber::Kind::thickness_mm:
      return surface.thickness_mm;
    case LensNumber::Kind::conic:
      return surface.conic;
    default:
      break;
  }
  const auto term = surface.asphere.find(number.power);
  return term == surface.asphere.end() ? 0 : term->second;
}

Lens with_value(Lens lens, const LensNumber& number, double value) {
  check_number(lens, number);
  if (number.is_pose()) {
    pose_of(lens, number).*value_in_pose(number) = value;
    return lens;
  }
  Surface& surface = lens.surfaces[number.surface];
  switch (number.kind) {
    case LensNumber::Kind::curvature_per_mm:
      surface.curvature_per_mm = value;
      break;
    case LensNumber::Kind::thickness_mm:
      surface.thickness_mm = value;
      break;
    case LensNumber::Kind::conic:
      surface.conic = value;
      break;
    default:
      surface.asphere[number.power] = value;
  }
  return lens;
}

DerivedTracer::DerivedTracer(const Lens& lens, double wavelength_nm, std::vector<LensNumber> numbers)
    : tracer_(lens, wavelength_nm, std::numeric_limits<double>::infinity()), numbers_(std::move(numbers)) {
  for (const LensNumber& number : numbers_) check_number(lens, number);
  for (const Tracer::PreparedSurface& surface : tracer_.surfaces()) {
    if (surface.bend)
      throw InputError(
          "derivatives of rays are those of surfaces that refract or reflect; set ideal_lens=null");
    if (surface.transfer)
      throw InputError("derivatives of rays are those of surfaces, and a ray transfer has none");
  }
  for (std::size_t first = 0; first < numbers_.size(); first += slopes_at_once) {
    const auto some = std::span(numbers_).subspan(first, std::min(slopes_at_once, numbers_.size() - first));
    parts_.push_back(std::make_unique<const Part>(lens, tracer_, some));
  }
}

DerivedTracer::DerivedTracer(DerivedTracer&&) noexcept = default;
DerivedTracer::~DerivedTracer() = default;

std::optional<DerivedRay> DerivedTracer::trace(const Ray& ray) const {
  std::vector<Intersection> met;
  DerivedRay result{tracer_.trace(ray, Tracer::Clip::none, &met), {}};
  if (result.ray.status != RayStatus::ok) return {};
  for (const auto& part : parts_) {
    const DerivedPath path = part->derived(tracer_, ray, met);
    for (std::size_t i = 0; i < slopes_at_once && result.by.size() < numbers_.size(); ++i)
      result.by.push_back({path.x.slope.by[i], path.y.slope.by[i], path.l.slope.by[i], path.m.slope.by[i],
                           path.opl.slope.by[i]});
  }
  return result;
}

}  // namespace petzval
