// The cameras of one host: a bench that works on them in a thread of their own, and the feed of
// their frames and events to the node's thread.
//
// Opening, setting, starting and stopping a camera may take seconds and block. The node's thread,
// which serves host synchronisation and its conductor meanwhile, waits for none of it. The bench
// carries out calls one after the other, in the order in which they were made. A camera that
// refuses is a problem in the result, and the others go on. Cameras have their numbers in the whole
// rig.
//
// Cameras call the feed's handlers from their own threads. Frames and events wait in a bounded
// queue and are handed over, in order, on the thread that runs `context`. A camera is never held
// up: when the queue is full (kFeedQueue, many seconds of a busy host) frames are dropped and
// counted. The handlers may run in any thread and outlive the feed; after close() they do nothing.
// Everything else belongs to the context's thread.
//
//   CameraBench bench(driver, {{"018322071234", 11}});
//   for (const CameraProblem& problem : co_await bench.prepare(settings)) ...
//   co_await bench.start(feed);
//   co_await bench.stop();
//   feed->drain();   // now all frames and events have been handed over
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/camera/camera.h"

namespace simbench::hardware {

inline constexpr std::size_t kFeedQueue = 16384;

struct CameraFeedSink {
  std::function<void(std::uint32_t camera, const CameraFrame&)> on_frame;
  std::function<void(std::uint32_t camera, const CameraEvent&)> on_event;
};

class CameraFeed {
 public:
  CameraFeed(boost::asio::io_context& context, CameraFeedSink sink);
  ~CameraFeed();
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  // `camera`: the camera's number in the whole rig, which the sink gets.
  FrameHandler frame_handler(std::uint32_t camera);
  CameraEventHandler event_handler(std::uint32_t camera);

  // Hands over all waiting frames and events now.
  void drain();
  void close();
  // Frames dropped because the queue was full.
  std::uint64_t dropped() const;

 private:
  class Queue;
  std::shared_ptr<Queue> queue_;
};

struct CameraPlace {
  std::string serial;
  std::uint32_t number = 0;  // in the rig
};

struct CameraProblem {
  std::string camera;  // its serial
  std::string text;
};
using CameraProblems = std::vector<CameraProblem>;

// A camera of the rig file, and whether it is present.
struct CameraState {
  CameraInfo info;      // the serial only, if it is missing
  std::string problem;  // empty: it is present
};

class CameraBench {
 public:
  // `driver` outlives this.
  CameraBench(CameraDriver& driver, std::vector<CameraPlace> places);
  ~CameraBench();  // joins
  CameraBench(const CameraBench&) = delete;
  CameraBench& operator=(const CameraBench&) = delete;

  // `number`: in the rig.
  std::string serial_of(std::uint32_t number) const;

  // Looks for the cameras at once, in the caller's thread; the first call.
  std::vector<CameraState> look();
  Task<std::vector<CameraState>> look_again();
  // Opens and sets the cameras, after closing those that are open. A camera that should be steered
  // and cannot is a problem.
  Task<CameraProblems> prepare(CameraSettings settings);
  // The steerings of the cameras that are prepared.
  Task<CameraSteerings> steerings();
  // Starts those that are prepared.
  Task<CameraProblems> start(std::shared_ptr<CameraFeed> feed);
  // Idempotent. No handler runs after it.
  Task<CameraProblems> stop();
  // Stops and releases them.
  Task<CameraProblems> close();
  // Waits until all calls are done and closes the cameras; the last call.
  void join();

 private:
  class Worker;

  std::vector<CameraPlace> places_;
  std::shared_ptr<Worker> worker_;
  boost::asio::thread_pool thread_{1};
};

}  // namespace simbench::hardware
