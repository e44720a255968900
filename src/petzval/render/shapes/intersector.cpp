// SPDX-License-Identifier: BSD-3-Clause
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/numeric/sobol.h>
#include <petzval/render/shapes/intersector.h>

#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>

namespace petzval::render {

namespace {

/// Embree computes boxes in floats; they must not lose the surface to rounding.
constexpr double box_margin = 1e-6;

RTCBounds box_of(const Quadric& quadric) {
  const auto [least, greatest] = quadric.bounds();
  const double size = length(greatest - least) + length(least) + length(greatest), margin = box_margin * size;
  RTCBounds box;
  box.lower_x = static_cast<float>(least.x - margin);
  box.lower_y = static_cast<float>(least.y - margin);
  box.lower_z = static_cast<float>(least.z - margin);
  box.upper_x = static_cast<float>(greatest.x + margin);
  box.upper_y = static_cast<float>(greatest.y + margin);
  box.upper_z = static_cast<float>(greatest.z + margin);
  return box;
}

void quadric_bounds(const RTCBoundsFunctionArguments* arguments) {
  *arguments->bounds_o = box_of(*static_cast<const Quadric*>(arguments->geometryUserPtr));
}

std::optional<double> quadric_hit(const void* user, const RTCRay& ray) {
  const auto& quadric = *static_cast<const Quadric*>(user);
  return quadric.hit({ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z},
                     static_cast<double>(ray.tnear), static_cast<double>(ray.tfar));
}

void intersect_quadric(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->N != 1 || !arguments->valid[0]) return;
  auto& ray_hit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const std::optional<double> t = quadric_hit(arguments->geometryUserPtr, ray_hit.ray);
  if (!t) return;
  ray_hit.ray.tfar = static_cast<float>(*t);
  ray_hit.hit.geomID = arguments->geomID;
  ray_hit.hit.primID = 0;
  ray_hit.hit.instID[0] = arguments->context->instID[0];
}

void occlude_quadric(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->N != 1 || !arguments->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  if (quadric_hit(arguments->geometryUserPtr, ray)) ray.tfar = -std::numeric_limits<float>::infinity();
}

/// A number in [0, 1) that belongs to a ray and the place where it meets a surface, and to no other: whether
/// it meets what is there in part only. The same for any order of rays and any number of threads.
double lot_of(const RTCRay& ray, const RTCHit& hit) {
  std::uint32_t bits = hashed(hit.primID, hit.geomID);
  for (const float each : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z, hit.u, hit.v})
    bits = hashed(bits, std::bit_cast<std::uint32_t>(each));
  return bits * 0x1p-32;
}

void keep_opaque(const RTCFilterFunctionNArguments* arguments) {
  if (arguments->N != 1 || !arguments->valid[0]) return;
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
  const auto& geometry = *static_cast<const Geometry*>(arguments->geometryUserPtr);
  const double opacity =
      opacity_at(geometry, hit.primID, static_cast<double>(hit.u), static_cast<double>(hit.v));
  if (opacity < 1 && lot_of(ray, hit) >= opacity) arguments->valid[0] = 0;
}

void keep_nothing(const RTCFilterFunctionNArguments* arguments) {
  for (unsigned i = 0; i < arguments->N; ++i) arguments->valid[i] = 0;
}

void occlude_nothing(const RTCOccludedFunctionNArguments*) {}

/// Embree takes no coordinates beyond 1.844e18, and ends the program where it was built with assertions.
bool within_embree(Vector3 place) {
  constexpr double farthest = 1.8e18;
  return std::abs(place.x) < farthest && std::abs(place.y) < farthest && std::abs(place.z) < farthest;
}

RTCRay ray_of(Vector3 origin, Vector3 direction, double limit) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = static_cast<float>(limit);
  ray.mask = ~0u;
  return ray;
}

/// Asks on behalf of Embree's threads whether to go on.
struct BuildMonitor {
  Listener* listener = current_listener();
  std::mutex mutex = {};
  std::exception_ptr stopped = {};  ///< what must not pass through Embree

  static bool goes_on(void* user, double) {
    auto& monitor = *static_cast<BuildMonitor*>(user);
    const ListenerScope scope(monitor.listener);
    try {
      check_stop();
      return true;
    } catch (...) {
      const std::lock_guard lock(monitor.mutex);
      monitor.stopped = std::current_exception();
      return false;
    }
  }
};

/// Builds the search tree of a scene.
void commit(RTCScene scene) {
  BuildMonitor monitor;
  rtcSetSceneProgressMonitorFunction(scene, BuildMonitor::goes_on, &monitor);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (monitor.stopped) std::rethrow_exception(monitor.stopped);
}

}  // namespace

