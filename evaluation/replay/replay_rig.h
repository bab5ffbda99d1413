// The part of a replay that looks at several cameras together; see evaluation/replay/replay.h.
#ifndef SIMBENCH_EVALUATION_REPLAY_REPLAY_RIG_H_
#define SIMBENCH_EVALUATION_REPLAY_REPLAY_RIG_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/replay/replay.h"

namespace simbench::evaluation {

// `members` are the cameras (two or more) that have `stream`; their rows are complete. Nothing if
// no camera has a frame period, of a microsecond at least: there is nothing to match frames by.
std::optional<RigReplay> replay_rig(const std::vector<CameraReplay>& cameras,
                                    const std::string& stream,
                                    const std::vector<std::size_t>& members);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_REPLAY_REPLAY_RIG_H_
