#include "evaluation/fit/fit_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "algorithms/ports/time.h"
#include "evaluation/fit/fit_frames.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/frame_account.h"

namespace simbench::evaluation {
namespace {

const std::string kOneHost = "host0";

void name_all(std::vector<std::string>& names, std::size_t count, const char* kind) {
  names.resize(std::min(names.size(), count));
  while (names.size() < count) names.push_back(fmt::format("{}{}", kind, names.size()));
}

// Adds a stream with its usable frames; `delivered` is unwrapped.
void add_stream(FitInput& input, FitStream stream, std::span<const StampedFrame> delivered,
                std::optional<Nanoseconds> warm_up) {
  UsableFrames usable = usable_frames(delivered, stream.counted, warm_up);
  for (const std::string& line : usable.left_out) {
    input.left_out.push_back(
        fmt::format("camera {}, {}: {}", input.cameras[stream.camera].name, stream.kind, line));
  }
  stream.frames = std::move(usable.frames);
  stream.account = usable.account;
  stream.lost_together = usable.lost_together;
  input.streams.push_back(std::move(stream));
}

}  // namespace

void FitInputSink::on_start(const RigLayout& layout) {
  input_ = {};
  stamps_.clear();
  input_.hosts = options_.hosts;
  name_all(input_.hosts, layout.hosts, "host");
  std::vector<std::string> names = options_.cameras;
  name_all(names, layout.cameras.size(), "camera");
  for (std::size_t i = 0; i < layout.cameras.size(); ++i) {
    input_.cameras.push_back({names[i], layout.cameras[i].host});
  }
}

void FitInputSink::on_frames(std::span<const FrameRecord> frames,
                             std::span<const FrameTruth> truths) {
  for_each_frame(frames, truths,
                 [this](const FrameRecord& frame, const FrameTruth* truth) { add(frame, truth); });
}

void FitInputSink::add(const FrameRecord& frame, const FrameTruth* truth) {
  if (frame.domain != StampDomain::kHardwareClock) {
    throw FitError(fmt::format(
        "camera {}: found stamps that are not of the camera's clock, allowed hardware stamps (of a "
        "RealSense: with its frame metadata enabled, and the option \"global time\" off)",
        input_.cameras[frame.camera].name));
  }
  std::int64_t arrival_ns = frame.arrival_steady.time_since_epoch().count();
  if (options_.true_time && truth != nullptr) {
    // A host's rate changes the milliseconds between exposure and arrival by less than 1 ns.
    const Nanoseconds since_exposure = frame.arrival_steady - truth->own_steady;
    arrival_ns = (truth->mid_exposure().time_since_epoch() + since_exposure).count();
  }
  stamps_[{frame.camera, frame.stream}].push_back(
      {frame.counter, frame.sensor.us, frame.frame.us, arrival_ns});
}

void FitInputSink::on_event(const RecordingEvent& event) {
  if (std::holds_alternative<ClockAdjustment>(event) ||
      std::holds_alternative<ExchangeEvent>(event)) {
    input_.clock_events.push_back(event);
  }
}

FitInput FitInputSink::take() {
  for (const auto& [key, stamps] : stamps_) {
    const bool has_frame_stamps =
        std::any_of(stamps.begin(), stamps.end(), [](const Stamps& s) { return s.frame_us != 0; });
    std::vector<StampedFrame> frames;
    for (const Stamps& s : stamps) {
      const std::int64_t device_us = has_frame_stamps ? s.frame_us : s.sensor_us;
      frames.push_back({.counter = s.counter,
                        .sensor = Nanoseconds(device_us * 1000),
                        .arrival = Nanoseconds(s.arrival_ns)});
    }
    add_stream(input_,
               {.camera = key.first, .kind = std::string(to_text(key.second)), .frames = {}},
               unwrapped(frames), from_ms(options_.warm_up_ms));
  }
  stamps_.clear();
  return std::move(input_);
}

FitInput fit_input(const std::vector<RecordedStream>& streams, bool one_host) {
  FitInput input;
  const auto number_of = [](auto& all, const std::string& name, auto&& add) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& known) {
      if constexpr (requires { known.name; }) {
        return known.name == name;
      } else {
        return known == name;
      }
    });
    if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
    all.push_back(add());
    return all.size() - 1;
  };
  for (const RecordedStream& stream : streams) {
    const std::string& host = one_host ? kOneHost : stream.host;
    const std::size_t host_number = number_of(input.hosts, host, [&] { return host; });
    const std::size_t camera = number_of(input.cameras, stream.camera, [&] {
      return FitCamera{stream.camera, static_cast<std::uint32_t>(host_number)};
    });
    add_stream(input,
               {.camera = camera, .kind = stream.stream, .frames = {}, .counted = stream.counted},
               unwrapped(stream.frames), std::nullopt);
  }
  return input;
}

std::pair<FitInput, FitInput> halves(const FitInput& input) {
  std::pair<FitInput, FitInput> result{input, input};
  result.first.left_out.clear();
  result.second.left_out.clear();
  for (std::size_t i = 0; i < input.streams.size(); ++i) {
    auto& first = result.first.streams[i].frames;
    auto& second = result.second.streams[i].frames;
    const auto middle = static_cast<std::ptrdiff_t>(first.size() / 2);
    first.erase(first.begin() + middle, first.end());
    second.erase(second.begin(), second.begin() + middle);
    const bool counted = input.streams[i].counted;
    result.first.streams[i].account = frame_account(first, counted);
    result.second.streams[i].account = frame_account(second, counted);
    result.first.streams[i].lost_together = lost_together(first, counted);
    result.second.streams[i].lost_together = lost_together(second, counted);
  }
  return result;
}

}  // namespace simbench::evaluation
