// The subject in the studio: rigid parts with a pose at any instant; a person, or one rigid mesh.
//
// A part's mesh is in the part's own frame; its pose takes it to the world's: metres, z up, the
// floor at z = 0, the studio's centre at the origin. Time is in seconds since the first evaluated
// trigger pulse; negative times are fine. Poses are a pure function of time.
//
//   const std::unique_ptr<Subject> person = make_person(studio.subject, 1.0);
//   const std::vector<Eigen::Isometry3d> poses = person->poses(/*seconds=*/0.25);
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "reconstruction/triangle_mesh.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

class Subject {
 public:
  virtual ~Subject() = default;
  virtual const std::vector<TriangleMesh>& parts() const = 0;
  // One for each part.
  virtual std::vector<Eigen::Isometry3d> poses(double seconds) const = 0;
};

// An articulated person, built of smooth primitives.
//
// Ellipsoids (pelvis, belly, chest, head, calves, hands, balls of the feet) and tapered capsules
// (neck, shoulders, upper and lower arms, upper and lower legs, feet), each a rigid part that hangs
// at its joint. Parts overlap at the joints, so that no pose opens a gap. Proportions follow the
// height (skeleton.h); tessellated to within 1 mm of the smooth surface at a height of 1.75 m,
// otherwise in proportion. Standing, the soles are at z = 0 and the top of the head at the height.
//
// Throws std::invalid_argument for a height that is not positive.
std::unique_ptr<Subject> make_person(const scenarios::StudioSubject& subject, double speed_factor);

// One rigid mesh, such as a scan, that follows the script as a whole: limbs have no effect. `mesh`
// already stands on the floor at the centre.
std::unique_ptr<Subject> make_rigid_subject(TriangleMesh mesh,
                                            const scenarios::StudioSubject& subject,
                                            double speed_factor);

}  // namespace simbench::reconstruction
