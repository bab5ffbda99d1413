#include "reconstruction/rigid_subject.h"

#include <memory>
#include <utility>
#include <vector>

#include "reconstruction/motion.h"

namespace simbench::reconstruction {
namespace {

class RigidSubject final : public Subject {
 public:
  RigidSubject(TriangleMesh mesh, const scenarios::StudioSubject& subject, double speed_factor)
      : motion_(subject, speed_factor) {
    parts_.push_back(std::move(mesh));
  }

  const std::vector<TriangleMesh>& parts() const override { return parts_; }
  std::vector<Eigen::Isometry3d> poses(double seconds) const override {
    return {motion_.at(seconds).root};
  }

 private:
  Motion motion_;
  std::vector<TriangleMesh> parts_;
};

}  // namespace

std::unique_ptr<Subject> make_rigid_subject(TriangleMesh mesh,
                                            const scenarios::StudioSubject& subject,
                                            double speed_factor) {
  return std::make_unique<RigidSubject>(std::move(mesh), subject, speed_factor);
}

}  // namespace simbench::reconstruction
