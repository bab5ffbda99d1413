// What stands in the studio: rigid parts, and where each of them is at any instant.
//
// A part's mesh is in the part's own frame; its pose takes it to the world's: metres, z up, the
// floor at z = 0, the studio's centre at the origin. Time is in seconds since the first evaluated
// trigger pulse; negative times are fine. Poses are a pure function of time.
//
//   const std::unique_ptr<Subject> person = make_person(studio.subject, 1.0);   // person.h
//   const std::vector<Eigen::Isometry3d> poses = person->poses(/*seconds=*/0.25);
#ifndef SIMBENCH_RECONSTRUCTION_SUBJECT_H_
#define SIMBENCH_RECONSTRUCTION_SUBJECT_H_

#include <Eigen/Geometry>
#include <vector>

#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

class Subject {
 public:
  virtual ~Subject() = default;
  virtual const std::vector<TriangleMesh>& parts() const = 0;
  // One for each part.
  virtual std::vector<Eigen::Isometry3d> poses(double seconds) const = 0;
};

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_SUBJECT_H_
