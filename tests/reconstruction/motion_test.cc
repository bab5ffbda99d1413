#include "reconstruction/motion.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/engine/random.h"
#include "tests/reconstruction/angles.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Vector3d;

scenarios::StudioSubject person_that(const std::string& motion) {
  scenarios::StudioSubject subject;
  subject.kind = scenarios::SubjectKind::kPerson;
  subject.height_m = 1.75;
  subject.motion = scenarios::from_text<scenarios::MotionScript>(motion).value();
  subject.walk_speed_m_per_s = 1.2;
  subject.turn_rate_rad_per_s = 1.5;
  subject.arm_rate_rad_per_s = 2.0;
  return subject;
}

const std::array<std::string, 5> kScripts = {"stand", "turn", "walk", "walk_and_turn",
                                             "raise_arms"};

std::array<double, 6> angles(const Posture& p) {
  return {p.hip_swing, p.knee_left, p.knee_right, p.shoulder_swing, p.elbow, p.arms_raised};
}

double heading(const MotionState& state) {
  const Vector3d ahead = state.root.linear().col(0);
  return std::atan2(ahead.y(), ahead.x());
}

// On the floor and upright.
void expect_on_floor(const MotionState& state) {
  EXPECT_EQ(state.root.translation().z(), 0);
  EXPECT_NEAR((state.root.linear().col(2) - Vector3d::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR(state.root.linear().determinant(), 1, 1e-12);
}

TEST(Motion, Stand) {
  const Motion motion(person_that("stand"));
  for (const double t : {-3.0, 0.0, 0.1, 100.0}) {
    EXPECT_TRUE(motion.at(t).root.isApprox(Eigen::Isometry3d::Identity()));
    for (const double angle : angles(motion.at(t).posture)) EXPECT_EQ(angle, 0);
  }
}

TEST(Motion, TurnIsCounterClockwiseOnTheSpot) {
  const Motion motion(person_that("turn"));
  for (const double t : {-0.5, 0.0, 0.1, 1.0, 2.0}) {
    const MotionState state = motion.at(t);
    expect_on_floor(state);
    EXPECT_EQ(state.root.translation().norm(), 0);
    EXPECT_NEAR(heading(state), 1.5 * t, 1e-12);
    for (const double angle : angles(state.posture)) EXPECT_EQ(angle, 0);
  }
}

TEST(Motion, WalkGoesToAndFroAtItsSpeed) {
  const Motion motion(person_that("walk"));
  const double period = 2 * kWalkLength / 1.2;
  const auto x = [&](double t) { return motion.at(t).root.translation().x(); };
  EXPECT_DOUBLE_EQ(x(0), 0);
  EXPECT_NEAR(x(0.1), 0.12, 1e-12);
  EXPECT_NEAR(x(-0.1), -0.12, 1e-12);
  EXPECT_NEAR(x(period / 4), kWalkLength / 2, 1e-12);
  EXPECT_NEAR(x(period / 2), 0, 1e-12);
  EXPECT_NEAR(x(3 * period / 4), -kWalkLength / 2, 1e-12);
  constexpr double kStep = 1e-6;
  for (double t = -5; t < 5; t += 0.0173) {
    const MotionState state = motion.at(t);
    expect_on_floor(state);
    EXPECT_EQ(state.root.translation().y(), 0);
    EXPECT_EQ(heading(state), 0);
    EXPECT_NEAR(x(t), x(t + period), 1e-9);
    EXPECT_LE(std::abs(x(t)), kWalkLength / 2 + 1e-12);
    const double from_end = kWalkLength / 2 - std::abs(x(t));
    if (from_end > 2e-6) {
      EXPECT_NEAR(std::abs(x(t + kStep) - x(t)) / kStep, 1.2, 1e-6) << t;
    }
  }
}

TEST(Motion, WalkAndTurnGoesAlongACircleFacingAhead) {
  const Motion motion(person_that("walk_and_turn"));
  EXPECT_NEAR((motion.at(0).root.translation() - Vector3d(0, -0.8, 0)).norm(), 0, 1e-12);
  constexpr double kStep = 1e-5;
  for (double t = -5; t < 5; t += 0.0173) {
    const MotionState state = motion.at(t);
    expect_on_floor(state);
    EXPECT_NEAR(state.root.translation().norm(), 1.2 / 1.5, 1e-12);
    EXPECT_NEAR(std::remainder(heading(state) - 1.5 * t, 2 * kPi), 0, 1e-9);
    const Vector3d velocity =
        (motion.at(t + kStep).root.translation() - motion.at(t - kStep).root.translation()) /
        (2 * kStep);
    EXPECT_NEAR((velocity - 1.2 * state.root.linear().col(0)).norm(), 0, 1e-6) << t;
  }
}

TEST(Motion, TurningBackwardsIsACircleToo) {
  scenarios::StudioSubject subject = person_that("walk_and_turn");
  subject.turn_rate_rad_per_s = -1.5;
  const Motion motion(subject);
  for (const double t : {0.0, 0.3, 2.0}) {
    const Vector3d velocity =
        (motion.at(t + 1e-5).root.translation() - motion.at(t - 1e-5).root.translation()) / 2e-5;
    EXPECT_NEAR((velocity - 1.2 * motion.at(t).root.linear().col(0)).norm(), 0, 1e-6) << t;
  }
}

TEST(Motion, WalkAndTurnWithoutOneOfTheTwo) {
  scenarios::StudioSubject straight = person_that("walk_and_turn");
  straight.turn_rate_rad_per_s = 0;
  scenarios::StudioSubject spot = person_that("walk_and_turn");
  spot.walk_speed_m_per_s = 0;
  for (const double t : {-1.0, 0.0, 0.4, 1.7}) {
    const MotionState walk = Motion(person_that("walk")).at(t);
    EXPECT_TRUE(Motion(straight).at(t).root.isApprox(walk.root, 1e-15));
    EXPECT_EQ(angles(Motion(straight).at(t).posture), angles(walk.posture));
    EXPECT_TRUE(Motion(spot).at(t).root.isApprox(Motion(person_that("turn")).at(t).root, 1e-15));
    for (const double angle : angles(Motion(spot).at(t).posture)) EXPECT_EQ(angle, 0);
  }
}

TEST(Motion, ArmsGoUpAndDownAtTheirMeanRate) {
  const Motion motion(person_that("raise_arms"));
  const auto raised = [&](double t) { return motion.at(t).posture.arms_raised; };
  const double up = kPi / 2.0;  // pi at a mean of 2 rad/s
  EXPECT_EQ(raised(0), 0);
  EXPECT_NEAR(raised(up / 2), kPi / 2, 1e-12);
  EXPECT_NEAR(raised(up), kPi, 1e-12);
  EXPECT_NEAR(raised(2 * up), 0, 1e-12);
  double fastest = 0;
  for (double t = 0; t < 2 * up; t += 0.001) {
    EXPECT_GE(raised(t), 0);
    EXPECT_LE(raised(t), kPi);
    EXPECT_TRUE(motion.at(t).root.isApprox(Eigen::Isometry3d::Identity()));
    fastest = std::max(fastest, std::abs(raised(t + 1e-5) - raised(t)) / 1e-5);
  }
  EXPECT_NEAR(fastest, 2.0 * kPi / 2, 1e-3);
}

TEST(Motion, ASpedUpScriptFollowsTheSamePath) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  sim::RandomStream random(kSeed, "motion test");
  const auto instant = [&] { return random.uniform(-5, 5); };
  for (const std::string& name : kScripts) {
    SCOPED_TRACE(name);
    for (int i = 0; i < 100; ++i) {
      const double t = instant();
      const MotionState fast = Motion(person_that(name), 2.5).at(t);
      const MotionState slow = Motion(person_that(name)).at(2.5 * t);
      EXPECT_TRUE(fast.root.isApprox(slow.root, 1e-12));
      EXPECT_EQ(angles(fast.posture), angles(slow.posture));
    }
  }
}

TEST(Motion, ASpeedFactorOfZeroStandsStill) {
  for (const std::string& name : kScripts) {
    const Motion motion(person_that(name), 0);
    EXPECT_TRUE(motion.at(3).root.isApprox(motion.at(0).root));
    EXPECT_EQ(angles(motion.at(3).posture), angles(motion.at(0).posture));
  }
}

// Limbs: amplitude times phase rate, knees at most 50 degrees a half stride and a bit.
TEST(Motion, NothingJumps) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  sim::RandomStream random(kSeed, "motion test");
  const auto instant = [&] { return random.uniform(-20, 20); };
  constexpr double kStep = 1e-4;
  const double phase_rate = 2 * kPi * 1.2 / kStrideLength;
  const std::array<double, 6> fastest = {25 * kDegree * phase_rate,
                                         50 * kDegree * phase_rate,
                                         50 * kDegree * phase_rate,
                                         20 * kDegree * phase_rate,
                                         0,
                                         kPi};
  for (const std::string& name : kScripts) {
    SCOPED_TRACE(name);
    const Motion motion(person_that(name));
    for (int i = 0; i < 2000; ++i) {
      const double t = instant();
      const MotionState before = motion.at(t);
      const MotionState after = motion.at(t + kStep);
      EXPECT_LE((after.root.translation() - before.root.translation()).norm(),
                1.2 * kStep * (1 + 1e-6));
      EXPECT_LE(std::abs(std::remainder(heading(after) - heading(before), 2 * kPi)),
                1.5 * kStep * (1 + 1e-6));
      for (std::size_t a = 0; a < fastest.size(); ++a) {
        EXPECT_LE(std::abs(angles(after.posture)[a] - angles(before.posture)[a]),
                  fastest[a] * kStep + 1e-12)
            << "angle " << a << " at " << t;
      }
    }
  }
}

