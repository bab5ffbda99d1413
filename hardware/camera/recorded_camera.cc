#include "hardware/camera/recorded_camera.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "hardware/camera/played_steering.h"
#include "hardware/camera/stream_watch.h"
#include "hardware/descriptor.h"
#include "recording/number_in.h"

namespace simbench::hardware {
namespace {

constexpr Nanoseconds kBeforeZero = std::chrono::milliseconds(20);
constexpr Nanoseconds kLookWaiting = std::chrono::milliseconds(4);
constexpr Nanoseconds kLookPlaying = std::chrono::milliseconds(10);
constexpr Nanoseconds kLongestSleep = std::chrono::milliseconds(250);
constexpr Nanoseconds kOldTrigger = std::chrono::seconds(1);
constexpr Nanoseconds kFarTrigger = std::chrono::hours(1);
constexpr int kUnreadableReported = 50;
constexpr const char* kNotPlaying = "the camera does not play";

// One camera while it is started.
struct RecordedPlay {
  enum class State { kWaiting, kPlaying, kOver };

  std::shared_ptr<const PlayedCamera> camera;
  std::string trigger_file;         // empty: none
  std::array<bool, 2> wanted = {};  // by StreamKind
  FrameHandler on_frame;
  CameraEventHandler on_event;
  StreamWatch watch{CameraSettings{}, true};
  std::optional<FrameSteering> steered{};  // nothing: its frames stay as they are

  State state = State::kWaiting;
  MonotonicTime started{};
  MonotonicTime zero{};  // T0, while playing
  std::size_t next = 0;  // frame
  std::optional<PlayedSteering> steering;
  int unreadable = 0;  // times in a row that the trigger file held no instant
};

struct TriggerFile {
  bool exists = false;
  std::string content;
  std::optional<MonotonicTime> zero;
};

TriggerFile read_trigger(const std::string& path) {
  TriggerFile result;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.good()) return result;
  result.exists = true;
  char buffer[40];
  const ssize_t size = ::read(file.number(), buffer, sizeof(buffer));
  std::string_view text(buffer, size > 0 ? static_cast<std::size_t>(size) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) {
    text.remove_suffix(1);
  }
  const auto ns = number_in<std::int64_t>(text);
  if (ns && *ns >= 0) {
    result.zero = MonotonicTime(Nanoseconds(*ns));
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
  play.steering.reset();
  if (play.steered) play.steering.emplace(*play.steered);
}

void report_unreadable(RecordedPlay& play, const TriggerFile& file, MonotonicTime now) {
  if (++play.unreadable != kUnreadableReported) return;
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
  if (!file.zero || *file.zero > now + kFarTrigger) return report_unreadable(play, file, now);
  play.unreadable = 0;
  const bool is_new = play.state == RecordedPlay::State::kWaiting || *file.zero != play.zero;
  if (is_new && *file.zero >= play.started - kOldTrigger) begin(play, *file.zero);
}

Nanoseconds shift_of(const RecordedPlay& play) {
  return play.steering ? play.steering->shift(play.camera->frames[play.next].counter)
                       : Nanoseconds(0);
}

MonotonicTime due(const RecordedPlay& play) {
  return play.zero + Nanoseconds(play.camera->frames[play.next].due_ns) + shift_of(play);
}

void steer(CameraFrame& frame, const PlayedSteering& steering) {
  const auto us = std::chrono::round<Microseconds>(steering.shift(frame.counter)).count();
  frame.sensor.us += static_cast<std::uint32_t>(us);
  frame.frame.us += static_cast<std::uint32_t>(us);
  const std::optional<Nanoseconds> exposure = steering.exposure(frame.counter);
  if (!exposure) return;
  frame.exposure_us =
      static_cast<std::uint32_t>(std::chrono::round<Microseconds>(*exposure).count());
}

// The next frame, which is due.
CameraFrame next_frame(RecordedPlay& play) {
  const MonotonicTime arrived = due(play);
  const PlayedFrame& played = play.camera->frames[play.next++];
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
  if (play.steering) {
    steer(frame, *play.steering);
    play.steering->pass(frame.counter);
  }
  return frame;
}

bool is_played(const RecordedPlay& play) {
  const PlayedFrame& frame = play.camera->frames[play.next];
  return play.wanted[static_cast<std::size_t>(frame.stream)] && due(play) >= play.started;
}

// Moves on to the next frame to be played; ends the play if there is none.
void skip(RecordedPlay& play) {
  const std::size_t frames = play.camera->frames.size();
  while (play.next < frames && !is_played(play)) ++play.next;
  if (play.next < frames) return;
  play.state = RecordedPlay::State::kOver;
  play.on_event({CameraEvent::Kind::kEnded, "the recording is over"});
}

// The camera whose next frame is due first; null if none plays.
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

// The thread that plays the recorded cameras of a driver.
//
// One lock guards everything. It is held while a handler runs, so that none runs after remove().
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
  // Controls of its frames; refused while it does not play.
  FrameControlReply control(RecordedPlay& play, FrameControlKind kind, Nanoseconds value);
  FrameControlReply start_at(RecordedPlay& play, MonotonicTime at);

