// The streams of other people's files as a backend: bags, CSV and the like, played as a recording.
//
// It plays the streams of one kind (depth, colour ...), a camera each, in order of arrival. A
// camera's own frames stay in their order of delivery, even where the host's clock went back. All
// frames count: there is no warm-up. Files know one clock of a host, so arrivals are on its system
// and its steady clock alike; they hold no truth, no polls and no adjustments.
//
// A frame counter is the recording's, from the file's first on: a gap of it is what the account of
// frames (frame_account.h) has as lost, so that jumps and restarts of the file's are none. Sensor
// stamps are in steps of a microsecond and wrap as the camera's register does.
//
//   StreamSource source(recorded.streams, "Depth 0", /*genlock=*/false);
//   source.record({}, scorer);
//
// Errors: RecordingFailed where no camera has a frame period, by which frames are matched.
// Complexity: O(n log n) in the frames; memory: 12 bytes a frame beside the streams.
// Source: docs/design.md section 2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
#include "recording/recorded_streams.h"
#include "recording/recording.h"

namespace simbench::evaluation {

// The camera's register at a stamp of a file.
DeviceStamp register_of(Nanoseconds sensor);

class StreamSource final : public RecordingSource {
 public:
  // `streams` outlive this. `genlock`: GenLock order tells which pulses are evaluated.
  StreamSource(const std::vector<RecordedStream>& streams, const std::string& kind, bool genlock);

  // The streams of the kind that have frames. A frame's camera is the place of its stream here.
  const std::vector<const RecordedStream*>& streams() const { return streams_; }
  // The names of the hosts, by number.
  const std::vector<std::string>& hosts() const { return hosts_; }
  std::uint32_t host_of(std::size_t camera) const { return host_of_[camera]; }
  // The median over the cameras of each one's median interval; nothing if none is from 1 us to 1 h.
  std::optional<Nanoseconds> period() const { return period_; }
  // From the first of the cameras' first arrivals to the last of them.
  Nanoseconds first_arrival_range() const;

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override;
  bool runs_host_sync() const override { return false; }

 private:
  struct Place {
    std::uint32_t camera;
    std::uint32_t frame;
  };

  std::vector<Place> order_of_arrival() const;
  std::int64_t pulses(RecordingCost& cost) const;

  std::vector<const RecordedStream*> streams_;
  std::vector<std::vector<std::uint32_t>> counters_;  // by camera and frame
  std::vector<std::string> hosts_;
  std::vector<std::uint32_t> host_of_;
  std::optional<Nanoseconds> period_;
  bool genlock_;
};

}  // namespace simbench::evaluation
