// What a camera's handlers received, for a test that waits for some of it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

// Handlers share what they write to, so a test may end while its camera plays.
class SeenFrames {
 public:
  FrameHandler on_frame() {
    return [state = state_](const CameraFrame& frame) {
      const std::lock_guard lock(state->mutex);
      state->frames.push_back(frame);
      state->changed.notify_all();
    };
  }
  CameraEventHandler on_event() {
    return [state = state_](const CameraEvent& event) {
      const std::lock_guard lock(state->mutex);
      state->events.push_back(event);
      state->changed.notify_all();
    };
  }

  // Bounded; false if it took more than ten seconds.
  bool wait_for_frames(std::size_t count) {
    std::unique_lock lock(state_->mutex);
    return state_->changed.wait_for(lock, std::chrono::seconds(10),
                                    [&] { return state_->frames.size() >= count; });
  }
  bool wait_for_event(CameraEvent::Kind kind, const std::string& text) {
    std::unique_lock lock(state_->mutex);
    return state_->changed.wait_for(lock, std::chrono::seconds(10), [&] {
      for (const CameraEvent& event : state_->events) {
        if (event.kind == kind && event.text.find(text) != std::string::npos) return true;
      }
      return false;
    });
  }

  std::vector<CameraFrame> frames() const {
    const std::lock_guard lock(state_->mutex);
    return state_->frames;
  }
  std::vector<CameraEvent> events() const {
    const std::lock_guard lock(state_->mutex);
    return state_->events;
  }
  std::size_t events_of(CameraEvent::Kind kind) const {
    std::size_t count = 0;
    for (const CameraEvent& event : events()) count += event.kind == kind ? 1U : 0U;
    return count;
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<CameraFrame> frames;
    std::vector<CameraEvent> events;
  };

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace simbench::hardware
