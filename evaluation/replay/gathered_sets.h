// The sets of frames that a gatherer finds in a recording, for who wants to take them out of it.
//
//   const GatheredSets found = gathered_sets(reader.take(), "depth",
//                                            *find_algorithm<DeviceTimeEntry>("hull_offline"),
//                                            *find_algorithm<GatheringEntry>("yoon2021"));
//   for (const GatheredFrame& frame : found.sets[0].frames) use(frame.stream, frame.frame);
//
// Errors: std::invalid_argument for an algorithm that needs polls or the truth. Complexity: that of
// the two algorithms, and O(n log n) in the frames.
#ifndef SIMBENCH_EVALUATION_REPLAY_GATHERED_SETS_H_
#define SIMBENCH_EVALUATION_REPLAY_GATHERED_SETS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
#include "algorithms/registry.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

struct GatheredFrame {
  std::size_t stream = 0;  // of the recording's streams
  std::size_t frame = 0;   // of the stream's frames
  GlobalTime stamp{};      // by the device_time
};

struct GatheredSet {
  std::vector<GatheredFrame> frames;  // in order of the streams
  bool complete = true;               // no camera is missing
};

struct GatheredSets {
  std::vector<GatheredSet> sets;  // in order of emission
  std::uint64_t discarded = 0;    // frames in no set
};

// Over the streams of this kind (CameraStream::stream), whose frames are in no set if fewer than
// two have one.
GatheredSets gathered_sets(const std::vector<CameraStream>& streams, const std::string& kind,
                           const DeviceTimeEntry& device_time, const GatheringEntry& gathering);

// Whether it runs on a recording: it needs neither polls nor the truth.
bool runs_on_recordings(const AlgorithmInfo& info);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_REPLAY_GATHERED_SETS_H_
