#include "reconstruction/rigid_subject.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>

#include "reconstruction/motion.h"
#include "reconstruction/primitives.h"

namespace simbench::reconstruction {
namespace {

scenarios::StudioSubject mesh_that(const std::string& motion) {
  scenarios::StudioSubject subject;
  subject.kind = scenarios::SubjectKind::kMesh;
  subject.motion = scenarios::from_text<scenarios::MotionScript>(motion).value();
  subject.walk_speed_m_per_s = 0.9;
  subject.turn_rate_rad_per_s = 0.6;
  subject.arm_rate_rad_per_s = 1.0;
  return subject;
}

TEST(RigidSubject, FollowsTheScriptAsAWhole) {
  const TriangleMesh box = make_box({0.4, 0.6, 1.0});
  for (const std::string motion : {"stand", "turn", "walk", "walk_and_turn", "raise_arms"}) {
    SCOPED_TRACE(motion);
    const auto subject = make_rigid_subject(box, mesh_that(motion), 2.0);
    ASSERT_EQ(subject->parts().size(), 1U);
    EXPECT_EQ(subject->parts()[0].vertices, box.vertices);
    EXPECT_EQ(subject->parts()[0].triangles, box.triangles);
    for (const double t : {-1.0, 0.0, 0.25, 7.0}) {
      const auto poses = subject->poses(t);
      ASSERT_EQ(poses.size(), 1U);
      EXPECT_TRUE(poses[0].isApprox(Motion(mesh_that(motion), 2.0).at(t).root, 1e-15));
    }
  }
}

TEST(RigidSubject, WalksByHand) {
  const auto subject = make_rigid_subject(make_sphere(0.3, 0.001), mesh_that("walk"), 2.0);
  EXPECT_NEAR(subject->poses(0.1)[0].translation().x(), 0.18, 1e-12);
}

}  // namespace
}  // namespace simbench::reconstruction