// Velocities do not jump either: second differences are of second order.
TEST(Motion, LimbsAreContinuouslyDifferentiable) {
  constexpr double kStep = 1e-4;
  for (const std::string name : {"walk_and_turn", "raise_arms"}) {
    SCOPED_TRACE(name);
    const Motion motion(person_that(name));
    for (double t = -4; t < 4; t += 0.00137) {
      const auto before = angles(motion.at(t - kStep).posture);
      const auto now = angles(motion.at(t).posture);
      const auto after = angles(motion.at(t + kStep).posture);
      for (std::size_t a = 0; a < now.size(); ++a) {
        ASSERT_LT(std::abs(before[a] - 2 * now[a] + after[a]), 60 * kStep * kStep)
            << "angle " << a << " at " << t;
      }
    }
  }
}

TEST(Motion, AStrideSwingsLegsAndArmsAgainstEachOther) {
  const Motion motion(person_that("walk_and_turn"));
  const double stride = kStrideLength / 1.2;
  double widest = 0;
  double most_bent = 0;
  for (double t = 0; t < stride; t += stride / 400) {
    const Posture now = motion.at(t).posture;
    const Posture next_step = motion.at(t + stride / 2).posture;
    const Posture next_stride = motion.at(t + stride).posture;
    EXPECT_NEAR(next_step.hip_swing, -now.hip_swing, 1e-9);
    EXPECT_NEAR(next_step.knee_right, now.knee_left, 1e-9);
    EXPECT_NEAR(next_step.knee_left, now.knee_right, 1e-9);
    EXPECT_NEAR(next_stride.hip_swing, now.hip_swing, 1e-9);
    EXPECT_NEAR(next_stride.knee_left, now.knee_left, 1e-9);
    EXPECT_GE(now.hip_swing * now.shoulder_swing, 0);  // the other side's arm goes along
    EXPECT_GE(now.knee_left, 0);
    EXPECT_GT(now.elbow, 0);
    EXPECT_EQ(now.arms_raised, 0);
    widest = std::max(widest, std::abs(now.hip_swing));
    most_bent = std::max(most_bent, now.knee_left);
  }
  EXPECT_NEAR(widest, 25 * kDegree, 1e-4);
  EXPECT_NEAR(most_bent, 50 * kDegree, 1e-3);
}

// At 0 s the left leg passes the right one: bent, on its way ahead.
TEST(Motion, TheSwingingLegIsTheBentOne) {
  for (const std::string name : {"walk", "walk_and_turn"}) {
    const Motion motion(person_that(name));
    const Posture now = motion.at(0).posture;
    EXPECT_NEAR(now.hip_swing, 0, 1e-12);
    EXPECT_GT(motion.at(0.01).posture.hip_swing, 0);
    EXPECT_GT(now.knee_left, 40 * kDegree);
    EXPECT_LT(now.knee_right, 2 * kDegree);
  }
}

TEST(Motion, StridesGrowWithTheSpeedUpToALimit) {
  const auto widest = [](double speed) {
    scenarios::StudioSubject subject = person_that("walk_and_turn");
    subject.walk_speed_m_per_s = speed;
    return Motion(subject).at(kStrideLength / 4 / speed).posture.hip_swing;
  };
  EXPECT_NEAR(widest(0.3), 12.5 * kDegree, 1e-9);
  EXPECT_NEAR(widest(1.2), 25 * kDegree, 1e-9);
  EXPECT_NEAR(widest(10), 35 * kDegree, 1e-9);
}

}  // namespace
}  // namespace simbench::reconstruction
