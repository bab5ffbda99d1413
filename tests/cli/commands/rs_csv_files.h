// Recordings in the CSV layout of librealsense's rs-data-collect, for the commands that read it.
#ifndef SIMBENCH_TESTS_CLI_COMMANDS_RS_CSV_FILES_H_
#define SIMBENCH_TESTS_CLI_COMMANDS_RS_CSV_FILES_H_

#include <string>

#include "tests/data/test_data.h"

namespace simbench {

inline const std::string kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
// A real camera's stamps, which convert-ibl makes such a file from.
inline const std::string kBody = test_data_path("ibl/_iblrig_bodyCamera.timestamps.ssv");

}  // namespace simbench

#endif  // SIMBENCH_TESTS_CLI_COMMANDS_RS_CSV_FILES_H_
