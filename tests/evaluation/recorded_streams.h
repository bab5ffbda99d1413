// A capture as the streams that a recording file would hold.
#pragma once

#include <string>
#include <vector>

#include "recording/rs_csv.h"
#include "tests/recording/test_sink.h"

namespace simbench::evaluation {

class RecordedStreams final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override { layout_ = layout; }

  std::vector<RecordedStream> streams;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* /*truth*/) override {
    const std::string kind = frame.stream == StreamKind::kDepth ? "Depth 0" : "Color 0";
    stream_of(frame.camera, kind)
        .frames.push_back({.counter = frame.counter,
                           .sensor = Microseconds(frame.frame.us),
                           .arrival = frame.arrival.time_since_epoch()});
  }
  RecordedStream& stream_of(std::uint32_t camera, const std::string& kind) {
    const std::string name = std::to_string(camera);
    for (RecordedStream& stream : streams) {
      if (stream.camera == name && stream.stream == kind) return stream;
    }
    streams.push_back({name, "host" + std::to_string(layout_.cameras[camera].host), kind, {}});
    return streams.back();
  }

  RigLayout layout_;
};

}  // namespace simbench::evaluation
