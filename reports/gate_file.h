// A single file that appears whole or not at all: baselines, JUnit reports.
#ifndef SIMBENCH_REPORTS_GATE_FILE_H_
#define SIMBENCH_REPORTS_GATE_FILE_H_

#include <string>

namespace simbench::reports {

// Writes beside `path` and renames; what was there stays until then. `option` is what the user
// named the file with. Throws OutputError; then nothing is left of the new file.
void write_whole_file(const std::string& option, const std::string& path, const std::string& text);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_GATE_FILE_H_
