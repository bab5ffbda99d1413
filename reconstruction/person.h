// An articulated person, built of smooth primitives.
//
// Ellipsoids (pelvis, belly, chest, head, calves, hands, balls of the feet) and tapered capsules
// (neck, shoulders, upper and lower arms, upper and lower legs, feet), each a rigid part that hangs
// at its joint. Parts overlap at the joints, so that no pose opens a gap. Proportions follow the
// height (skeleton.h); tessellated to within 1 mm of the smooth surface at a height of 1.75 m,
// otherwise in proportion. Standing, the soles are at z = 0 and the top of the head at the height.
//
//   const auto person = make_person(studio.subject, /*speed_factor=*/1.0);
#ifndef SIMBENCH_RECONSTRUCTION_PERSON_H_
#define SIMBENCH_RECONSTRUCTION_PERSON_H_

#include <memory>

#include "reconstruction/subject.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

// Throws std::invalid_argument for a height that is not positive or a script that there is not.
std::unique_ptr<Subject> make_person(const scenarios::StudioSubject& subject, double speed_factor);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_PERSON_H_
