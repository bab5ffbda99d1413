// An articulated person, built of smooth primitives.
//
// Ellipsoids (torso, pelvis, head) and tapered capsules (neck, upper and lower arms, hands, upper
// and lower legs, feet), each a rigid part that hangs at its joint. Parts overlap at the joints, so
// that no pose opens a gap. Proportions follow the height (anthropometric fractions of Drillis and
// Contini 1966, as in Winter's Biomechanics); tessellated to within 1 mm of the smooth surface at
// a height of 1.75 m.
//
//   const auto person = make_person(studio.subject, /*speed_factor=*/1.0);
#ifndef SIMBENCH_RECONSTRUCTION_PERSON_H_
#define SIMBENCH_RECONSTRUCTION_PERSON_H_

#include <memory>

#include "reconstruction/subject.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

std::unique_ptr<Subject> make_person(const scenarios::StudioSubject& subject, double speed_factor);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_PERSON_H_
