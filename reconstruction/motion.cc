#include "reconstruction/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace simbench::reconstruction {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

// Gait angles at kGaitSpeed; the knee leads the hip a little: it bends most early in the swing.
constexpr double kGaitSpeed = 1.2;  // m/s
constexpr double kHipSwing = 25 * kDegree;
constexpr double kLargestHipSwing = 35 * kDegree;
constexpr double kKneeBend = 50 * kDegree;
constexpr double kKneeLead = 0.25;
constexpr double kShoulderSwing = 20 * kDegree;
constexpr double kElbowBend = 20 * kDegree;

// The place after walking `distance` to and fro: from 0 up to +kWalkLength / 2 first.
double to_and_fro(double distance) {
  const double turns = distance / (2 * kWalkLength) + 0.25;
  return kWalkLength * (0.5 - 2 * std::abs(turns - std::floor(turns) - 0.5));
}

double knee(double phase) {
  const double share = (1 + std::cos(phase + kKneeLead)) / 2;
  return kKneeBend * share * share;
}

// After `distance` m of walking ahead; negative: backwards.
Posture gait(double distance, double speed_m_per_s) {
  const double scale =
      std::min(std::sqrt(std::abs(speed_m_per_s) / kGaitSpeed), kLargestHipSwing / kHipSwing);
  const double phase = 2 * kPi * distance / kStrideLength;
  Posture posture;
  posture.hip_swing = scale * kHipSwing * std::sin(phase);
  posture.knee_left = scale * knee(phase);
  posture.knee_right = scale * knee(phase + kPi);
  posture.shoulder_swing = scale * kShoulderSwing * std::sin(phase);
  posture.elbow = scale * kElbowBend;
  return posture;
}

}  // namespace

Motion::Motion(const scenarios::StudioSubject& subject, double speed_factor)
    : speed_factor_(speed_factor) {
  if (walks(subject.motion)) walk_speed_m_per_s_ = subject.walk_speed_m_per_s;
  if (turns(subject.motion)) turn_rate_rad_per_s_ = subject.turn_rate_rad_per_s;
  if (subject.motion == scenarios::MotionScript::kRaiseArms) {
    arm_rate_rad_per_s_ = subject.arm_rate_rad_per_s;
  }
}

MotionState Motion::at(double seconds) const {
  const double time = seconds * speed_factor_;
  const double heading = turn_rate_rad_per_s_ * time;
  double walked = walk_speed_m_per_s_ * time;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  if (walk_speed_m_per_s_ != 0 && turn_rate_rad_per_s_ == 0) {
    walked = to_and_fro(walked);
    position.x() = walked;
  } else if (turn_rate_rad_per_s_ != 0) {
    const double radius = walk_speed_m_per_s_ / turn_rate_rad_per_s_;
    position = {radius * std::sin(heading), -radius * std::cos(heading), 0};
  }
  MotionState state;
  state.root =
      Eigen::Translation3d(position) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
  state.posture = gait(walked, walk_speed_m_per_s_);
  state.posture.arms_raised = kPi / 2 * (1 - std::cos(arm_rate_rad_per_s_ * time));
  return state;
}

}  // namespace simbench::reconstruction
