#include "reconstruction/skeleton.h"

#include <gmock/gmock.h>

#include <cmath>

#include "sim/engine/random.h"
#include "tests/nonempty.h"
#include "tests/reconstruction/angles.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Vector3d;

constexpr double kPersonHeight = 2.0;

Eigen::Isometry3d pose(const Posture& posture, BodySegment segment) {
  return segment_poses(posture, kPersonHeight)[static_cast<std::size_t>(segment)];
}

Vector3d joint(const Posture& posture, BodySegment segment) {
  return pose(posture, segment).translation() / kPersonHeight;
}

void expect_point(const Vector3d& found, const Vector3d& expected) {
  EXPECT_NEAR((found - expected).norm(), 0, 1e-9)
      << found.transpose() << " in place of " << expected.transpose();
}

TEST(Skeleton, StandsUpright) {
  const Posture standing;
  for (const BodySegment upright : {BodySegment::kTrunk, BodySegment::kThighLeft,
                                    BodySegment::kShankRight, BodySegment::kFootLeft}) {
    EXPECT_TRUE(pose(standing, upright).linear().isIdentity(1e-12));
  }
  expect_point(joint(standing, BodySegment::kTrunk), {0, 0, 0});
  expect_point(joint(standing, BodySegment::kThighLeft), {0, 0.052, 0.530});
  expect_point(joint(standing, BodySegment::kShankRight), {0, -0.052, 0.285});
  expect_point(joint(standing, BodySegment::kFootLeft), {0, 0.052, 0.039});
  expect_point(joint(standing, BodySegment::kUpperArmLeft), {0, 0.113, 0.812});
  // Hanging arms are a little away from the body.
  const double out = 0.186 * std::sin(0.12);
  expect_point(joint(standing, BodySegment::kForearmLeft),
               {0, 0.113 + out, 0.812 - 0.186 * std::cos(0.12)});
  expect_point(joint(standing, BodySegment::kForearmRight),
               {0, -0.113 - out, 0.812 - 0.186 * std::cos(0.12)});
}

TEST(Skeleton, HipsSwingAgainstEachOther) {
  const Posture posture{.hip_swing = kPi / 2};
  expect_point(joint(posture, BodySegment::kShankLeft), {0.245, 0.052, 0.530});
  expect_point(joint(posture, BodySegment::kShankRight), {-0.245, -0.052, 0.530});
  expect_point(joint(posture, BodySegment::kFootLeft), {0.245 + 0.246, 0.052, 0.530});
}

TEST(Skeleton, KneesBendBackwards) {
  const Posture posture{.knee_left = kPi / 2};
  expect_point(joint(posture, BodySegment::kFootLeft), {-0.246, 0.052, 0.285});
  expect_point(joint(posture, BodySegment::kFootRight), {0, -0.052, 0.039});
  const Posture sitting{.hip_swing = kPi / 2, .knee_left = kPi / 2};
  expect_point(joint(sitting, BodySegment::kFootLeft), {0.245, 0.052, 0.530 - 0.246});
  EXPECT_TRUE(pose(sitting, BodySegment::kFootLeft).linear().isIdentity(1e-12));
}

TEST(Skeleton, FeetStayLevelAtFirstAndFollowInTheEnd) {
  const auto toes_down = [](double lean) {
    return -std::asin(pose({.knee_left = lean}, BodySegment::kFootLeft).linear()(2, 0));
  };
  EXPECT_LT(toes_down(0.1), 0.02);
  EXPECT_NEAR(toes_down(0.4), 0.2, 1e-9);
  EXPECT_GT(toes_down(1.2), 1.0);
  EXPECT_NEAR(toes_down(-0.4), -0.2, 1e-9);
}

TEST(Skeleton, ArmsGoSidewaysUpToOverhead) {
  const double level = (kPi / 2 - kRestingArm) / (1 - kRestingArm / kPi);
  expect_point(joint({.arms_raised = level}, BodySegment::kForearmLeft), {0, 0.113 + 0.186, 0.812});
  expect_point(joint({.arms_raised = level}, BodySegment::kForearmRight),
               {0, -0.113 - 0.186, 0.812});
  expect_point(joint({.arms_raised = kPi}, BodySegment::kForearmLeft), {0, 0.113, 0.812 + 0.186});
}

TEST(Skeleton, ShouldersSwingAndElbowsBendForwards) {
  const Posture swung{.shoulder_swing = 0.5};
  EXPECT_GT(joint(swung, BodySegment::kForearmRight).x(), 0.05);
  EXPECT_LT(joint(swung, BodySegment::kForearmLeft).x(), -0.05);
  const Posture bent{.elbow = 0.5};
  for (const BodySegment forearm : {BodySegment::kForearmLeft, BodySegment::kForearmRight}) {
    EXPECT_NEAR((pose(bent, forearm) * Vector3d(0, 0, -1)).x(), std::sin(0.5), 1e-9);
  }
}

// Bones keep their lengths and poses stay rigid, whatever the posture.
TEST(Skeleton, BonesAreRigid) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  sim::RandomStream random(kSeed, "skeleton test");
  const auto angle = [&] { return random.uniform(-1.5, 1.5); };
  for (int i = 0; i < 200; ++i) {
    const Posture posture{angle(), angle(), angle(), angle(), angle(), angle()};
    for (const Eigen::Isometry3d& segment : nonempty(segment_poses(posture, kPersonHeight))) {
      EXPECT_NEAR(
          (segment.linear() * segment.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0,
          1e-12);
      EXPECT_NEAR(segment.linear().determinant(), 1, 1e-12);
    }
    const auto length = [&](BodySegment from, BodySegment to) {
      return (joint(posture, from) - joint(posture, to)).norm();
    };
    EXPECT_NEAR(length(BodySegment::kThighLeft, BodySegment::kShankLeft), 0.245, 1e-12);
    EXPECT_NEAR(length(BodySegment::kShankRight, BodySegment::kFootRight), 0.246, 1e-12);
    EXPECT_NEAR(length(BodySegment::kUpperArmRight, BodySegment::kForearmRight), 0.186, 1e-12);
  }
}

}  // namespace
}  // namespace simbench::reconstruction
