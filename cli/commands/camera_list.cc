#include "cli/commands/camera_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reports/text/plain_text.h"
#include "scenarios/camera_profile.h"

namespace simbench::cli {
namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kDeeper = 4;

std::string stream_text(const scenarios::StreamProfile& stream) {
  std::string text = reports::wrapped(
      fmt::format("{}: {}, {} shutter, {} bytes a pixel [{}]", to_text(stream.kind), stream.format,
                  to_text(stream.shutter), stream.bytes_per_pixel, stream.source),
      kIndent);
  for (const scenarios::ImageSize& size : stream.sizes) {
    text += fmt::format("{:{}}{}x{} at {} Hz\n", "", kDeeper, size.width, size.height,
                        fmt::join(size.rates_hz, ", "));
  }
  return text;
}

std::string sync_text(const scenarios::CameraProfile& camera) {
  std::vector<std::string> modes;
  for (const scenarios::SyncModeProfile& mode : camera.sync_modes) {
    std::vector<std::string_view> triggered;
    for (const scenarios::StreamKind kind : mode.triggered) triggered.push_back(to_text(kind));
    modes.push_back(triggered.empty() ? fmt::format("{} (runs free)", to_text(mode.mode))
                                      : fmt::format("{} (the trigger leads {})", to_text(mode.mode),
                                                    fmt::join(triggered, " and ")));
  }
  return reports::wrapped(fmt::format("sync modes: {}. {} [{}]", fmt::join(modes, ", "),
                                      camera.sync_wiring, camera.sync_source),
                          kIndent);
}

std::string stamp_text(const scenarios::StampProfile& stamp) {
  const std::string wrap =
      stamp.wraps_after_s ? fmt::format(", wraps after {} s", *stamp.wraps_after_s) : "";
  return reports::wrapped(fmt::format("stamp {}: {} clock, {}{}: {} [{}]", stamp.stamp, stamp.clock,
                                      stamp.unit, wrap, stamp.meaning, stamp.source),
                          kIndent);
}

std::string latency_text(const scenarios::CameraProfile& camera) {
  if (camera.typical_latency_ms.empty()) {
    return reports::wrapped(fmt::format("latency: {}", camera.latency_source), kIndent);
  }
  return reports::wrapped(
      fmt::format("latency: {} ms [{}]", fmt::join(camera.typical_latency_ms, " to "),
                  camera.latency_source),
      kIndent);
}

}  // namespace

std::string camera_list_text() {
  std::string text;
  for (const scenarios::CameraProfile& camera : scenarios::camera_profiles()) {
    text += fmt::format("{}{}: {}, {}\n", text.empty() ? "" : "\n", camera.model, camera.name,
                        camera.maker);
    for (const scenarios::StreamProfile& stream : camera.streams) text += stream_text(stream);
    text += sync_text(camera);
    for (const scenarios::StampProfile& stamp : camera.stamps) text += stamp_text(stamp);
    text += latency_text(camera);
  }
  return text;
}

}  // namespace simbench::cli
