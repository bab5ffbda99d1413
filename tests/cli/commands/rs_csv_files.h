// Recordings in the CSV layout of librealsense's rs-data-collect, for the commands that read it.
#ifndef SIMBENCH_TESTS_CLI_COMMANDS_RS_CSV_FILES_H_
#define SIMBENCH_TESTS_CLI_COMMANDS_RS_CSV_FILES_H_

#include <string>

namespace simbench {

inline const std::string kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";

}  // namespace simbench

#endif  // SIMBENCH_TESTS_CLI_COMMANDS_RS_CSV_FILES_H_
