#include "recording/recording_manifest.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "recording/append_file.h"
#include "recording/version.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kManifest = "/manifest.json";
constexpr std::uintmax_t kLargestManifest = 256U << 20U;

Json json_of(const RecordedCapture& capture) {
  Json cameras = Json::array();
  for (const CameraLayout& camera : capture.layout.cameras) cameras.push_back(camera.host);
  return {{"pipeline", capture.pipeline},
          {"seed", capture.seed},
          {"complete", capture.complete},
          {"layout",
           {{"hosts", capture.layout.hosts},
            {"camera_hosts", std::move(cameras)},
            {"frame_rate_hz", capture.layout.frame_rate_hz},
            {"first_pulse", capture.layout.first_pulse},
            {"pulses", capture.layout.pulses}}},
          {"cost",
           {{"events", capture.cost.events},
            {"simulated_seconds", capture.cost.simulated_seconds},
            {"trace_hash", capture.cost.trace_hash}}},
          {"lines", {{"frames", capture.frames}, {"events", capture.other_events}}},
          {"notes", capture.notes}};
}

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

std::string file_name(const std::string& pipeline) {
  std::string name;
  for (const char c : pipeline) {
    if (is_plain(c) || (c == '.' && !name.empty())) {
      name += c;
    } else {
      name += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return name;
}

}  // namespace

std::string manifest_text(const RecordingManifest& manifest) {
  const RecordingDescription& description = manifest.description;
  Json root = {{"format", kRecordingFormat},
               {"format_version", kRecordingFormatVersion},
               {"version", version()},
               {"commit", commit()},
               {"backend", description.backend},
               {"hosts", description.hosts},
               {"cameras", description.cameras},
               {"captures", Json::array()},
               {"scenario", nullptr}};
  for (const RecordedCapture& capture : manifest.captures) {
    root["captures"].push_back(json_of(capture));
  }
  if (!description.scenario_json.empty()) {
    root["scenario"] = Json::parse(description.scenario_json);
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void write_manifest(const RecordingManifest& manifest, const std::string& folder) {
  const std::string path = folder + kManifest;
  const std::string temporary = path + ".unfinished";
  std::remove(temporary.c_str());  // of an attempt that failed, on a disk that was full
  {
    AppendFile file(temporary);
    file.buffer() = manifest_text(manifest);
    file.close();
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) {
    throw RecordingFolderError(fmt::format("{}: cannot be written: {}", path, error.message()));
  }
}

RecordingManifest read_manifest(const std::string& folder) {
  const std::string path = folder + kManifest;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw RecordingFolderError(fmt::format("{}: there is no such folder", folder));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw RecordingFolderError(fmt::format(
        "{}: is no recording, it has no manifest.json; `simbench record` makes one", folder));
  }
  if (std::filesystem::file_size(path, error) > kLargestManifest) {
    throw RecordingFolderError(fmt::format("{}: larger than {} bytes", path, kLargestManifest));
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw RecordingFolderError(fmt::format("{}: cannot be read", path));
  return parse_manifest(text.str(), path);
}

std::string capture_folder(const std::string& folder, const std::string& pipeline,
                           std::uint64_t seed) {
  return fmt::format("{}/{}/{}", folder, file_name(pipeline), seed);
}

}  // namespace simbench
