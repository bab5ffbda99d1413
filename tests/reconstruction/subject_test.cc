#include "reconstruction/subject.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "reconstruction/motion.h"
#include "reconstruction/primitives.h"
#include "sim/engine/random.h"
#include "tests/nonempty.h"
#include "tests/reconstruction/box.h"

namespace simbench::reconstruction {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

scenarios::StudioSubject script(const std::string& motion, double height_m = 1.75) {
  scenarios::StudioSubject subject;
  subject.kind = scenarios::SubjectKind::kPerson;
  subject.height_m = height_m;
  subject.motion = scenarios::from_text<scenarios::MotionScript>(motion).value();
  subject.walk_speed_m_per_s = 1.2;
  subject.turn_rate_rad_per_s = 1.0;
  subject.arm_rate_rad_per_s = 1.0;
  return subject;
}

// All vertices of each part, in the world.
std::vector<std::vector<Vector3d>> placed(const Subject& subject, double seconds) {
  const std::vector<Eigen::Isometry3d> poses = subject.poses(seconds);
  EXPECT_EQ(poses.size(), subject.parts().size());
  std::vector<std::vector<Vector3d>> parts;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    parts.emplace_back();
    for (const Eigen::Vector3f& vertex : subject.parts()[i].vertices) {
      parts.back().push_back(poses[i] * vertex.cast<double>());
    }
  }
  return parts;
}

AlignedBox3d bounds(const Subject& subject, double seconds) {
  AlignedBox3d box;
  for (const auto& part : placed(subject, seconds)) {
    for (const Vector3d& vertex : part) box.extend(vertex);
  }
  return box;
}

TEST(Person, StandsOnTheFloorAtItsHeight) {
  for (const double height : {1.2, 1.75, 2.0}) {
    SCOPED_TRACE(height);
    const AlignedBox3d box = bounds(*make_person(script("stand", height), 1.0), 0);
    EXPECT_NEAR(box.min().z(), 0, 0.002);
    EXPECT_NEAR(box.max().z(), height, 0.002);
    // Slim, as wide on the left as on the right, with feet that point ahead.
    EXPECT_NEAR(box.max().y(), -box.min().y(), 1e-4);
    EXPECT_NEAR(box.sizes().y() / height, 0.37, 0.06);
    EXPECT_NEAR(box.sizes().x() / height, 0.17, 0.03);
    EXPECT_GT(box.max().x(), 1.4 * -box.min().x());
  }
}

TEST(Person, FeetAndNosePointAhead) {
  const auto person = make_person(script("stand"), 1.0);
  AlignedBox3d feet;
  AlignedBox3d head;
  for (const auto& part : placed(*person, 0)) {
    for (const Vector3d& vertex : part) {
      if (vertex.z() < 0.05) feet.extend(vertex);
      if (vertex.z() > 1.58) head.extend(vertex);
    }
  }
  EXPECT_NEAR(feet.sizes().x(), 0.152 * 1.75, 0.03);
  EXPECT_GT(feet.max().x(), 2 * -feet.min().x());
  EXPECT_GT(head.max().x(), -head.min().x() + 0.02);
}

TEST(Person, IsSymmetricalStanding) {
  const auto person = make_person(script("stand"), 1.0);
  const auto parts = placed(*person, 0);
  for (const auto& part : nonempty(parts)) {
    AlignedBox3d box;
    for (const Vector3d& vertex : part) box.extend(vertex);
    const bool has_mirror = std::any_of(parts.begin(), parts.end(), [&](const auto& other) {
      AlignedBox3d mirrored;
      for (const Vector3d& v : other) mirrored.extend(Vector3d(v.x(), -v.y(), v.z()));
      return (mirrored.min() - box.min()).norm() < 0.002 &&
             (mirrored.max() - box.max()).norm() < 0.002;
    });
    EXPECT_TRUE(has_mirror) << box.center().transpose();
  }
}

TEST(Person, ScalesWithItsHeight) {
  const auto small = make_person(script("walk", 1.0), 1.0);
  const auto large = make_person(script("walk", 2.0), 1.0);
  ASSERT_EQ(small->parts().size(), large->parts().size());
  const double t = 0.2;
  const Vector3d root(1.2 * t, 0, 0);
  for (std::size_t i = 0; i < small->parts().size(); ++i) {
    ASSERT_EQ(small->parts()[i].triangles, large->parts()[i].triangles);
    const Vector3d a = small->poses(t)[i] * small->parts()[i].vertices[5].cast<double>() - root;
    const Vector3d b = large->poses(t)[i] * large->parts()[i].vertices[5].cast<double>() - root;
    EXPECT_NEAR((2 * a - b).norm(), 0, 1e-6);
  }
}

// Whether some vertex of `inner` is inside the convex `outer`.
bool reaches_into(const std::vector<Vector3d>& inner, const std::vector<Vector3d>& outer,
                  const TriangleMesh& outer_mesh) {
  AlignedBox3d box;
  for (const Vector3d& vertex : outer) box.extend(vertex);
  const auto corner = [&](int i) { return outer[static_cast<std::size_t>(i)]; };
  return std::any_of(inner.begin(), inner.end(), [&](const Vector3d& point) {
    return box.contains(point) &&
           std::all_of(outer_mesh.triangles.begin(), outer_mesh.triangles.end(),
                       [&](const Eigen::Vector3i& t) {
                         const Vector3d a = corner(t[0]);
                         return (corner(t[1]) - a).cross(corner(t[2]) - a).dot(point - a) < 0;
                       });
  });
}