 private:
  // Moves on to the frame that a control finds; false: there is none.
  bool finds_frame(RecordedPlay& play);
  void run();
  // Plays what is due; returns when to wake up.
  MonotonicTime turn(MonotonicTime now);
  void look_at_triggers(MonotonicTime now);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<RecordedPlay*> plays_;
  MonotonicTime next_look_{};  // at trigger files
  bool waiting_ = false;       // a camera waits for its trigger
  bool ending_ = false;
  std::thread thread_;
};

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
    for (const std::string& note : play.camera->notes) {
      play.on_event({CameraEvent::Kind::kNote, note});
    }
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

bool RecordedPlayer::finds_frame(RecordedPlay& play) {
  const bool is_started = std::find(plays_.begin(), plays_.end(), &play) != plays_.end();
  if (!is_started || play.state != RecordedPlay::State::kPlaying) return false;
  skip(play);
  return play.steering && play.state == RecordedPlay::State::kPlaying;
}

FrameControlReply RecordedPlayer::control(RecordedPlay& play, FrameControlKind kind,
                                          Nanoseconds value) {
  const std::lock_guard lock(mutex_);
  if (!finds_frame(play)) return {.refused = kNotPlaying};
  return play.steering->control(kind, value);
}

FrameControlReply RecordedPlayer::start_at(RecordedPlay& play, MonotonicTime at) {
  const std::lock_guard lock(mutex_);
  if (!finds_frame(play)) return {.refused = kNotPlaying};
  const PlayedFrame& frame = play.camera->frames[play.next];
  const MonotonicTime wanted = at + Nanoseconds(frame.exposure_lead_ns);
  FrameControlReply reply =
      play.steering->restart(frame.counter, wanted - (play.zero + Nanoseconds(frame.due_ns)));
  changed_.notify_one();
  return reply;
}

void RecordedPlayer::look_at_triggers(MonotonicTime now) {
  waiting_ = false;
  const std::string* path = nullptr;
  TriggerFile file;
  for (RecordedPlay* play : plays_) {
    if (play->trigger_file.empty()) continue;
    // Cameras of a rig mostly share their trigger: neighbours share a reading.
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
    const CameraFrame frame = next_frame(*play);
    play->on_frame(frame);
    play->watch.on_frame(frame, play->on_event);
    return now;
  }
  for (RecordedPlay* each : plays_) {
    if (each->state == RecordedPlay::State::kPlaying) each->watch.check(now, each->on_event);
  }
  // Between frames nothing depends on the trigger being off.
  const MonotonicTime wake_up =
      waiting_ ? std::min(next_look_, now + kLongestSleep) : now + kLongestSleep;
  return play == nullptr ? wake_up : std::min(wake_up, due(*play));
}

void RecordedPlayer::run() {
  ask_for_exact_timers();
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

namespace {

class RecordedSteering final : public CameraSteering {
 public:
  RecordedSteering(std::shared_ptr<RecordedPlayer> player, std::shared_ptr<RecordedPlay> play)
      : player_(std::move(player)), play_(std::move(play)), limits_(play_->steered->limits) {}

  const FrameControlLimits& limits() const override { return limits_; }
  FrameControlReply control(FrameControlKind kind, Nanoseconds value) override {
    return player_->control(*play_, kind, value);
  }
  FrameControlReply start_at(MonotonicTime at) override { return player_->start_at(*play_, at); }

 private:
  std::shared_ptr<RecordedPlayer> player_;
  std::shared_ptr<RecordedPlay> play_;
  FrameControlLimits limits_;
};

class RecordedCamera final : public Camera {
 public:
  RecordedCamera(CameraInfo info, std::string trigger_file,
                 std::shared_ptr<const PlayedCamera> played, std::shared_ptr<RecordedPlayer> player)
      : info_(std::move(info)),
        player_(std::move(player)),
        play_(std::make_shared<RecordedPlay>()) {
    play_->trigger_file = std::move(trigger_file);
    play_->camera = std::move(played);
    play_->wanted = {true, true};
  }
  ~RecordedCamera() override { stop(); }
  RecordedCamera(const RecordedCamera&) = delete;
  RecordedCamera& operator=(const RecordedCamera&) = delete;

  const CameraInfo& info() const override { return info_; }

  void configure(const CameraSettings& settings) override {
    if (started_) throw CameraError(info_.serial, "configured while it is started");
    std::array<bool, 2> wanted = {};
    for (const scenarios::Stream& stream : settings.streams) {
      const auto& frames = play_->camera->frames;
      if (std::none_of(frames.begin(), frames.end(),
                       [&](const PlayedFrame& frame) { return frame.stream == stream.kind; })) {
        throw CameraError(info_.serial,
                          fmt::format("{} has no {} stream", info_.model, to_text(stream.kind)));
      }
      wanted[static_cast<std::size_t>(stream.kind)] = true;
    }
    play_->wanted = wanted;
    play_->watch = StreamWatch(settings, true);
    play_->steered = settings.steering;
    if (!settings.steering) return;
    const auto starts = static_cast<std::size_t>(FrameControlKind::kStartAt);
    const auto& frames = play_->camera->frames;
    const bool has_exposures = std::none_of(
        frames.begin(), frames.end(),
        [](const PlayedFrame& frame) { return frame.exposure_lead_ns == kNoExposure; });
    play_->steered->limits.allowed[starts] =
        settings.steering->limits.allowed[starts] && has_exposures;
  }

  void start(FrameHandler on_frame, CameraEventHandler on_event) override {
    if (started_) throw CameraError(info_.serial, "started twice");
    play_->on_frame = std::move(on_frame);
    play_->on_event = std::move(on_event);
    player_->add(*play_);
    started_ = true;
  }

  void stop() override {
    player_->remove(*play_);
    started_ = false;
  }
  std::shared_ptr<CameraSteering> steering() override {
    if (!play_->steered) return nullptr;
    return std::make_shared<RecordedSteering>(player_, play_);
  }

 private:
  CameraInfo info_;
  std::shared_ptr<RecordedPlayer> player_;
  bool started_ = false;
  std::shared_ptr<RecordedPlay> play_;
};

}  // namespace

RecordedCameraDriver::RecordedCameraDriver(const std::vector<RigCamera>& cameras)
    : player_(std::make_shared<RecordedPlayer>()) {
  std::map<std::string, std::vector<RigCamera>> by_recording;
  for (const RigCamera& camera : cameras) by_recording[camera.recording].push_back(camera);
  std::map<std::string, std::shared_ptr<const PlayedCamera>> played;
  for (const auto& [recording, wanted] : by_recording) {
    const auto loaded = load_played_cameras(recording, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i) played[wanted[i].serial] = loaded[i];
  }
  for (const RigCamera& camera : cameras) {
    const auto& found = played[camera.serial];
    entries_.push_back(
        {{.serial = camera.serial,
          .model = fmt::format("recording of {} ({})", found->name, camera.recording),
          .firmware = "",
          .connection = "file"},
         camera.trigger_file,
         found});
  }
}

std::vector<CameraInfo> RecordedCameraDriver::list() {
  std::vector<CameraInfo> result;
  for (const Entry& entry : entries_) result.push_back(entry.info);
  return result;
}

std::unique_ptr<Camera> RecordedCameraDriver::open(const std::string& serial) {
  std::vector<std::string> known;
  for (const Entry& entry : entries_) {
    if (entry.info.serial == serial) {
      return std::make_unique<RecordedCamera>(entry.info, entry.trigger_file, entry.played,
                                              player_);
    }
    known.push_back(entry.info.serial);
  }
  throw CameraError(
      serial, fmt::format("not among the recorded cameras, which are {}", fmt::join(known, ", ")));
}

}  // namespace simbench::hardware
