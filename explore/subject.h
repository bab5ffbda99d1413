// What a page is started with: a scenario by name or file, the archive of a run, or a recording,
// which is fitted.
//
//   const FoundSubject found = subject_of({"my_rig.json"}, {}, {});
//
// A file that `simbench fit` wrote names its recording, which is shown beside it where it is still
// there; else a note says that it is not.
//
// Errors: scenarios::InputError, evaluation::FitError, and those of app/recorded_streams.h.
#pragma once

#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "explore/state.h"
#include "scenarios/loader.h"

namespace simbench::explore {

struct SubjectChoice {
  std::vector<scenarios::Override> sets{};
  bags::FileOptions files{};  // how a recording is read
};

struct FoundSubject {
  PageSubject subject;
  std::vector<std::string> notes{};  // for the user
};

FoundSubject subject_of(const std::vector<std::string>& inputs, const SubjectChoice& choice,
                        const ReadProgress& progress);

}  // namespace simbench::explore
