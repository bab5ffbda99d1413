#include "hardware/node/camera_feed.h"

#include <boost/asio/post.hpp>
#include <mutex>
#include <utility>
#include <variant>
#include <vector>

namespace simbench::hardware {
namespace {

struct Fed {
  std::uint32_t camera = 0;
  std::variant<CameraFrame, CameraEvent> what;
};

}  // namespace

class CameraFeed::Queue : public std::enable_shared_from_this<CameraFeed::Queue> {
 public:
  Queue(boost::asio::io_context& context, CameraFeedSink sink)
      : context_(context), sink_(std::move(sink)) {}

  // Any thread.
  void push(Fed fed) {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    if (waiting_.size() >= kFeedQueue) {
      if (std::holds_alternative<CameraFrame>(fed.what)) ++dropped_;
      return;
    }
    waiting_.push_back(std::move(fed));
    if (std::exchange(posted_, true)) return;
    boost::asio::post(context_, [queue = weak_from_this()] {
      if (const auto alive = queue.lock()) alive->drain();
    });
  }

  void drain() {
    std::vector<Fed> batch;
    {
      const std::lock_guard lock(mutex_);
      posted_ = false;
      batch.swap(waiting_);
    }
    for (const Fed& fed : batch) {
      if (sink_gone_) return;
      if (const auto* frame = std::get_if<CameraFrame>(&fed.what)) {
        sink_.on_frame(fed.camera, *frame);
      } else {
        sink_.on_event(fed.camera, std::get<CameraEvent>(fed.what));
      }
    }
  }

  void close() {
    sink_gone_ = true;
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
  }

  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  boost::asio::io_context& context_;
  CameraFeedSink sink_;
  bool sink_gone_ = false;  // of the context's thread
  mutable std::mutex mutex_;
  std::vector<Fed> waiting_;
  bool posted_ = false;
  bool closed_ = false;
  std::uint64_t dropped_ = 0;
};

CameraFeed::CameraFeed(boost::asio::io_context& context, CameraFeedSink sink)
    : queue_(std::make_shared<Queue>(context, std::move(sink))) {}
CameraFeed::~CameraFeed() { close(); }

FrameHandler CameraFeed::frame_handler(std::uint32_t camera) {
  return [queue = queue_, camera](const CameraFrame& frame) { queue->push({camera, frame}); };
}
CameraEventHandler CameraFeed::event_handler(std::uint32_t camera) {
  return [queue = queue_, camera](const CameraEvent& event) { queue->push({camera, event}); };
}

void CameraFeed::drain() { queue_->drain(); }
void CameraFeed::close() { queue_->close(); }
std::uint64_t CameraFeed::dropped() const { return queue_->dropped(); }

}  // namespace simbench::hardware
