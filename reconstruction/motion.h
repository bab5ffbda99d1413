// The script of a subject: the pose of its root and the angles of its limbs at any instant.
//
//   stand          at the centre, arms hanging
//   turn           on the spot, counter-clockwise seen from above, at turn_rate_rad_per_s
//   walk           to and fro along x on a path of kWalkLength m about the centre, facing +x (so
//                  backwards every other time), at a constant walk_speed_m_per_s
//   walk_and_turn  along a circle about the centre, facing ahead: at walk_speed_m_per_s and
//                  turn_rate_rad_per_s its radius is their quotient. At a speed of 0 it is `turn`,
//                  at a rate of 0 `walk`
//   raise_arms     at the centre, both arms sideways from hanging to overhead and back, at a mean
//                  arm_rate_rad_per_s (at most pi / 2 times that: it goes as a cosine)
//
// At 0 s the subject faces +x, walks ahead and is in the middle of the path of `walk`; the circle
// of walk_and_turn begins at its southernmost point (lowest y). Arms hang at 0 s.
//
// Walking swings arms and legs with the stride: one cycle of two steps each kStrideLength m, so
// limbs are faster than the body, as a real walker's are. Hips swing by 25 degrees to each side at
// 1.2 m/s and by the square root of the speed otherwise (at most 35), knees bend up to 50 in the
// swing phase, arms swing against the legs. The root moves evenly: it does not bob. All is
// continuously differentiable in time but at the ends of `walk`, where the speed changes its sign.
//
// A sped-up script (speed_factor) follows the same path; walking, turning and arms are all faster
// by that factor.
//
//   const Motion motion(studio.subject);
//   const MotionState state = motion.at(/*seconds=*/0.25);
//
// Source: the paper states only "moving person"; the scripts are those of the reconstruction
// study (docs/reference/calibration.md section 6), gait figures are common ones (stride 1.4 m).
#pragma once

#include <Eigen/Geometry>

#include "scenarios/scenario.h"

namespace simbench::reconstruction {

inline constexpr double kWalkLength = 1.0;    // m
inline constexpr double kStrideLength = 1.4;  // m

// Joint angles of a person, in radians.
struct Posture {
  double hip_swing = 0;  // forwards for the left leg, backwards for the right
  double knee_left = 0;  // bent
  double knee_right = 0;
  double shoulder_swing = 0;  // forwards for the right arm, backwards for the left
  double elbow = 0;           // both, bent
  double arms_raised = 0;     // both sideways: 0 hanging, pi overhead
};

struct MotionState {
  Eigen::Isometry3d root = Eigen::Isometry3d::Identity();  // on the floor, x is ahead
  Posture posture;
};

class Motion {
 public:
  explicit Motion(const scenarios::StudioSubject& subject, double speed_factor = 1.0);
  MotionState at(double seconds) const;

 private:
  double walk_speed_m_per_s_ = 0;  // of the script; 0 if it does not walk, and so on
  double turn_rate_rad_per_s_ = 0;
  double arm_rate_rad_per_s_ = 0;
  double speed_factor_;
};

}  // namespace simbench::reconstruction
