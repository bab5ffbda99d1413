// Streams as the CSV that librealsense's rs-data-collect writes, which rs_csv.h reads again:
//
//   Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host
//   Depth,0,17,1000.000000,12.345000,front,left
//
// F# is left out where the camera of a stream did not count its frames; `camera` and `host` where
// none of the streams has a name. Exposures, bytes and temperatures follow where a stream has them.
// Stamps have a nanosecond's digits.
//
//   std::ofstream("rig.csv") << rs_csv_text(recorded.streams);
//
// Complexity: linear.
#pragma once

#include <span>
#include <string>

#include "recording/recorded_streams.h"

namespace simbench {

std::string rs_csv_text(std::span<const RecordedStream> streams);

}  // namespace simbench
