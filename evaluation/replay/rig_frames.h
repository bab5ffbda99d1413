// The frames of the cameras that have one kind of stream, as gatherers and GenLock order get them.
//
//   const Replay all = run_replay(reader.take());
//   const std::optional<RigFrames> rig = rig_of(all.cameras, {0, 1, 2});
//   for (const RigFrame& frame : rig->order) use(frame.source, frame.frame);
//
// Complexity: O(n log n) in the frames.
#ifndef SIMBENCH_EVALUATION_REPLAY_RIG_FRAMES_H_
#define SIMBENCH_EVALUATION_REPLAY_RIG_FRAMES_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "algorithms/ports/time.h"
#include "evaluation/replay/replay.h"

namespace simbench::evaluation {

// The place of its camera in the rig and its place in the camera's recording.
struct RigFrame {
  std::uint32_t source = 0;
  std::uint32_t frame = 0;
};

using RigMembers = std::vector<const CameraReplay*>;

struct RigFrames {
  RigMembers members;
  std::vector<std::size_t> cameras;  // their indices
  Nanoseconds period{};
  std::vector<RigFrame> complete;  // frames of complete pulses, source after source
  std::vector<RigFrame> order;     // of arrival
};

// `cameras`: indices of those (two or more) that have one kind of stream. Returns nothing if none
// has a frame period (of at least a microsecond) to match frames by. `all` outlives it.
std::optional<RigFrames> rig_of(const std::vector<CameraReplay>& all,
                                const std::vector<std::size_t>& cameras);

// What a gatherer is told of the rig.
GatheringSetup gathering_setup(const RigFrames& rig);

DeviceTime device_time_of(const StampedFrame& frame);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_REPLAY_RIG_FRAMES_H_
