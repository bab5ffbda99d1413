// The subject that a scenario's studio states, following its script at any speed.
//
//   const SubjectMaker subjects(scenario.studio->subject);   // reads a mesh file, once
//   const std::unique_ptr<Subject> twice_as_fast = subjects.make(2.0);
#ifndef SIMBENCH_RECONSTRUCTION_LIBRARIES_SUBJECT_MAKER_H_
#define SIMBENCH_RECONSTRUCTION_LIBRARIES_SUBJECT_MAKER_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reconstruction/libraries/mesh_file.h"
#include "reconstruction/person.h"
#include "reconstruction/rigid_subject.h"
#include "reconstruction/subject.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

class SubjectMaker {
 public:
  // Throws scenarios::InputError for a mesh file that cannot be used.
  explicit SubjectMaker(const scenarios::StudioSubject& subject) : subject_(subject) {
    if (subject.kind == scenarios::SubjectKind::kMesh) {
      loaded_ = load_subject_mesh(subject.mesh_file);
    }
  }
  std::unique_ptr<Subject> make(double speed_factor) const {
    return loaded_ ? make_rigid_subject(loaded_->mesh, subject_, speed_factor)
                   : make_person(subject_, speed_factor);
  }
  // What its user should know of the mesh file.
  std::vector<std::string> notes() const {
    return loaded_ ? loaded_->notes : std::vector<std::string>{};
  }

 private:
  scenarios::StudioSubject subject_;
  std::optional<LoadedMesh> loaded_;
};

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_LIBRARIES_SUBJECT_MAKER_H_
