#include "hardware/camera/recorded_player.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

namespace simbench::hardware {
namespace {

constexpr Nanoseconds kBeforeZero = std::chrono::milliseconds(20);
constexpr Nanoseconds kLookWaiting = std::chrono::milliseconds(4);
constexpr Nanoseconds kLookPlaying = std::chrono::milliseconds(10);
constexpr Nanoseconds kLongestSleep = std::chrono::milliseconds(250);
constexpr Nanoseconds kOldTrigger = std::chrono::seconds(1);
constexpr Nanoseconds kFarTrigger = std::chrono::hours(1);
constexpr int kUnreadableTold = 50;

struct TriggerFile {
  bool exists = false;
  std::string content;
  std::optional<MonotonicTime> zero;
};

TriggerFile read_trigger(const std::string& path) {
  TriggerFile result;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return result;
  result.exists = true;
  char buffer[40];
  const ssize_t size = ::read(file, buffer, sizeof(buffer));
  ::close(file);
  std::string_view text(buffer, size > 0 ? static_cast<std::size_t>(size) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) {
    text.remove_suffix(1);
  }
  std::int64_t ns = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), ns);
  if (error == std::errc() && stop == text.data() + text.size() && ns >= 0) {
    result.zero = MonotonicTime(Nanoseconds(ns));
  } else {
    for (const char c : text) result.content += c >= 0x20 && c < 0x7f ? c : '?';
  }
  return result;
}

void begin(RecordedPlay& play, MonotonicTime zero) {
  play.state = RecordedPlay::State::kPlaying;
  play.zero = zero;
  play.next = 0;
  play.watch.start(zero);
}

void tell_unreadable(RecordedPlay& play, const TriggerFile& file, MonotonicTime now) {
  if (++play.unreadable != kUnreadableTold) return;
  const std::string found =
      file.zero ? fmt::format("an instant {:.0f} s ahead", to_seconds(*file.zero - now))
                : fmt::format("'{}'", file.content);
  play.on_event({CameraEvent::Kind::kNote,
                 fmt::format("trigger file {}: found {}, allowed: nanoseconds of CLOCK_MONOTONIC, "
                             "at most an hour ahead",
                             play.trigger_file, found)});
}

void apply(RecordedPlay& play, const TriggerFile& file, MonotonicTime now) {
  if (!file.exists) {
    play.state = RecordedPlay::State::kWaiting;
    play.unreadable = 0;
    return;
  }
  if (!file.zero || *file.zero > now + kFarTrigger) return tell_unreadable(play, file, now);
  play.unreadable = 0;
  const bool is_new = play.state == RecordedPlay::State::kWaiting || *file.zero != play.zero;
  if (is_new && *file.zero >= play.started - kOldTrigger) begin(play, *file.zero);
}

CameraFrame frame_at(const PlayedFrame& played, MonotonicTime arrived) {
  CameraFrame frame{.stream = played.stream,
                    .domain = played.domain,
                    .counter = played.counter,
                    .exposure_us = played.exposure_us,
                    .sensor = played.sensor,
                    .frame = played.frame,
                    .backend = std::nullopt,
                    .arrived = arrived};
  if (played.backend_lead_ns != kNoBackend) {
    frame.backend = arrived - Nanoseconds(played.backend_lead_ns);
  }
  return frame;
}

MonotonicTime due(const RecordedPlay& play) {
  return play.zero + Nanoseconds(play.camera->frames[play.next].due_ns);
}

bool is_played(const RecordedPlay& play) {
  const PlayedFrame& frame = play.camera->frames[play.next];
  return play.wanted[static_cast<std::size_t>(frame.stream)] && due(play) >= play.started;
}

// To the next frame that is played, if there is one.
void skip(RecordedPlay& play) {
  const std::size_t frames = play.camera->frames.size();
  while (play.next < frames && !is_played(play)) ++play.next;
  if (play.next < frames) return;
  play.state = RecordedPlay::State::kOver;
  play.on_event({CameraEvent::Kind::kEnded, "the recording is over"});
}

// The earliest frame of all cameras.
RecordedPlay* earliest(const std::vector<RecordedPlay*>& plays) {
  RecordedPlay* first = nullptr;
  for (RecordedPlay* play : plays) {
    if (play->state != RecordedPlay::State::kPlaying) continue;
    skip(*play);
    if (play->state != RecordedPlay::State::kPlaying) continue;
    if (first == nullptr || due(*play) < due(*first)) first = play;
  }
  return first;
}

}  // namespace

RecordedPlayer::~RecordedPlayer() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void RecordedPlayer::add(RecordedPlay& play) {
  {
    const std::lock_guard lock(mutex_);
    play.started = monotonic_now();
    play.state = RecordedPlay::State::kWaiting;
    play.unreadable = 0;
    if (play.trigger_file.empty()) begin(play, play.started + kBeforeZero);
    plays_.push_back(&play);
    next_look_ = {};
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  changed_.notify_one();
}

void RecordedPlayer::remove(RecordedPlay& play) {
  const std::lock_guard lock(mutex_);
  std::erase(plays_, &play);
}

void RecordedPlayer::look_at_triggers(MonotonicTime now) {
  waiting_ = false;
  const std::string* path = nullptr;
  TriggerFile file;
  for (RecordedPlay* play : plays_) {
    if (play->trigger_file.empty()) continue;
    // Cameras of a rig share their trigger, as a rule: one look for all in a row that do.
    if (path == nullptr || *path != play->trigger_file) file = read_trigger(play->trigger_file);
    path = &play->trigger_file;
    apply(*play, file, now);
    waiting_ = waiting_ || play->state == RecordedPlay::State::kWaiting;
  }
  next_look_ = now + (waiting_ ? kLookWaiting : kLookPlaying);
}

MonotonicTime RecordedPlayer::turn(MonotonicTime now) {
  if (now >= next_look_) look_at_triggers(now);
  RecordedPlay* play = earliest(plays_);
  if (play != nullptr && due(*play) <= now) {
    const MonotonicTime arrived = due(*play);
    const CameraFrame frame = frame_at(play->camera->frames[play->next++], arrived);
    play->on_frame(frame);
    play->watch.on_frame(frame, play->on_event);
    return now;
  }
  for (RecordedPlay* each : plays_) {
    if (each->state == RecordedPlay::State::kPlaying) each->watch.check(now, each->on_event);
  }
  // Between frames nobody need know that the trigger is off.
  const MonotonicTime wake_up =
      waiting_ ? std::min(next_look_, now + kLongestSleep) : now + kLongestSleep;
  return play == nullptr ? wake_up : std::min(wake_up, due(*play));
}

void RecordedPlayer::run() {
  prctl(PR_SET_TIMERSLACK, 1UL);
  std::unique_lock lock(mutex_);
  while (!ending_) {
    if (plays_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const MonotonicTime now = monotonic_now();
    const MonotonicTime wake_up = turn(now);
    if (wake_up > now) changed_.wait_until(lock, for_timer(wake_up));
  }
}

}  // namespace simbench::hardware
