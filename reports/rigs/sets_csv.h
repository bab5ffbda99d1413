// The sets of a gatherer as CSV, a line a frame, for who wants to take the frames out of their
// files:
//
//   set,complete,camera,stream,file,topic,message,counter,sensor_ns,arrival_ns,stamp_ns
//
// `message` counts the topic's messages from 0 in the order of the file (empty where a stream's
// metadata names no image, and for files that have no messages); the stamp is the device_time's, on
// the host's clock.
#ifndef SIMBENCH_REPORTS_RIGS_SETS_CSV_H_
#define SIMBENCH_REPORTS_RIGS_SETS_CSV_H_

#include <ostream>
#include <vector>

#include "evaluation/replay/gathered_sets.h"
#include "recording/recorded_streams.h"

namespace simbench::reports {

void write_sets_csv(const std::vector<evaluation::GatheredSet>& sets,
                    const std::vector<CameraStream>& streams, std::ostream& out);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RIGS_SETS_CSV_H_
