#include "hardware/camera/recorded_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "bags/recorded_files.h"
#include "hardware/camera/camera.h"
#include "recording/number_in.h"
#include "recording/recording_folder.h"

namespace simbench::hardware {
namespace {

// Cameras of a recording by number; unwanted ones are null.
using Played = std::vector<std::shared_ptr<PlayedCamera>>;

// The recording's camera to play: `recorded_camera` by name, else by number; by default the camera
// of the serial, else the first.
std::size_t chosen_camera(const RigCamera& camera, const std::string& recording,
                          const std::vector<std::string>& names) {
  const std::string& name = camera.recorded_camera.empty() ? camera.serial : camera.recorded_camera;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (camera.recorded_camera.empty() && !names.empty()) return 0;
  const auto number = number_in<std::size_t>(name);
  if (number && *number < names.size()) return *number;
  throw CameraError(camera.serial,
                    fmt::format("{}: found recorded_camera '{}', allowed {} or a number below {}",
                                recording, name, fmt::join(names, ", "), names.size()));
}

struct Choice {
  std::vector<std::size_t> of_wanted;
  Played cameras;
};

Choice choose(const std::string& recording, const std::vector<RigCamera>& wanted,
              const std::vector<std::string>& names) {
  Choice choice;
  choice.cameras.resize(names.size());
  for (const RigCamera& camera : wanted) {
    const std::size_t number = chosen_camera(camera, recording, names);
    choice.of_wanted.push_back(number);
    if (choice.cameras[number]) continue;
    choice.cameras[number] = std::make_shared<PlayedCamera>();
    choice.cameras[number]->name = names[number];
  }
  return choice;
}

// Counts due times from the recording's zero, sorts the frames and returns the wanted cameras.
std::vector<std::shared_ptr<const PlayedCamera>> finished(Choice choice, std::int64_t zero_ns,
                                                          const std::string& recording,
                                                          const std::vector<RigCamera>& wanted) {
  for (const auto& camera : choice.cameras) {
    if (!camera) continue;
    for (PlayedFrame& frame : camera->frames) frame.due_ns -= zero_ns;
    std::stable_sort(
        camera->frames.begin(), camera->frames.end(),
        [](const PlayedFrame& a, const PlayedFrame& b) { return a.due_ns < b.due_ns; });
    camera->frames.shrink_to_fit();
  }
  std::vector<std::shared_ptr<const PlayedCamera>> result;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    result.push_back(choice.cameras[choice.of_wanted[i]]);
    if (result.back()->frames.empty()) {
      throw CameraError(wanted[i].serial,
                        fmt::format("{}: no frame of camera {} is in the recording", recording,
                                    result.back()->name));
    }
  }
  return result;
}

// Keeps the frames of the cameras that are wanted and finds the recording's zero.
class FrameKeeper final : public RecordingSink {
 public:
  explicit FrameKeeper(const Played& cameras) : cameras_(cameras) {}

  void on_start(const RigLayout& /*layout*/) override {}
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    for_each_frame(frames, truths, [this](const FrameRecord& frame, const FrameTruth* truth) {
      add(frame, truth);
    });
  }
  void on_event(const RecordingEvent& /*event*/) override {}

  bool mixed() const { return with_truth_ && without_truth_; }
  std::int64_t zero_ns() const { return first_exposure_.value_or(first_delivery_.value_or(0)); }

 private:
  void add(const FrameRecord& frame, const FrameTruth* truth) {
    (truth != nullptr ? with_truth_ : without_truth_) = true;
    const std::int64_t due =
        truth != nullptr ? true_delivery(frame, *truth) : nanoseconds_of(frame.arrival);
    first_delivery_ = std::min(first_delivery_.value_or(due), due);
    if (truth != nullptr && truth->pulse >= 0) {
      const std::int64_t exposed = nanoseconds_of(truth->exposure_start);
      first_exposure_ = std::min(first_exposure_.value_or(exposed), exposed);
    }
    if (frame.camera >= cameras_.size() || !cameras_[frame.camera]) return;
    cameras_[frame.camera]->frames.push_back(
        {.due_ns = due,
         .counter = frame.counter,
         .exposure_us = frame.exposure_us,
         .sensor = frame.sensor,
         .frame = frame.frame,
         .backend_lead_ns = lead_ns((frame.arrival - frame.backend).count()),
         .exposure_lead_ns = exposure_lead_ns(due, truth),
         .stream = frame.stream,
         .domain = frame.domain});
  }
  static std::int64_t true_delivery(const FrameRecord& frame, const FrameTruth& truth) {
    return nanoseconds_of(truth.mid_exposure()) + (frame.arrival_steady - truth.own_steady).count();
  }
  // A stamp that is more than two seconds off does not belong to this frame.
  static std::int32_t lead_ns(std::int64_t lead) {
    constexpr std::int64_t kLongestNs = 2'000'000'000;
    return lead < -kLongestNs || lead > kLongestNs ? kNoBackend : static_cast<std::int32_t>(lead);
  }
  static std::int32_t exposure_lead_ns(std::int64_t due, const FrameTruth* truth) {
    return truth != nullptr ? lead_ns(due - nanoseconds_of(truth->exposure_start)) : kNoExposure;
  }

  const Played& cameras_;
  bool with_truth_ = false;
  bool without_truth_ = false;
  std::optional<std::int64_t> first_exposure_;
  std::optional<std::int64_t> first_delivery_;
};

struct CaptureName {
  std::string folder;
  std::string capture;  // empty: the first
};

CaptureName capture_name(const std::string& recording) {
  std::error_code none;
  const std::size_t mark = recording.rfind('#');
  if (mark == std::string::npos || std::filesystem::exists(recording, none)) {
    return {recording, ""};
  }
  return {recording.substr(0, mark), recording.substr(mark + 1)};
}

