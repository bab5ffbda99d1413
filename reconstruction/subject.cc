#include "reconstruction/subject.h"

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reconstruction/motion.h"
#include "reconstruction/primitives.h"
#include "reconstruction/skeleton.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTessellation = 0.001 / 1.75;  // largest error, as a share of the height

// A part in the frame of its segment, its lengths as shares of the height.
struct BodyPart {
  BodySegment segment;
  Isometry3d pose;
  TriangleMesh mesh;
};
using Body = std::vector<BodyPart>;

void add_ellipsoid(Body& body, BodySegment segment, const Vector3d& centre, const Vector3d& axes) {
  body.push_back(
      {segment, Isometry3d(Eigen::Translation3d(centre)), make_ellipsoid(axes, kTessellation)});
}

// From a ball about `from` to a ball about `to`.
void add_limb(Body& body, BodySegment segment, const Vector3d& from, double radius,
              const Vector3d& to, double end_radius) {
  const Isometry3d pose = Eigen::Translation3d(from) *
                          Eigen::Quaterniond::FromTwoVectors(-Vector3d::UnitZ(), to - from);
  body.push_back(
      {segment, pose, make_tapered_capsule(radius, end_radius, (to - from).norm(), kTessellation)});
}

void add_trunk(Body& body) {
  const BodySegment trunk = BodySegment::kTrunk;
  add_ellipsoid(body, trunk, {-0.004, 0, 0.550}, {0.067, 0.099, 0.085});  // pelvis
  add_ellipsoid(body, trunk, {0.003, 0, 0.635}, {0.062, 0.092, 0.130});   // belly
  add_ellipsoid(body, trunk, {0.002, 0, 0.735}, {0.067, 0.101, 0.120});   // chest
  add_limb(body, trunk, {0.006, 0, 0.885}, 0.033, {-0.006, 0, 0.810}, 0.041);
  for (const double side : {1.0, -1.0}) {
    add_limb(body, trunk, {-0.004, side * 0.015, 0.846}, 0.030,
             {0, side * kShoulderHalfWidth, kShoulderHeight}, 0.034);
  }
  add_ellipsoid(body, trunk, {0.006, 0, 0.937}, {0.056, 0.044, 0.063});  // skull
  add_ellipsoid(body, trunk, {0.022, 0, 0.899}, {0.037, 0.033, 0.031});  // jaw
  add_ellipsoid(body, trunk, {0.062, 0, 0.922}, {0.012, 0.008, 0.014});  // nose
}

void add_arm(Body& body, BodySegment upper_arm, BodySegment forearm) {
  add_limb(body, upper_arm, {0, 0, 0}, 0.033, {0, 0, -kUpperArm}, 0.024);
  add_limb(body, forearm, {0, 0, 0}, 0.025, {0, 0, -kForearm}, 0.016);
  add_ellipsoid(body, forearm, {0.003, 0, -kForearm - 0.042}, {0.023, 0.014, 0.058});  // hand
}

void add_leg(Body& body, BodySegment thigh, BodySegment shank, BodySegment foot) {
  add_limb(body, thigh, {0, 0, 0}, 0.052, {0, 0, kKneeHeight - kHipHeight}, 0.033);
  add_limb(body, shank, {0, 0, 0}, 0.033, {0, 0, kAnkleHeight - kKneeHeight}, 0.021);
  add_ellipsoid(body, shank, {-0.008, 0, -0.075}, {0.031, 0.030, 0.080});  // calf
  add_limb(body, foot, {-0.020, 0, 0.025 - kAnkleHeight}, 0.025, {0.092, 0, 0.018 - kAnkleHeight},
           0.018);
  add_ellipsoid(body, foot, {0.066, 0, 0.020 - kAnkleHeight}, {0.044, 0.028, 0.020});  // ball
}

Body make_body() {
  Body body;
  add_trunk(body);
  add_arm(body, BodySegment::kUpperArmLeft, BodySegment::kForearmLeft);
  add_arm(body, BodySegment::kUpperArmRight, BodySegment::kForearmRight);
  add_leg(body, BodySegment::kThighLeft, BodySegment::kShankLeft, BodySegment::kFootLeft);
  add_leg(body, BodySegment::kThighRight, BodySegment::kShankRight, BodySegment::kFootRight);
  return body;
}

class Person final : public Subject {
 public:
  Person(const scenarios::StudioSubject& subject, double speed_factor)
      : motion_(subject, speed_factor), height_m_(subject.height_m) {
    for (BodyPart& part : make_body()) {
      for (Eigen::Vector3f& vertex : part.mesh.vertices) vertex *= static_cast<float>(height_m_);
      part.pose.translation() *= height_m_;
      parts_.push_back(std::move(part.mesh));
      joints_.push_back({part.segment, part.pose});
    }
  }

  const std::vector<TriangleMesh>& parts() const override { return parts_; }

  std::vector<Isometry3d> poses(double seconds) const override {
    const MotionState state = motion_.at(seconds);
    const SegmentPoses segments = segment_poses(state.posture, height_m_);
    std::vector<Isometry3d> poses;
    poses.reserve(joints_.size());
    for (const Joint& joint : joints_) {
      poses.push_back(state.root * segments[static_cast<std::size_t>(joint.segment)] * joint.pose);
    }
    return poses;
  }

 private:
  struct Joint {
    BodySegment segment;
    Isometry3d pose;  // of the part in its segment's frame
  };
  Motion motion_;
  double height_m_;
  std::vector<TriangleMesh> parts_;
  std::vector<Joint> joints_;
};

class RigidSubject final : public Subject {
 public:
  RigidSubject(TriangleMesh mesh, const scenarios::StudioSubject& subject, double speed_factor)
      : motion_(subject, speed_factor) {
    parts_.push_back(std::move(mesh));
  }

  const std::vector<TriangleMesh>& parts() const override { return parts_; }
  std::vector<Eigen::Isometry3d> poses(double seconds) const override {
    return {motion_.at(seconds).root};
  }

 private:
  Motion motion_;
  std::vector<TriangleMesh> parts_;
};

}  // namespace

std::unique_ptr<Subject> make_person(const scenarios::StudioSubject& subject, double speed_factor) {
  if (!(subject.height_m > 0)) {
    throw std::invalid_argument(
        fmt::format("a person of {} m, must be more than 0", subject.height_m));
  }
  return std::make_unique<Person>(subject, speed_factor);
}

std::unique_ptr<Subject> make_rigid_subject(TriangleMesh mesh,
                                            const scenarios::StudioSubject& subject,
                                            double speed_factor) {
  return std::make_unique<RigidSubject>(std::move(mesh), subject, speed_factor);
}

}  // namespace simbench::reconstruction
