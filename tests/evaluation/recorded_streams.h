// A capture as the streams that a recording file would hold.
#ifndef SIMBENCH_TESTS_EVALUATION_RECORDED_STREAMS_H_
#define SIMBENCH_TESTS_EVALUATION_RECORDED_STREAMS_H_

#include <string>
#include <vector>

#include "recording/recording.h"
#include "recording/rs_csv.h"

namespace simbench::evaluation {

class RecordedStreams final : public RecordingSink {
 public:
  void on_start(const RigLayout& layout) override { layout_ = layout; }
  void on_frame(const FrameRecord& frame, const FrameTruth* /*truth*/) override {
    const std::string kind = frame.stream == StreamKind::kDepth ? "Depth 0" : "Color 0";
    stream_of(frame.camera, kind)
        .frames.push_back({.counter = frame.counter,
                           .sensor = Microseconds(frame.frame.us),
                           .arrival = frame.arrival.time_since_epoch()});
  }
  void on_pulse(const PulseTruth& /*truth*/) override {}
  void on_adjustment(const ClockAdjustment& /*adjustment*/) override {}
  void on_poll(const DevicePoll& /*poll*/) override {}
  void on_exchange(std::uint32_t /*host*/, const Exchange& /*exchange*/) override {}
  void on_outcome(const SyncOutcome& /*outcome*/) override {}

  std::vector<CameraStream> streams;

 private:
  CameraStream& stream_of(std::uint32_t camera, const std::string& kind) {
    const std::string name = std::to_string(camera);
    for (CameraStream& stream : streams) {
      if (stream.camera == name && stream.stream == kind) return stream;
    }
    streams.push_back({name, "host" + std::to_string(layout_.cameras[camera].host), kind, {}});
    return streams.back();
  }

  RigLayout layout_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_TESTS_EVALUATION_RECORDED_STREAMS_H_
