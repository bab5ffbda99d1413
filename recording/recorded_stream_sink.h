// The frames of a capture as streams of stamps, as the files of cameras have them
// (recording/rs_csv.h): for what works on stamps alone, such as the diagnosis of a rig.
//
// A camera's stamp is that of its sensor, in steps of a microsecond, with its register's wraps;
// arrivals are on the host's steady clock, which no step of a system clock disturbs. Streams are in
// the order of their first frames; those of one camera are "depth" and "colour".
//
//   RecordedStreamSink sink(folder.description());
//   folder.play(capture, sink);
//   const evaluation::Diagnosis diagnosis = evaluation::diagnose(sink.take(), {});
//
// Memory: 40 bytes a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "recording/recording.h"
#include "recording/recording_folder.h"
#include "recording/rs_csv.h"

namespace simbench {

class RecordedStreamSink final : public RecordingSink {
 public:
  // The names of hosts and cameras; missing ones are "host0", "camera0", ...
  explicit RecordedStreamSink(RecordingDescription description)
      : description_(std::move(description)) {}

  void on_start(const RigLayout& layout) override { layout_ = layout; }
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent&) override {}

  std::vector<RecordedStream> take() { return std::move(streams_); }

 private:
  RecordedStream& stream_of(const FrameRecord& frame);

  RecordingDescription description_;
  RigLayout layout_;
  std::map<std::pair<std::uint32_t, StreamKind>, std::size_t> places_;
  std::vector<RecordedStream> streams_;
};

}  // namespace simbench
