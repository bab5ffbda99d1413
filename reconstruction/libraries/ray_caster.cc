#include "reconstruction/libraries/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "algorithms/ports/assert.h"

namespace simbench::reconstruction {
namespace {

// Columns [left, right) and rows [top, bottom) of an image.
struct PixelBox {
  int left = 0;
  int right = 0;
  int top = 0;
  int bottom = 0;
};

// A box around all pixels that can see one of the boxes in the world.
PixelBox pixel_box(const std::vector<Eigen::AlignedBox3d>& bounds, const Pinhole& camera,
                   const Eigen::Isometry3d& camera_from_world) {
  const PixelBox everything{0, camera.width, 0, camera.height};
  Eigen::AlignedBox2d pixels;
  for (const Eigen::AlignedBox3d& box : bounds) {
    if (box.isEmpty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      const Eigen::Vector3d point = camera_from_world * box.corner(type);
      constexpr double kTooNear = 1e-3;
      if (point.z() < kTooNear) return everything;
      pixels.extend(camera.pixel_of(point));
    }
  }
  if (pixels.isEmpty()) return {};
  const auto inside = [](double at, int size) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  return {inside(std::floor(pixels.min().x()), camera.width),
          inside(std::ceil(pixels.max().x()) + 1, camera.width),
          inside(std::floor(pixels.min().y()), camera.height),
          inside(std::ceil(pixels.max().y()) + 1, camera.height)};
}

template <typename Element, typename Value>
void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
          const std::vector<Value>& values) {
  auto* out = static_cast<Element*>(
      rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(Element), values.size()));
  for (const Value& value : values) {
    for (int i = 0; i < 3; ++i) *out++ = static_cast<Element>(value[i]);
  }
}

RTCScene scene_of(RTCDevice device, const TriangleMesh& mesh) {
  RTCScene scene = rtcNewScene(device);
  if (!mesh.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
    fill<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  return scene;
}

RTCRayHit ray_along(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
  RTCRayHit ray{};
  ray.ray.org_x = origin.x();
  ray.ray.org_y = origin.y();
  ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x();
  ray.ray.dir_y = direction.y();
  ray.ray.dir_z = direction.z();
  ray.ray.tnear = 0;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

}  // namespace

struct RayCaster::Scene {
  RTCDevice device = nullptr;
  RTCScene all = nullptr;
  std::vector<RTCScene> parts;
  std::vector<RTCGeometry> instances;
  std::vector<Eigen::AlignedBox3d> own_bounds;  // of each part, in its own frame
  std::vector<Eigen::AlignedBox3d> bounds;      // as posed
  std::vector<Eigen::Matrix3f> part_from_world;

  // Calls `met(pixel, ray)` for every pixel that sees something. The direction's z in the camera's
  // frame is 1, so a ray's length is the depth.
  template <typename Met>
  void cast(const Pinhole& camera, const Eigen::Isometry3d& world_from_camera, Met met) const;
};

template <typename Met>
void RayCaster::Scene::cast(const Pinhole& camera, const Eigen::Isometry3d& world_from_camera,
                            Met met) const {
  const PixelBox box = pixel_box(bounds, camera, world_from_camera.inverse());
  const Eigen::Vector3f origin = world_from_camera.translation().cast<float>();
  const Eigen::Matrix3d turn = world_from_camera.linear();
  RTCIntersectContext context{};
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (int row = box.top; row < box.bottom; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      const Eigen::Vector3f direction = (turn * camera.point_at({column, row}, 1.0)).cast<float>();
      RTCRayHit ray = ray_along(origin, direction);
      rtcIntersect1(all, &context, &ray);
      if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      met(static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
              static_cast<std::size_t>(column),
          ray);
    }
  }
}

RayCaster::RayCaster(const std::vector<TriangleMesh>& parts) : scene_(std::make_unique<Scene>()) {
  scene_->device = rtcNewDevice("threads=1");
  if (scene_->device == nullptr) throw std::runtime_error("Embree: no device");
  scene_->all = rtcNewScene(scene_->device);
  rtcSetSceneFlags(scene_->all, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
  for (const TriangleMesh& part : parts) {
    scene_->parts.push_back(scene_of(scene_->device, part));
    RTCGeometry instance = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, scene_->parts.back());
    rtcAttachGeometry(scene_->all, instance);
    scene_->instances.push_back(instance);
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3f& vertex : part.vertices) bounds.extend(vertex.cast<double>());
    scene_->own_bounds.push_back(bounds);
  }
  pose(std::vector<Eigen::Isometry3d>(parts.size(), Eigen::Isometry3d::Identity()));
  if (rtcGetDeviceError(scene_->device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree: the parts cannot be made into a scene");
  }
}

RayCaster::~RayCaster() {
  for (RTCGeometry instance : scene_->instances) rtcReleaseGeometry(instance);
  for (RTCScene part : scene_->parts) rtcReleaseScene(part);
  rtcReleaseScene(scene_->all);
  rtcReleaseDevice(scene_->device);
}

void RayCaster::pose(const std::vector<Eigen::Isometry3d>& poses) {
  SIMBENCH_ASSERT(poses.size() == scene_->instances.size(), "a pose for each part");
  scene_->bounds.clear();
  scene_->part_from_world.clear();
  for (std::size_t part = 0; part < poses.size(); ++part) {
    const Eigen::Matrix4f matrix = poses[part].matrix().cast<float>();
    rtcSetGeometryTransform(scene_->instances[part], 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                            matrix.data());
    rtcCommitGeometry(scene_->instances[part]);
    scene_->part_from_world.emplace_back(poses[part].linear().transpose().cast<float>());
    Eigen::AlignedBox3d bounds = scene_->own_bounds[part];
    scene_->bounds.push_back(bounds.isEmpty() ? bounds : bounds.transformed(poses[part]));
  }
  rtcCommitScene(scene_->all);
}

SeenDepth RayCaster::see(const Pinhole& camera, const Eigen::Isometry3d& world_from_camera) const {
  SeenDepth seen{DepthMap(camera.width, camera.height), {}};
  seen.cos_incidence.resize(seen.depth.depth_m.size(), 0.0F);
  scene_->cast(camera, world_from_camera, [&](std::size_t pixel, const RTCRayHit& ray) {
    seen.depth.depth_m[pixel] = ray.ray.tfar;
    // The normal is in the part's frame.
    const Eigen::Vector3f direction = scene_->part_from_world[ray.hit.instID[0]] *
                                      Eigen::Vector3f(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
    const Eigen::Vector3f normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    seen.cos_incidence[pixel] =
        std::min(1.0F, std::abs(direction.dot(normal)) / (direction.norm() * normal.norm()));
  });
  return seen;
}

DepthMap RayCaster::depth(const Pinhole& camera, const Eigen::Isometry3d& world_from_camera,
                          std::vector<RayHit>* hits) const {
  DepthMap depth(camera.width, camera.height);
  if (hits != nullptr) hits->assign(depth.depth_m.size(), {});
  scene_->cast(camera, world_from_camera, [&](std::size_t pixel, const RTCRayHit& ray) {
    depth.depth_m[pixel] = ray.ray.tfar;
    if (hits == nullptr) return;
    (*hits)[pixel] = {ray.hit.instID[0], ray.hit.primID, ray.hit.u, ray.hit.v};
  });
  return depth;
}

}  // namespace simbench::reconstruction
