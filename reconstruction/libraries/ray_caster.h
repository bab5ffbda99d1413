// Casts the rays of cameras at rigid parts, with Embree.
//
// Builds the parts' search trees once; posing the parts costs next to nothing. Only pixels in the
// rectangle around the parts' outline are cast. One object is for one thread; several may be used
// at the same time.
//
//   RayCaster caster(subject.parts());
//   caster.pose(subject.poses(seconds));
//   const SeenDepth seen = caster.see(camera.intrinsics, camera.world_from_camera);
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "reconstruction/depth_map.h"
#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

// The hit of one ray.
struct RayHit {
  std::size_t part = 0;
  std::size_t triangle = 0;
  float u = 0;  // barycentric: the triangle's second and third corner
  float v = 0;
};

class RayCaster {
 public:
  // The meshes need not outlive the object. Parts without triangles are fine.
  explicit RayCaster(const std::vector<TriangleMesh>& parts);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  // One pose for each part; before the first call all parts are at the origin.
  void pose(const std::vector<Eigen::Isometry3d>& poses);
  SeenDepth see(const Pinhole& camera, const Eigen::Isometry3d& world_from_camera) const;
  // The depth alone; `hits`, if not null, becomes as long as the image.
  DepthMap depth(const Pinhole& camera, const Eigen::Isometry3d& world_from_camera,
                 std::vector<RayHit>* hits = nullptr) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace simbench::reconstruction