std::size_t chosen_capture(const RecordingFolder& folder, const CaptureName& name,
                           const RigCamera& camera) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < folder.captures().size(); ++i) {
    const RecordedCapture& capture = folder.captures()[i];
    known.push_back(fmt::format("{}/{}", capture.pipeline, capture.seed));
    if (name.capture.empty() || name.capture == capture.pipeline || name.capture == known.back()) {
      return i;
    }
  }
  if (known.empty())
    throw CameraError(camera.serial,
                      fmt::format("{}: no capture is in the recording", name.folder));
  throw CameraError(camera.serial, fmt::format("{}: found capture '{}', allowed {}", name.folder,
                                               name.capture, fmt::join(known, ", ")));
}

std::vector<std::shared_ptr<const PlayedCamera>> load_folder(const CaptureName& name,
                                                             const std::vector<RigCamera>& wanted) {
  const RecordingFolder folder(name.folder);
  const std::size_t capture = chosen_capture(folder, name, wanted.front());
  std::vector<std::string> names = folder.description().cameras;
  for (std::size_t i = names.size(); i < folder.captures()[capture].layout.cameras.size(); ++i) {
    names.push_back(fmt::format("camera{}", i));
  }
  if (names.empty())
    throw CameraError(wanted.front().serial, name.folder + ": no camera is in the recording");
  Choice choice = choose(name.folder, wanted, names);
  FrameKeeper keeper(choice.cameras);
  folder.play(capture, keeper);
  if (keeper.mixed()) {
    throw CameraError(wanted.front().serial,
                      name.folder + ": found frames with and without truth, allowed one of them");
  }
  return finished(std::move(choice), keeper.zero_ns(), name.folder, wanted);
}

// "Depth 0" of the SDK's files, "depth" and "color" of ROS.
bool is_depth(const RecordedStream& stream) {
  return stream.stream.starts_with("Depth") || stream.stream.starts_with("depth");
}
bool is_colour(const RecordedStream& stream) {
  return stream.stream.starts_with("Colo") || stream.stream.starts_with("colo");
}

// The kind as which a CSV's stream is played. Infrared images are exposed with the depth images, so
// they stand for depth if a camera has none.
std::optional<StreamKind> stream_kind(const RecordedStream& stream,
                                      const std::vector<RecordedStream>& streams) {
  if (is_colour(stream)) return StreamKind::kColour;
  for (const RecordedStream& other : streams) {
    if (other.camera != stream.camera || is_colour(other)) continue;
    const bool better = is_depth(other) && !is_depth(stream);
    if (better) return std::nullopt;
  }
  for (const RecordedStream& other : streams) {  // the first of its kind
    if (other.camera == stream.camera && !is_colour(other) && is_depth(other) == is_depth(stream)) {
      return &other == &stream ? std::optional(StreamKind::kDepth) : std::nullopt;
    }
  }
  return std::nullopt;
}

PlayedFrame played(const StampedFrame& frame, StreamKind kind) {
  const auto us = std::chrono::round<Microseconds>(frame.sensor).count();
  const DeviceStamp stamp{static_cast<std::uint32_t>(us)};
  return {.due_ns = frame.arrival.count(),
          .counter = static_cast<std::uint32_t>(frame.counter),
          .sensor = stamp,
          .frame = stamp,
          .stream = kind};
}

std::vector<std::shared_ptr<const PlayedCamera>> load_file(const std::string& path,
                                                           const std::vector<RigCamera>& wanted) {
  const auto [streams, notes] = bags::read_recorded_files({path}, {});
  std::vector<std::string> names;
  for (const RecordedStream& stream : streams) {
    if (std::find(names.begin(), names.end(), stream.camera) == names.end()) {
      names.push_back(stream.camera);
    }
  }
  Choice choice = choose(path, wanted, names);
  choice.cameras[choice.of_wanted.front()]->notes = notes;
  std::optional<std::int64_t> zero_ns;
  for (const RecordedStream& stream : streams) {
    for (const StampedFrame& frame : stream.frames) {
      zero_ns = std::min(zero_ns.value_or(frame.arrival.count()), frame.arrival.count());
    }
    const auto number = std::find(names.begin(), names.end(), stream.camera) - names.begin();
    const auto& camera = choice.cameras[static_cast<std::size_t>(number)];
    const std::optional<StreamKind> kind = stream_kind(stream, streams);
    if (!camera || !kind) continue;
    for (const StampedFrame& frame : stream.frames) camera->frames.push_back(played(frame, *kind));
  }
  return finished(std::move(choice), zero_ns.value_or(0), path, wanted);
}

}  // namespace

std::vector<std::shared_ptr<const PlayedCamera>> load_played_cameras(
    const std::string& recording, const std::vector<RigCamera>& wanted) {
  const CaptureName name = capture_name(recording);
  std::error_code none;
  const auto status = std::filesystem::status(name.folder, none);
  if (!std::filesystem::exists(status)) {
    throw CameraError(wanted.front().serial,
                      fmt::format("{}: no such recording, allowed a folder that `simbench "
                                  "record` wrote, a bag or a CSV file",
                                  name.folder));
  }
  try {
    return std::filesystem::is_directory(status) && !bags::is_bag(name.folder)
               ? load_folder(name, wanted)
               : load_file(name.folder, wanted);
  } catch (const RecordingFolderError& error) {
    throw CameraError(wanted.front().serial, error.what());
  } catch (const RecordedFileError& error) {
    throw CameraError(wanted.front().serial, error.what());
  }
}

}  // namespace simbench::hardware
