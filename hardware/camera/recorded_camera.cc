#include "hardware/camera/recorded_camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "hardware/camera/recorded_player.h"

namespace simbench::hardware {
namespace {

class RecordedCamera final : public Camera {
 public:
  RecordedCamera(CameraInfo info, std::string trigger_file,
                 std::shared_ptr<const PlayedCamera> played, std::shared_ptr<RecordedPlayer> player)
      : info_(std::move(info)), player_(std::move(player)) {
    play_.trigger_file = std::move(trigger_file);
    play_.camera = std::move(played);
    play_.wanted = {true, true};
  }
  ~RecordedCamera() override { stop(); }
  RecordedCamera(const RecordedCamera&) = delete;
  RecordedCamera& operator=(const RecordedCamera&) = delete;

  const CameraInfo& info() const override { return info_; }

  void configure(const CameraSettings& settings) override {
    if (started_) fail("configured while it is started");
    std::array<bool, 2> wanted = {};
    for (const scenarios::Stream& stream : settings.streams) {
      const auto& frames = play_.camera->frames;
      if (std::none_of(frames.begin(), frames.end(),
                       [&](const PlayedFrame& frame) { return frame.stream == stream.kind; })) {
        fail(fmt::format("{} has no {} stream", info_.model, to_text(stream.kind)));
      }
      wanted[static_cast<std::size_t>(stream.kind)] = true;
    }
    play_.wanted = wanted;
    play_.watch = StreamWatch(settings, true);
  }

  void start(FrameHandler on_frame, CameraEventHandler on_event) override {
    if (started_) fail("started twice");
    play_.on_frame = std::move(on_frame);
    play_.on_event = std::move(on_event);
    player_->add(play_);
    started_ = true;
  }

  void stop() override {
    player_->remove(play_);
    started_ = false;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw CameraError(fmt::format("camera {}: {}", info_.serial, problem));
  }

  CameraInfo info_;
  std::shared_ptr<RecordedPlayer> player_;
  bool started_ = false;
  RecordedPlay play_;
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
  throw CameraError(fmt::format("camera {}: not among the recorded cameras, which are {}", serial,
                                fmt::join(known, ", ")));
}

}  // namespace simbench::hardware
