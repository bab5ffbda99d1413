// Tables of recorded streams: the account of their frames, the clocks of their cameras, and the
// stamps of device_time algorithms.
//
//   document.blocks.push_back(frames_block(recorded.streams));
#pragma once

#include <vector>

#include "evaluation/frames/gathered_sets.h"
#include "recording/recorded_streams.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

// evaluation/frames/frame_account.h
Block frames_block(const std::vector<RecordedStream>& streams);

// evaluation/frames/camera_statistics.h
Block clocks_block(const std::vector<RecordedStream>& streams);
Json clocks_json(const RecordedStream& stream);

// evaluation/frames/gathered_sets.h
Block stamps_block(const std::vector<evaluation::StampedStream>& stamps);
Json stamps_json(const evaluation::StampedStream& stamped);

}  // namespace simbench::reports
