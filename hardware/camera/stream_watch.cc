#include "hardware/camera/stream_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "recording/counted.h"

namespace simbench::hardware {
namespace {

constexpr Nanoseconds kLeastPatience = std::chrono::seconds(1);
constexpr Nanoseconds kStartPatience = std::chrono::seconds(4);
constexpr int kPatiencePeriods = 10;
constexpr Nanoseconds kBetweenNotes = std::chrono::seconds(10);
// A counter that went forward by more than this has gone back: the camera restarted.
constexpr std::uint32_t kLargestGap = 1U << 31;
constexpr std::int64_t kClockToleranceUs = 1'000'000;

Nanoseconds patience_of(const CameraSettings& settings, const scenarios::Stream& stream) {
  const double rate_hz = waits_for_trigger(settings.sync_mode) && settings.trigger_rate_hz > 0
                             ? std::min(settings.trigger_rate_hz, stream.mode_rate_hz)
                             : stream.mode_rate_hz;
  if (rate_hz <= 0) return kLeastPatience;
  return std::max(kLeastPatience, from_ms(1e3 * kPatiencePeriods / rate_hz));
}

bool clock_jumped(std::uint32_t passed_us, Nanoseconds host_passed, StampDomain domain) {
  if (domain != StampDomain::kHardwareClock) return false;
  const auto host_us = static_cast<std::uint32_t>(host_passed / Microseconds(1));
  const auto apart_us = static_cast<std::int32_t>(passed_us - host_us);
  return std::abs(std::int64_t{apart_us}) > kClockToleranceUs;
}

}  // namespace

StreamWatch::StreamWatch(const CameraSettings& settings, bool waits) : waits_(waits) {
  for (Stream& stream : streams_) stream.patience = kLeastPatience;
  for (const scenarios::Stream& wanted : settings.streams) {
    Stream& stream = streams_[static_cast<std::size_t>(wanted.kind)];
    stream.expected = true;
    stream.patience = patience_of(settings, wanted);
  }
}

bool StreamWatch::Limit::permits(MonotonicTime now) {
  if (used && now - at < kBetweenNotes) return false;
  used = true;
  at = now;
  return true;
}

void StreamWatch::start(MonotonicTime now) {
  for (Stream& stream : streams_) {
    stream.seen = stream.stalled = false;
    stream.last = now;
  }
  reported_metadata_ = false;
  lost_ = 0;
  losses_ = restarts_ = {};
}

void StreamWatch::on_frame(const CameraFrame& frame, const CameraEventHandler& report) {
  Stream& stream = streams_[static_cast<std::size_t>(frame.stream)];
  if (stream.seen) compare(stream, frame, report);
  if (stream.stalled) {
    report({CameraEvent::Kind::kNote,
            fmt::format("{}: frames come again, after {:.1f} s", to_text(frame.stream),
                        to_seconds(frame.arrived - stream.last))});
  }
  stream.seen = true;
  stream.stalled = false;
  stream.counter = frame.counter;
  stream.stamp_us = frame.frame.us;
  stream.last = frame.arrived;
}

void StreamWatch::compare(const Stream& before, const CameraFrame& frame,
                          const CameraEventHandler& report) {
  const std::uint32_t forward = frame.counter - before.counter;
  const bool counts_anew = forward == 0 || forward >= kLargestGap;
  if (counts_anew ||
      clock_jumped(frame.frame.us - before.stamp_us, frame.arrived - before.last, frame.domain)) {
    if (!restarts_.permits(frame.arrived)) return;
    report({CameraEvent::Kind::kNote,
            fmt::format("{}: the camera's {} jumped between frames {} and {}: did it restart?",
                        to_text(frame.stream), counts_anew ? "frame counter" : "clock",
                        before.counter, frame.counter)});
  } else if (forward > 1) {
    lost_ += forward - 1;
    if (!losses_.permits(frame.arrived)) return;
    report({CameraEvent::Kind::kNote,
            fmt::format("{}: the frame counter went from {} to {}: {} lost since the start",
                        to_text(frame.stream), before.counter, frame.counter,
                        counted(lost_, "frame"))});
  }
}

void StreamWatch::check(MonotonicTime now, const CameraEventHandler& report) {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    Stream& stream = streams_[i];
    const bool awaited = stream.seen || (stream.expected && !waits_);
    const Nanoseconds patience =
        stream.seen ? stream.patience : std::max(stream.patience, kStartPatience);
    if (!awaited || stream.stalled || now - stream.last <= patience) continue;
    stream.stalled = true;
    report({CameraEvent::Kind::kStalled,
            fmt::format("{}: no frame for {:.1f} s{}", to_text(static_cast<StreamKind>(i)),
                        to_seconds(now - stream.last),
                        stream.seen ? fmt::format(", the last was {}", stream.counter) : "")});
  }
}

void StreamWatch::missing_metadata(std::string_view what, const CameraEventHandler& report) {
  if (reported_metadata_) return;
  reported_metadata_ = true;
  report(
      {CameraEvent::Kind::kMissingMetadata,
       fmt::format("frames lack {}, their stamps are less exact: on Linux, install librealsense's "
                   "kernel patches (its DKMS package or scripts/patch-realsense-*.sh), or build "
                   "librealsense with -DFORCE_RSUSB_BACKEND=ON",
                   what)});
}

}  // namespace simbench::hardware
