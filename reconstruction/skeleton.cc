#include "reconstruction/skeleton.h"

#include <numbers>

namespace simbench::reconstruction {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::size_t index(BodySegment segment) { return static_cast<std::size_t>(segment); }

// Turns a hanging limb forwards by `angle`.
Isometry3d forwards(double angle) {
  return Isometry3d(Eigen::AngleAxisd(-angle, Vector3d::UnitY()));
}

// Turns a hanging limb to the left by `angle`.
Isometry3d leftwards(double angle) {
  return Isometry3d(Eigen::AngleAxisd(angle, Vector3d::UnitX()));
}

Isometry3d at(const Vector3d& joint) { return Isometry3d(Eigen::Translation3d(joint)); }

// The angle by which toes point down when the shank leans backwards by `lean`: almost nothing at
// first, since the toes would go through the floor, all of it in the end.
double toes_down(double lean) {
  constexpr double kGivesWay = 0.4;  // rad
  return lean * lean * lean / (lean * lean + kGivesWay * kGivesWay);
}

struct Side {
  double sign;  // of y
  BodySegment upper_arm, forearm, thigh, shank, foot;
};
constexpr Side kLeft{1,
                     BodySegment::kUpperArmLeft,
                     BodySegment::kForearmLeft,
                     BodySegment::kThighLeft,
                     BodySegment::kShankLeft,
                     BodySegment::kFootLeft};
constexpr Side kRight{-1,
                      BodySegment::kUpperArmRight,
                      BodySegment::kForearmRight,
                      BodySegment::kThighRight,
                      BodySegment::kShankRight,
                      BodySegment::kFootRight};

void place_arm(SegmentPoses& poses, const Side& side, const Posture& posture, double height_m) {
  const double raised = kRestingArm + (1 - kRestingArm / std::numbers::pi) * posture.arms_raised;
  const Vector3d shoulder(0, side.sign * kShoulderHalfWidth, kShoulderHeight);
  const Isometry3d upper_arm = at(shoulder * height_m) *
                               forwards(-side.sign * posture.shoulder_swing) *
                               leftwards(side.sign * raised);
  poses[index(side.upper_arm)] = upper_arm;
  poses[index(side.forearm)] =
      upper_arm * at({0, 0, -kUpperArm * height_m}) * forwards(posture.elbow);
}

void place_leg(SegmentPoses& poses, const Side& side, const Posture& posture, double height_m) {
  const double swing = side.sign * posture.hip_swing;
  const double bend = side.sign > 0 ? posture.knee_left : posture.knee_right;
  const Vector3d hip(0, side.sign * kHipHalfWidth, kHipHeight);
  const Isometry3d thigh = at(hip * height_m) * forwards(swing);
  const Isometry3d shank =
      thigh * at({0, 0, (kKneeHeight - kHipHeight) * height_m}) * forwards(-bend);
  const Isometry3d ankle = shank * at({0, 0, (kAnkleHeight - kKneeHeight) * height_m});
  poses[index(side.thigh)] = thigh;
  poses[index(side.shank)] = shank;
  poses[index(side.foot)] = at(ankle.translation()) * forwards(-toes_down(bend - swing));
}

}  // namespace

SegmentPoses segment_poses(const Posture& posture, double height_m) {
  SegmentPoses poses;
  poses[index(BodySegment::kTrunk)] = Isometry3d::Identity();
  for (const Side& side : {kLeft, kRight}) {
    place_arm(poses, side, posture, height_m);
    place_leg(poses, side, posture, height_m);
  }
  return poses;
}

}  // namespace simbench::reconstruction
