// A subject of one rigid mesh, such as a scan, that follows a script as a whole.
#ifndef SIMBENCH_RECONSTRUCTION_RIGID_SUBJECT_H_
#define SIMBENCH_RECONSTRUCTION_RIGID_SUBJECT_H_

#include <memory>

#include "reconstruction/subject.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

// `mesh` stands on the floor at the centre already. Limbs of the script have no effect.
std::unique_ptr<Subject> make_rigid_subject(TriangleMesh mesh,
                                            const scenarios::StudioSubject& subject,
                                            double speed_factor);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_RIGID_SUBJECT_H_
