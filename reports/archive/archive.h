// The result archive that --output writes: everything needed to read, check and repeat a run.
//
//   manifest.json   the fully resolved scenario, seeds, version, commit, command, start and end
//   results.json    as reports/results/json.h has it
//   frames.csv      spread and deviation of every evaluated pulse
//   hosts.csv       mean clock error of every host
//
// Only manifest.json (its clock times) and /performance in results.json differ between equal runs.
#ifndef SIMBENCH_REPORTS_ARCHIVE_ARCHIVE_H_
#define SIMBENCH_REPORTS_ARCHIVE_ARCHIVE_H_

#include <chrono>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/text/output_folder.h"
#include "scenarios/scenario.h"

namespace simbench::reports {

// How a result came about, beside what is in it.
struct Provenance {
  std::vector<std::string> command;  // argv
  std::chrono::system_clock::time_point started;
  std::chrono::system_clock::time_point finished;
};

// The members that every manifest has: schema_version, program, version, commit, command, started,
// finished (ISO 8601, UTC), and `more`, the text of a JSON object, merged in.
std::string manifest_json(const Provenance& provenance, const std::string& more);

// Writes and publishes. Throws OutputError; then nothing is left.
void write_archive(OutputFolder& output, const evaluation::Results& results,
                   const scenarios::Scenario& scenario, const Provenance& provenance);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_ARCHIVE_ARCHIVE_H_
