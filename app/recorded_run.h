// A recording folder as a run that can be evaluated again: the table that the run of it would
// print.
//
//   const RecordedRun run("monday");
//   const evaluation::Results results = run.evaluate(run.chosen({}), false, progress);
#ifndef SIMBENCH_APP_RECORDED_RUN_H_
#define SIMBENCH_APP_RECORDED_RUN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "recording/recording_folder.h"
#include "scenarios/scenario.h"

namespace simbench::app {

class RecordedRun {
 public:
  // Throws RecordingFolderError or scenarios::InputError where there is nothing to evaluate: no
  // capture, no scenario.
  explicit RecordedRun(const std::string& folder);
  RecordedRun(const RecordedRun&) = delete;
  RecordedRun& operator=(const RecordedRun&) = delete;

  const scenarios::Scenario& scenario() const { return scenario_; }
  // These of the recorded pipelines; all where none is named. Throws scenarios::InputError for one
  // that was not recorded.
  std::vector<std::string> chosen(const std::vector<std::string>& pipelines) const;
  // All seeds that were recorded. What is missing or damaged is noted, and the rest scored. Ends at
  // Ctrl-C (app/interrupt.h).
  evaluation::Results evaluate(const std::vector<std::string>& pipelines, bool keep_pulses,
                               const evaluation::Progress& progress) const;

 private:
  std::string path_;
  RecordingFolder folder_;
  scenarios::Scenario scenario_;
  std::uint64_t first_seed_ = 0;
  std::uint64_t seeds_ = 0;
};

// What went wrong in captures that were scored all the same.
std::vector<std::string> capture_notes(const evaluation::Results& results);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_RECORDED_RUN_H_
