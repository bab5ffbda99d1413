// Reads what reports/archive/archive.h and `simbench run --format json` write, for all that works
// with finished results: compare, gate, report, figure.
//
// Nothing is trusted: a file that is cut short, edited by hand or of a newer schema is refused with
// its file, line and JSON pointer, what was found and what is allowed. Medians and bands are
// computed again from the values, never read, so that an archive cannot contradict itself.
//
// Errors: scenarios::InputError.
//
//   const Archive monday = read_archive("results/monday");
//   for (const evaluation::Row& row : monday.results.rows) use(row.amd_ms.values);
#ifndef SIMBENCH_REPORTS_ARCHIVE_ARCHIVE_READER_H_
#define SIMBENCH_REPORTS_ARCHIVE_ARCHIVE_READER_H_

#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

// The schema of manifest.json and results.json that this program writes, and the newest it reads.
inline constexpr int kArchiveSchemaVersion = 1;

struct Archive {
  std::string path;  // as the user named it
  std::string version;
  std::string commit;
  std::vector<std::string> command{};  // this and what follows are in a manifest only
  std::string started{};
  std::string finished{};
  std::string scenario_json{};  // resolved; load it with scenarios::load_scenario_text
  // As evaluate() returned them, without the scores of single seeds (Row::seeds): what a seed
  // scored stands in the values of the row's series, in seed order.
  evaluation::Results results;
};

// `path`: an archive's folder, or a results.json alone, which has no manifest.
Archive read_archive(const std::string& path);

// Fills Row::seeds from frames.csv and hosts.csv: seed, pulses, host_errors_ms and nothing else.
// The archive must be a folder.
void read_seed_details(Archive& archive);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_ARCHIVE_ARCHIVE_READER_H_
