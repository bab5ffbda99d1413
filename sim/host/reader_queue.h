// The frames of one stream on their way into the program that takes them (/hosts/frame_reader).
//
// The program takes a frame as soon as it is there and the last one is done with, which lasts
// frame_ms. Frames that come meanwhile wait, at most queue_frames of them; a further one drops the
// oldest or is dropped itself. The first frame that it takes and then one in passed_every is passed
// on.
//
// Frames arrive in order of time. What becomes of a frame is told as soon as no later arrival can
// change it: read_before(t) tells of all that are taken before t, if nothing arrives before t any
// more. With a period T below frame_ms, T / frame_ms of the frames are taken, and where the newest
// is dropped, each has waited queue_frames * frame_ms less at most T in the long run, since one is
// let in as soon as one comes after another was taken [derived]; the tests are of this.
// Source: librealsense, src/concurrency.h (single_consumer_queue); V4L2, VIDIOC_QBUF; GenTL,
// StreamBufferHandlingMode. Cost: O(1) a frame.
//
//   ReaderQueue queue({.frame_ms = 40, .queue_frames = 4});
//   std::vector<ReaderQueue::Outcome> outcomes;
//   queue.arrive(frame, at, outcomes);
//   queue.read_before(at + from_ms(100), outcomes);
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "recording/true_time.h"
#include "recording/world_observer.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class ReaderQueue {
 public:
  struct Outcome {
    std::uint32_t frame = 0;
    TrueTime at{};  // taken, or dropped
    FrameFate fate{};
  };

  explicit ReaderQueue(const scenarios::FrameReader& reader);

  void arrive(std::uint32_t frame, TrueTime at, std::vector<Outcome>& outcomes);
  void read_before(TrueTime before, std::vector<Outcome>& outcomes);

 private:
  struct Waiting {
    std::uint32_t frame = 0;
    TrueTime since{};
  };

  Nanoseconds busy_;
  std::size_t most_;
  bool drops_oldest_;
  std::int64_t passed_every_;
  std::int64_t taken_ = 0;
  TrueTime free_at_ = TrueTime::min();
  std::deque<Waiting> waiting_;
};

}  // namespace simbench::sim
