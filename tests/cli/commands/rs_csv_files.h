// Recordings in the CSV layout of librealsense's rs-data-collect, for the commands that read it.
#pragma once

#include <string>

namespace simbench {

inline const std::string kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";

}  // namespace simbench
