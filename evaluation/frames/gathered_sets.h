// Where the frames are that a pipeline stamps and gathers, for who wants to take them out of their
// recording.
//
// It scores the pipeline on the recording (pipeline_scorer.h) and keeps what the scorer tells its
// observer: the stamp of each frame, and the sets.
//
//   StreamSource source(recorded.streams, "Depth 0", /*genlock=*/false);
//   const GatheredSets found = gathered_sets(scenario, choice, source);
//   for (const GatheredFrame& frame : found.sets[0].frames) use(frame.camera, frame.frame);
//
// Errors: RecordingFailed, what the source throws. Complexity: that of the two algorithms. Memory:
// 16 bytes a frame, and those of the sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/stream_source.h"
#include "evaluation/run/pipeline_choice.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct GatheredFrame {
  std::size_t camera = 0;  // its place in StreamSource::streams()
  std::size_t frame = 0;   // of the stream's frames
  GlobalTime stamp{};      // by the device_time
};

struct GatheredSet {
  std::vector<GatheredFrame> frames;  // in order of the cameras
  bool complete = true;               // no camera is missing
};

struct GatheredSets {
  std::vector<std::vector<std::optional<GlobalTime>>> stamps;  // by camera and frame
  std::vector<GatheredSet> sets;                               // in order of emission
  std::int64_t discarded = 0;                                  // frames in no set
};

GatheredSets gathered_sets(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                           StreamSource& source);

// One device_time on one stream.
struct StampedStream {
  const RecordedStream* stream = nullptr;
  std::string device_time;
  bool relative = false;                          // DeviceTimeEstimator::relative()
  std::vector<std::optional<GlobalTime>> stamps;  // by frame
};

// Takes the frames that have a stamp.
StampStatistics stamp_statistics(const StampedStream& stamped);

}  // namespace simbench::evaluation
