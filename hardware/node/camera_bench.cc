#include "hardware/node/camera_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <utility>

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;

template <class Result>
Task<Result> call(std::function<Result()> work) {
  co_return work();
}

}  // namespace

// What the thread does; after the constructor all of it is the thread's.
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
        open_.push_back({place, std::move(camera)});
      });
    }
    return problems;
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
  std::function<std::vector<CameraState>()> work = [worker = worker_] { return worker->look(); };
  co_return co_await asio::co_spawn(thread_, call(std::move(work)), asio::use_awaitable);
}

Task<CameraProblems> CameraBench::prepare(CameraSettings settings) {
  std::function<CameraProblems()> work = [worker = worker_, settings = std::move(settings)] {
    return worker->prepare(settings);
  };
  co_return co_await asio::co_spawn(thread_, call(std::move(work)), asio::use_awaitable);
}

Task<CameraProblems> CameraBench::start(std::shared_ptr<CameraFeed> feed) {
  std::function<CameraProblems()> work = [worker = worker_, feed = std::move(feed)] {
    return worker->start(feed);
  };
  co_return co_await asio::co_spawn(thread_, call(std::move(work)), asio::use_awaitable);
}

Task<CameraProblems> CameraBench::stop() {
  std::function<CameraProblems()> work = [worker = worker_] { return worker->stop(); };
  co_return co_await asio::co_spawn(thread_, call(std::move(work)), asio::use_awaitable);
}

Task<CameraProblems> CameraBench::close() {
  std::function<CameraProblems()> work = [worker = worker_] { return worker->close(); };
  co_return co_await asio::co_spawn(thread_, call(std::move(work)), asio::use_awaitable);
}

}  // namespace simbench::hardware
