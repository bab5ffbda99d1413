// From the cameras' threads to the node's own: frames and events through a bounded queue.
//
// Cameras call the handlers from threads of theirs; what they say waits in the queue and is handed
// over on the thread that runs `context`, in the order in which it came. A camera is never held up:
// when the queue is full (kFeedQueue, many seconds of a busy host) frames are dropped and counted.
//
// The handlers are of any thread and may outlive the feed; after close() they do nothing. All else
// is of the context's thread.
//
//   CameraFeed feed(context, feed_sink);
//   camera.start(feed.frame_handler(11), feed.event_handler(11));
//   camera.stop();
//   feed.drain();   // now everything that the camera said has been handed over
#ifndef SIMBENCH_HARDWARE_NODE_CAMERA_FEED_H_
#define SIMBENCH_HARDWARE_NODE_CAMERA_FEED_H_

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>

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

  // `camera` is handed on: the camera's number in the whole rig.
  FrameHandler frame_handler(std::uint32_t camera);
  CameraEventHandler event_handler(std::uint32_t camera);

  // Hands over what waits, now.
  void drain();
  void close();
  // Frames that the queue had no room for.
  std::uint64_t dropped() const;

 private:
  class Queue;
  std::shared_ptr<Queue> queue_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_CAMERA_FEED_H_
