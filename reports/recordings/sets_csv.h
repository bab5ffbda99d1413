// The sets of a gatherer as CSV, a line a frame, for who wants to take the frames out of their
// files:
//
//   set,complete,camera,stream,file,topic,message,counter,sensor_ns,arrival_ns,stamp_ns
//
// `message` counts the topic's messages from 0 in the order of the file (empty where a stream's
// metadata names no image, and for files that have no messages); the stamp is the device_time's, on
// the host's clock.
#pragma once

#include <ostream>
#include <vector>

#include "evaluation/frames/gathered_sets.h"
#include "recording/recorded_streams.h"

namespace simbench::reports {

// `streams`: by camera.
void write_sets_csv(const std::vector<evaluation::GatheredSet>& sets,
                    const std::vector<const RecordedStream*>& streams, std::ostream& out);

// Every frame with its stamps by each device_time, milliseconds with six decimals, empty where it
// has none:
//
//   camera,stream,frame,sensor_ms,arrival_ms,global_ms_NAME,...
//
// `stamped`: by stream, each with the same device_times.
void write_stamps_csv(const std::vector<evaluation::StampedStream>& stamped, std::ostream& out);

}  // namespace simbench::reports