// The number of pieces into which the person falls.
int pieces(const Subject& person, double seconds) {
  const auto parts = placed(person, seconds);
  std::vector<std::size_t> piece(parts.size());
  std::iota(piece.begin(), piece.end(), std::size_t{0});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (piece[i] == piece[j] || !reaches_into(parts[i], parts[j], person.parts()[j])) continue;
      std::replace(piece.begin(), piece.end(), piece[j], piece[i]);
    }
  }
  std::sort(piece.begin(), piece.end());
  return static_cast<int>(std::unique(piece.begin(), piece.end()) - piece.begin());
}

TEST(Person, IsOnePieceInEveryPose) {
  for (const std::string motion : {"stand", "walk_and_turn", "raise_arms"}) {
    const auto person = make_person(script(motion), 1.0);
    for (const double t : {0.0, 0.6, 3.1}) {
      EXPECT_EQ(pieces(*person, t), 1) << motion << " at " << t;
    }
  }
}

TEST(Person, WalksWithoutGoingThroughTheFloorOrFlying) {
  for (const double speed : {0.3, 1.2, 5.0}) {
    SCOPED_TRACE(speed);
    scenarios::StudioSubject subject = script("walk_and_turn");
    subject.walk_speed_m_per_s = speed;
    const auto person = make_person(subject, 1.0);
    const double stride = kStrideLength / speed;
    for (double t = 0; t < stride; t += stride / 16) {
      const AlignedBox3d box = bounds(*person, t);
      EXPECT_GT(box.min().z(), -0.001) << t / stride;
      EXPECT_LT(box.min().z(), speed > 1.2 ? 0.12 : 0.065) << t / stride;
      EXPECT_NEAR(box.max().z(), 1.75, 0.002);
    }
    EXPECT_LT(bounds(*person, 0).min().z(), 0.01);  // on the leg in support
  }
}

TEST(Person, LimbsAreFasterThanTheBody) {
  const auto person = make_person(script("walk_and_turn"), 1.0);
  const double step = 1e-4;
  double fastest = 0;
  for (double t = 0; t < 1.2; t += 0.05) {
    const auto before = placed(*person, t);
    const auto after = placed(*person, t + step);
    for (std::size_t i = 0; i < before.size(); ++i) {
      for (std::size_t k = 0; k < before[i].size(); k += 10) {
        fastest = std::max(fastest, (after[i][k] - before[i][k]).norm() / step);
      }
    }
  }
  EXPECT_GT(fastest, 2 * 1.2);  // a swinging foot
  EXPECT_LT(fastest, 7);
}

TEST(Person, PosesAreRigidAndFollowTheScript) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  sim::RandomStream random(kSeed, "person test");
  const auto instant = [&] { return random.uniform(-10, 10); };
  for (const std::string motion : {"stand", "turn", "walk", "walk_and_turn", "raise_arms"}) {
    SCOPED_TRACE(motion);
    const auto person = make_person(script(motion), 1.5);
    const Motion root(script(motion), 1.5);
    const Eigen::Isometry3d pelvis = make_person(script("stand"), 1.0)->poses(0)[0];
    for (int i = 0; i < 50; ++i) {
      const double t = instant();
      const auto poses = person->poses(t);
      EXPECT_TRUE(poses[0].isApprox(root.at(t).root * pelvis, 1e-12));
      for (const Eigen::Isometry3d& pose : poses) {
        EXPECT_NEAR(
            (pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0,
            1e-12);
      }
    }
  }
}

TEST(Person, RaisedArmsReachOverhead) {
  const auto person = make_person(script("raise_arms"), 1.0);
  EXPECT_NEAR(bounds(*person, 0).max().z(), 1.75, 0.002);
  EXPECT_GT(bounds(*person, 3.14159).max().z(), 2.1);
  EXPECT_GT(bounds(*person, 1.5708).sizes().y(), 1.6);  // an arm span is about the height
}

TEST(Person, IsFineButNotWasteful) {
  const auto person = make_person(script("stand"), 1.0);
  std::size_t triangles = 0;
  for (const TriangleMesh& part : person->parts()) triangles += part.triangles.size();
  EXPECT_GT(triangles, 5'000U);
  EXPECT_LT(triangles, 40'000U);
}

TEST(Person, BadInputIsRefused) {
  EXPECT_THROW(make_person(script("stand", 0), 1.0), std::invalid_argument);
  EXPECT_THROW(make_person(script("stand", -1), 1.0), std::invalid_argument);
  EXPECT_THROW(make_person(script("stand", std::numeric_limits<double>::quiet_NaN()), 1.0),
               std::invalid_argument);
}

scenarios::StudioSubject mesh_script(const std::string& motion) {
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
    const auto subject = make_rigid_subject(box, mesh_script(motion), 2.0);
    ASSERT_EQ(subject->parts().size(), 1U);
    EXPECT_EQ(subject->parts()[0].vertices, box.vertices);
    EXPECT_EQ(subject->parts()[0].triangles, box.triangles);
    for (const double t : {-1.0, 0.0, 0.25, 7.0}) {
      const auto poses = subject->poses(t);
      ASSERT_EQ(poses.size(), 1U);
      EXPECT_TRUE(poses[0].isApprox(Motion(mesh_script(motion), 2.0).at(t).root, 1e-15));
    }
  }
}

TEST(RigidSubject, WalksByHand) {
  const auto subject = make_rigid_subject(make_sphere(0.3, 0.001), mesh_script("walk"), 2.0);
  EXPECT_NEAR(subject->poses(0.1)[0].translation().x(), 0.18, 1e-12);
}

}  // namespace
}  // namespace simbench::reconstruction
