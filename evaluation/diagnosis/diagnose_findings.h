// A diagnosis in words: one line per thing that someone should know about a camera.
#ifndef SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_FINDINGS_H_
#define SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_FINDINGS_H_

#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"

namespace simbench::evaluation {

// In order of the cameras; faults of a rig first, then what is worth knowing.
std::vector<Finding> findings_of(const Diagnosis& diagnosis);

// What no stamp can tell about this rig.
std::vector<std::string> cannot_know(const Diagnosis& diagnosis);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_FINDINGS_H_