struct Intersector::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCScene> objects;
  std::vector<std::size_t> object_of_instance;
  std::vector<GeometryRange> ranges;
  std::size_t first_instance = 0;  ///< geometry IDs from here on are placed objects

  Impl() : device(rtcNewDevice(nullptr)) {
    if (!device) throw Failure("Embree cannot be started");
  }
  ~Impl() {
    for (RTCScene object : objects) rtcReleaseScene(object);
    if (scene) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
      throw Failure(fmt::format("Embree reports error {} while the scene is built: {}",
                                static_cast<int>(error),
                                error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "unexpected"));
  }

  RTCScene new_scene() const {
    RTCScene result = rtcNewScene(device);
    rtcSetSceneFlags(result, RTC_SCENE_FLAG_ROBUST);
    return result;
  }

  RTCGeometry new_curve(const CurveSegments& curve) const {
    const bool tube = curve.kind == CurveSegments::Kind::cylinder;
    RTCGeometry handle = rtcNewGeometry(
        device, tube ? RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE : RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), curve.points.size()));
    auto* first = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        handle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned), curve.segments()));
    check();
    for (const auto& point : curve.points) vertices = std::copy(point.begin(), point.end(), vertices);
    for (std::size_t i = 0; i < curve.segments(); ++i) first[i] = static_cast<unsigned>(4 * i);
    return handle;
  }

  void attach(RTCScene to, const Geometry& geometry, unsigned id) const {
    RTCGeometry handle;
    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shape)) {
      handle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
          handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh->positions.size()));
      auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
          handle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh->triangles.size()));
      check();
      for (const auto& vertex : mesh->positions) vertices = std::copy(vertex.begin(), vertex.end(), vertices);
      for (const auto& triangle : mesh->triangles)
        indices = std::copy(triangle.begin(), triangle.end(), indices);
    } else if (const auto* curve = std::get_if<CurveSegments>(&geometry.shape)) {
      handle = new_curve(*curve);
    } else {
      handle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
      rtcSetGeometryUserPrimitiveCount(handle, 1);
      rtcSetGeometryUserData(handle, const_cast<Quadric*>(&std::get<Quadric>(geometry.shape)));
      rtcSetGeometryBoundsFunction(
          handle, [](const RTCBoundsFunctionArguments* arguments) { quadric_bounds(arguments); }, nullptr);
      rtcSetGeometryIntersectFunction(handle, intersect_quadric);
      rtcSetGeometryOccludedFunction(handle, geometry.is_interface ? occlude_nothing : occlude_quadric);
    }
    if (geometry.opacity) {
      rtcSetGeometryUserData(handle, const_cast<Geometry*>(&geometry));
      rtcSetGeometryIntersectFilterFunction(handle, keep_opaque);
      rtcSetGeometryOccludedFilterFunction(handle, keep_opaque);
    }
    // What is no boundary casts no shadow.
    if (geometry.is_interface && !std::holds_alternative<Quadric>(geometry.shape))
      rtcSetGeometryOccludedFilterFunction(handle, keep_nothing);
    rtcCommitGeometry(handle);
    rtcAttachGeometryByID(to, handle, id);
    rtcReleaseGeometry(handle);
    check();
  }

  RTCScene build(const std::vector<Geometry>& geometries, GeometryRange range) const {
    RTCScene result = new_scene();
    for (std::size_t i = range.first; i < range.last; ++i) {
      check_stop();
      attach(result, geometries[i], static_cast<unsigned>(i - range.first));
    }
    return result;
  }

  void place(const PlacedObject& placed, unsigned id) const {
    RTCGeometry handle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(handle, objects[static_cast<std::size_t>(placed.object)]);
    const Matrix4& m = placed.world_from_object.matrix();
    float columns[12];
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t row = 0; row < 3; ++row)
        columns[3 * column + row] = static_cast<float>(m[row][column]);
    rtcSetGeometryTransform(handle, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(handle);
    rtcAttachGeometryByID(scene, handle, id);
    rtcReleaseGeometry(handle);
  }
};

Intersector::Intersector(const std::vector<Geometry>& geometries, GeometryRange scene,
                         const std::vector<GeometryRange>& objects, const std::vector<PlacedObject>& placed)
    : impl_(std::make_unique<Impl>()) {
  impl_->ranges.push_back(scene);
  impl_->scene = impl_->build(geometries, scene);
  impl_->first_instance = scene.last - scene.first;
  for (const GeometryRange& range : objects) {
    impl_->objects.push_back(impl_->build(geometries, range));
    commit(impl_->objects.back());
    impl_->ranges.push_back(range);
  }
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (i % 1024 == 0) check_stop();
    impl_->object_of_instance.push_back(static_cast<std::size_t>(placed[i].object));
    impl_->place(placed[i], static_cast<unsigned>(impl_->first_instance + i));
  }
  commit(impl_->scene);
  impl_->check();
}

Intersector::~Intersector() = default;

std::optional<Hit> Intersector::nearest(Vector3 origin, Vector3 direction, double limit) const {
  if (!within_embree(origin)) return {};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray_hit{};
  ray_hit.ray = ray_of(origin, direction, limit);
  ray_hit.hit.geomID = ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &ray_hit);
  if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  Hit hit;
  hit.distance = static_cast<double>(ray_hit.ray.tfar);
  hit.primitive = static_cast<int>(ray_hit.hit.primID);
  hit.b1 = static_cast<double>(ray_hit.hit.u);
  hit.b2 = static_cast<double>(ray_hit.hit.v);
  std::size_t range = 0;
  if (ray_hit.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
    hit.instance = static_cast<int>(ray_hit.hit.instID[0] - impl_->first_instance);
    range = impl_->object_of_instance[static_cast<std::size_t>(hit.instance)] + 1;
  }
  hit.geometry = static_cast<int>(impl_->ranges[range].first + ray_hit.hit.geomID);
  return hit;
}

bool Intersector::blocked(Vector3 origin, Vector3 direction, double limit) const {
  if (!within_embree(origin)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = ray_of(origin, direction, limit);
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0;
}

std::optional<std::array<Vector3, 2>> Intersector::bounds() const {
  RTCBounds box;
  rtcGetSceneBounds(impl_->scene, &box);
  if (!(box.lower_x <= box.upper_x)) return {};
  return std::array<Vector3, 2>{Vector3{box.lower_x, box.lower_y, box.lower_z},
                                Vector3{box.upper_x, box.upper_y, box.upper_z}};
}

}  // namespace petzval::render
