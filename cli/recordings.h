// The recordings named on a command line.
#ifndef SIMBENCH_CLI_RECORDINGS_H_
#define SIMBENCH_CLI_RECORDINGS_H_

#include <string>
#include <vector>

#include "recording/rs_csv.h"

namespace simbench::cli {

// The streams of all files, in order. Throws CsvError, also for a file that is given twice.
std::vector<CameraStream> read_recordings(const std::vector<std::string>& files);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_RECORDINGS_H_
