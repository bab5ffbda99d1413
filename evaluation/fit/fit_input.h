// The input of a fit: stamp pairs of cameras on hosts, and the exchanges between hosts.
//
// Arrivals are on the hosts' steady clocks where the recording has them, so that no setting of a
// system clock is taken for delay. Device stamps are those of the start of transmission where the
// camera has them (the delay from there to the arrival does not depend on the exposure), else the
// camera's only stamp. Both in nanoseconds, device stamps with their register unwrapped. Streams
// have the frames that a fit uses (fit_frames.h), in order of their device stamps.
//
//   FitInputSink sink({.warm_up_ms = 5000});
//   folder.play(capture, sink);
//   const FitInput input = sink.take();
//
// Errors: FitError, one line that names the camera: stamps that are not of the camera's clock.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/frames/frame_account.h"
#include "recording/event.h"
#include "recording/recorded_streams.h"
#include "recording/recording.h"

namespace simbench::evaluation {

// A recording that no fit is possible to; what() is for the user.
class FitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct FitCamera {
  std::string name;
  std::uint32_t host = 0;
};

// One stream of one camera.
struct FitStream {
  std::size_t camera = 0;
  std::string kind;
  std::vector<StampedFrame> frames;  // device stamps ascend; arrivals may go back
  FrameAccount account{};            // of the whole recording, also of what is left out
  bool counted = true;               // by the camera: the account knows lost frames
  double lost_together = 1;          // likewise of the whole recording (fit_frames.h)
};

struct FitInput {
  std::vector<std::string> hosts;
  std::vector<FitCamera> cameras;
  std::vector<FitStream> streams;
  // Exchanges and clock adjustments, in order; other kinds do not occur.
  std::vector<RecordingEvent> clock_events;
  std::vector<std::string> left_out;  // a line each that names the stream: what, and where
};

struct FitInputOptions {
  std::vector<std::string> hosts = {};    // names; missing ones are "host0", ...
  std::vector<std::string> cameras = {};  // likewise "camera0", ...
  double warm_up_ms = 0;                  // discarded, of each stream from its first frame
  // For a simulated recording: arrivals in true time instead of the host's steady time.
  bool true_time = false;
};

class FitInputSink final : public RecordingSink {
 public:
  explicit FitInputSink(FitInputOptions options) : options_(std::move(options)) {}
  void on_start(const RigLayout& layout) override;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  FitInput take();

 private:
  void add(const FrameRecord& frame, const FrameTruth* truth);

  struct Stamps {
    std::uint32_t counter;
    std::uint32_t sensor_us;
    std::uint32_t frame_us;
    std::int64_t arrival_ns;
  };

  FitInputOptions options_;
  FitInput input_;
  std::map<std::pair<std::uint32_t, StreamKind>, std::vector<Stamps>> stamps_;
};

// Returns the input from files of real cameras. `one_host`: one computer stamped all arrivals,
// whatever the files state.
FitInput fit_input(const std::vector<RecordedStream>& streams, bool one_host);

// Returns the halves of every stream, for a fit to one and a test on the other. Nothing is said to
// be left out of them.
std::pair<FitInput, FitInput> halves(const FitInput& input);

}  // namespace simbench::evaluation
