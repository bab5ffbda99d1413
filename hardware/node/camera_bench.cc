#include "hardware/node/camera_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <mutex>
#include <utility>
#include <variant>

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;

struct Fed {
  std::uint32_t camera = 0;
  std::variant<CameraFrame, CameraEvent> what;
};

template <class Result>
Task<Result> call(std::function<Result()> work) {
  co_return work();
}

template <class Result>
Task<Result> call_in(asio::thread_pool& thread, std::function<Result()> work) {
  co_return co_await asio::co_spawn(thread, call(std::move(work)), asio::use_awaitable);
}

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

// The work of the thread, which alone uses it after the constructor.
class CameraBench::Worker {
 public:
  Worker(CameraDriver& driver, std::vector<CameraPlace> places)
      : driver_(driver), places_(std::move(places)) {}

  std::vector<CameraState> look() {
    const std::vector<CameraInfo> found = driver_.list();
    std::vector<CameraState> states;
    for (const CameraPlace& place : places_) {
      const auto here = std::find_if(found.begin(), found.end(), [&](const CameraInfo& info) {
        return info.serial == place.serial;
      });
      if (here != found.end()) {
        states.push_back({*here, ""});
      } else {
        states.push_back({{.serial = place.serial, .model = "", .firmware = "", .connection = ""},
                          missing(found)});
      }
    }
    return states;
  }

  CameraProblems prepare(const CameraSettings& settings) {
    CameraProblems problems = close();
    for (const CameraPlace& place : places_) {
      attempt(problems, place.serial, [&] {
        std::unique_ptr<Camera> camera = driver_.open(place.serial);
        camera->configure(settings);
        if (settings.steering && !camera->steering()) {
          throw CameraError(
              "its frames cannot be steered, as the pipeline's capture_alignment "
              "needs: of real cameras none can, RealSense's SDK has no control of a "
              "frame's length; allowed: cameras that play a recording");
        }
        open_.push_back({place, std::move(camera)});
      });
    }
    return problems;
  }

  CameraSteerings steerings() {
    CameraSteerings steerings;
    for (const Open& open : open_) {
      auto steering = open.camera->steering();
      if (steering) steerings[open.place.number] = std::move(steering);
    }
    return steerings;
  }

  CameraProblems start(const std::shared_ptr<CameraFeed>& feed) {
    CameraProblems problems;
    for (const Open& open : open_) {
      attempt(problems, open.place.serial, [&] {
        open.camera->start(feed->frame_handler(open.place.number),
                           feed->event_handler(open.place.number));
      });
    }
    return problems;
  }

  CameraProblems stop() {
    CameraProblems problems;
    for (const Open& open : open_) {
      attempt(problems, open.place.serial, [&] { open.camera->stop(); });
    }
    return problems;
  }

  CameraProblems close() {
    CameraProblems problems = stop();
    open_.clear();
    return problems;
  }

 private:
  struct Open {
    CameraPlace place;
    std::unique_ptr<Camera> camera;
  };

  static std::string missing(const std::vector<CameraInfo>& found) {
    std::string names;
    for (const CameraInfo& info : found) {
      names += (names.empty() ? "" : ", ") + info.serial;
    }
    return fmt::format("not found; connected to this host: {}; check its cable and its serial",
                       names.empty() ? "none" : names);
  }

  static void attempt(CameraProblems& problems, const std::string& serial,
                      const std::function<void()>& work) {
    try {
      work();
    } catch (const std::exception& error) {
      problems.push_back({serial, error.what()});
    }
  }

  CameraDriver& driver_;
  std::vector<CameraPlace> places_;
  std::vector<Open> open_;
};

CameraBench::CameraBench(CameraDriver& driver, std::vector<CameraPlace> places)
    : places_(std::move(places)), worker_(std::make_shared<Worker>(driver, places_)) {}

CameraBench::~CameraBench() { join(); }

void CameraBench::join() {
  thread_.join();
  worker_->close();
}

std::string CameraBench::serial_of(std::uint32_t number) const {
  for (const CameraPlace& place : places_) {
    if (place.number == number) return place.serial;
  }
  return fmt::format("number {}", number);
}

std::vector<CameraState> CameraBench::look() { return worker_->look(); }

Task<std::vector<CameraState>> CameraBench::look_again() {
  return call_in<std::vector<CameraState>>(thread_, [worker = worker_] { return worker->look(); });
}

Task<CameraProblems> CameraBench::prepare(CameraSettings settings) {
  return call_in<CameraProblems>(thread_, [worker = worker_, settings = std::move(settings)] {
    return worker->prepare(settings);
  });
}

Task<CameraSteerings> CameraBench::steerings() {
  return call_in<CameraSteerings>(thread_, [worker = worker_] { return worker->steerings(); });
}

Task<CameraProblems> CameraBench::start(std::shared_ptr<CameraFeed> feed) {
  return call_in<CameraProblems>(
      thread_, [worker = worker_, feed = std::move(feed)] { return worker->start(feed); });
}

Task<CameraProblems> CameraBench::stop() {
  return call_in<CameraProblems>(thread_, [worker = worker_] { return worker->stop(); });
}

Task<CameraProblems> CameraBench::close() {
  return call_in<CameraProblems>(thread_, [worker = worker_] { return worker->close(); });
}

}  // namespace simbench::hardware
