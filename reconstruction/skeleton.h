// The joints of a person: from the angles of a posture to the poses of the body's segments.
//
// All lengths are shares of the person's height. A segment's frame has its origin at the joint from
// which it hangs (the trunk's: on the floor below the pelvis), x ahead, y to the left, z up, as it
// is when the person stands with the arms hanging straight down.
//
// The pelvis keeps its height and its bearing: where the legs are farthest apart both soles are
// above the floor, 6 cm at 1.2 m/s and a height of 1.75 m. Ankles bend so far that no foot goes
// through the floor. A hanging arm is held kRestingArm to the side.
//
// Source of the lengths: Drillis and Contini 1966, as in Winter, Biomechanics and Motor Control of
// Human Movement, figure 4.1.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "reconstruction/motion.h"

namespace simbench::reconstruction {

inline constexpr double kAnkleHeight = 0.039;
inline constexpr double kKneeHeight = 0.285;
inline constexpr double kHipHeight = 0.530;
inline constexpr double kHipHalfWidth = 0.052;  // between the joints, not the trochanters
inline constexpr double kShoulderHeight = 0.812;
inline constexpr double kShoulderHalfWidth = 0.113;
inline constexpr double kUpperArm = 0.186;
inline constexpr double kForearm = 0.146;
inline constexpr double kRestingArm = 0.12;  // rad

enum class BodySegment {
  kTrunk,  // with neck and head
  kUpperArmLeft,
  kForearmLeft,  // with the hand
  kUpperArmRight,
  kForearmRight,
  kThighLeft,
  kShankLeft,
  kFootLeft,
  kThighRight,
  kShankRight,
  kFootRight,
};
inline constexpr std::size_t kSegments = 11;

using SegmentPoses = std::array<Eigen::Isometry3d, kSegments>;

// In the frame of the trunk, which is the root's; lengths in metres.
SegmentPoses segment_poses(const Posture& posture, double height_m);

}  // namespace simbench::reconstruction
