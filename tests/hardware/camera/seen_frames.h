// What a camera's handlers were told, for a test that waits for some of it.
#ifndef SIMBENCH_TESTS_HARDWARE_CAMERA_SEEN_FRAMES_H_
#define SIMBENCH_TESTS_HARDWARE_CAMERA_SEEN_FRAMES_H_

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

class SeenFrames {
 public:
  FrameHandler on_frame() {
    return [this](const CameraFrame& frame) {
      const std::lock_guard lock(mutex_);
      frames_.push_back(frame);
      changed_.notify_all();
    };
  }
  CameraEventHandler on_event() {
    return [this](const CameraEvent& event) {
      const std::lock_guard lock(mutex_);
      events_.push_back(event);
      changed_.notify_all();
    };
  }

  // Bounded; false if it took more than ten seconds.
  bool wait_for_frames(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10),
                             [&] { return frames_.size() >= count; });
  }
  bool wait_for_event(CameraEvent::Kind kind, const std::string& text) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), [&] {
      for (const CameraEvent& event : events_) {
        if (event.kind == kind && event.text.find(text) != std::string::npos) return true;
      }
      return false;
    });
  }

  std::vector<CameraFrame> frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }
  std::vector<CameraEvent> events() const {
    const std::lock_guard lock(mutex_);
    return events_;
  }
  std::size_t events_of(CameraEvent::Kind kind) const {
    std::size_t count = 0;
    for (const CameraEvent& event : events()) count += event.kind == kind ? 1U : 0U;
    return count;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<CameraFrame> frames_;
  std::vector<CameraEvent> events_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_TESTS_HARDWARE_CAMERA_SEEN_FRAMES_H_
