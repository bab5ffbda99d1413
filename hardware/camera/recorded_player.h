// The thread that plays the recorded cameras of a driver; see recorded_camera.h for what it does.
//
// One lock guards everything; it is held while a handler runs, so that none runs after remove().
//
//   RecordedPlayer player;
//   player.add(play);      // plays it from now on
//   player.remove(play);
#ifndef SIMBENCH_HARDWARE_CAMERA_RECORDED_PLAYER_H_
#define SIMBENCH_HARDWARE_CAMERA_RECORDED_PLAYER_H_

#include <array>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hardware/camera/camera.h"
#include "hardware/camera/recorded_frames.h"
#include "hardware/camera/stream_watch.h"

namespace simbench::hardware {

// One camera while it is started.
struct RecordedPlay {
  enum class State { kWaiting, kPlaying, kOver };

  std::shared_ptr<const PlayedCamera> camera;
  std::string trigger_file;         // empty: none
  std::array<bool, 2> wanted = {};  // by StreamKind
  FrameHandler on_frame;
  CameraEventHandler on_event;
  StreamWatch watch{CameraSettings{}, true};

  State state = State::kWaiting;
  MonotonicTime started{};
  MonotonicTime zero{};  // T0, while playing
  std::size_t next = 0;  // frame
  int unreadable = 0;    // times in a row that the trigger file held no instant
};

class RecordedPlayer {
 public:
  RecordedPlayer() = default;
  ~RecordedPlayer();
  RecordedPlayer(const RecordedPlayer&) = delete;
  RecordedPlayer& operator=(const RecordedPlayer&) = delete;

  // `play` stays where it is until remove().
  void add(RecordedPlay& play);
  // Does nothing if it is not there.
  void remove(RecordedPlay& play);

 private:
  void run();
  // Plays what is due, and says when to wake up.
  MonotonicTime turn(MonotonicTime now);
  void look_at_triggers(MonotonicTime now);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<RecordedPlay*> plays_;
  MonotonicTime next_look_{};  // at trigger files
  bool waiting_ = false;       // a camera, for its trigger
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CAMERA_RECORDED_PLAYER_H_
