#include "recording/recording_manifest.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "recording/append_file.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "scenarios/input_file.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kManifest = "/manifest.json";
constexpr std::size_t kLargestManifest = 256U << 20U;

Json json_of(const RecordedCapture& capture) {
  Json cameras = Json::array();
  for (const CameraLayout& camera : capture.layout.cameras) cameras.push_back(camera.host);
  Json json = {{"pipeline", capture.pipeline},
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
  if (capture.cost.messages) json["cost"]["messages"] = *capture.cost.messages;
  return json;
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

constexpr int kDeepest = 64;  // a scenario's depth is under 10
constexpr std::int64_t kMostPulses = 1'000'000'000;
constexpr double kLowestRate = 1e-6;
constexpr double kHighestRate = 1e6;

// A value of the document and where it stands.
class Value {
 public:
  Value(const Json& json, std::string pointer, const std::string& path)
      : json_(json), pointer_(std::move(pointer)), path_(path) {}

  Value at(const char* key) const {
    if (!json_.is_object()) fail("an object");
    const auto member = json_.find(key);
    if (member == json_.end()) {
      throw RecordingFolderError(fmt::format("{}: {}/{}: missing", path_, pointer_, key));
    }
    return {*member, fmt::format("{}/{}", pointer_, key), path_};
  }
  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }
  Value at(std::size_t index) const {
    return {json_[index], fmt::format("{}/{}", pointer_, index), path_};
  }
  // The value must be an array.
  std::size_t size(std::size_t most) const {
    if (!json_.is_array() || json_.size() > most) {
      fail(fmt::format("an array of at most {}", most));
    }
    return json_.size();
  }

  template <class Number>
  Number whole(Number low, Number high) const {
    bool inside = false;
    if (json_.is_number_unsigned()) {
      const auto value = json_.get<std::uint64_t>();
      inside = std::cmp_greater_equal(value, low) && std::cmp_less_equal(value, high);
    } else if (json_.is_number_integer()) {
      const auto value = json_.get<std::int64_t>();
      inside = std::cmp_greater_equal(value, low) && std::cmp_less_equal(value, high);
    }
    if (!inside) fail(fmt::format("a whole number from {} to {}", low, high));
    return json_.get<Number>();
  }
  double number(double low, double high) const {
    const double value = json_.is_number() ? json_.get<double>() : std::nan("");
    if (!(value >= low && value <= high)) fail(fmt::format("a number from {} to {}", low, high));
    return value;
  }
  std::string text() const {
    if (!json_.is_string()) fail("a text");
    return json_.get<std::string>();
  }
  bool truth() const {
    if (!json_.is_boolean()) fail("true, false");
    return json_.get<bool>();
  }
  std::vector<std::string> texts(std::size_t most) const {
    std::vector<std::string> texts;
    const std::size_t count = size(most);
    for (std::size_t i = 0; i < count; ++i) texts.push_back(at(i).text());
    return texts;
  }
  const Json& json() const { return json_; }

  [[noreturn]] void fail(const std::string& allowed) const {
    const std::string found = json_.is_structured()
                                  ? std::string(json_.type_name())
                                  : json_.dump(-1, ' ', true, Json::error_handler_t::replace);
    throw RecordingFolderError(fmt::format("{}: {}: found {}, allowed: {}", path_, pointer_,
                                           quoted_bytes(found), allowed));
  }

 private:
  const Json& json_;
  std::string pointer_;
  const std::string& path_;
};

std::vector<std::string> names_of(const Value& value, std::size_t most) {
  std::vector<std::string> names = value.texts(most);
  for (std::string& name : names) name = printable_name(name);
  return names;
}

RigLayout layout_of(const Value& value) {
  RigLayout layout;
  layout.hosts = value.at("hosts").whole<std::uint32_t>(1, kMostHosts);
  const Value hosts = value.at("camera_hosts");
  const std::size_t cameras = hosts.size(kMostCameras);
  if (cameras == 0) hosts.fail("at least one camera");
  layout.cameras.reserve(cameras);
  for (std::size_t i = 0; i < cameras; ++i) {
    layout.cameras.push_back({hosts.at(i).whole<std::uint32_t>(0, layout.hosts - 1)});
  }
  layout.frame_rate_hz = value.at("frame_rate_hz").number(kLowestRate, kHighestRate);
  layout.first_pulse = value.at("first_pulse").whole(-kMostPulses, kMostPulses);
  layout.pulses = value.at("pulses").whole<std::int64_t>(0, kMostPulses);
  return layout;
}

PlannedCaptures planned_of(const Value& value) {
  constexpr std::uint64_t kMost = 1'000'000'000'000;
  return {.pipelines = value.at("pipelines").texts(100'000),
          .first_seed = value.at("first_seed").whole<std::uint64_t>(0, kMost),
          .seeds = value.at("seeds").whole<std::uint64_t>(0, kMost)};
}

RecordedCapture capture_of(const Value& value) {
  constexpr std::uint64_t kAny = ~std::uint64_t{0};
  RecordedCapture capture;
  capture.pipeline = value.at("pipeline").text();
  capture.seed = value.at("seed").whole<std::uint64_t>(0, kAny);
  capture.layout = layout_of(value.at("layout"));
  const Value cost = value.at("cost");
  capture.cost.events = cost.at("events").whole<std::uint64_t>(0, kAny);
  capture.cost.simulated_seconds = cost.at("simulated_seconds").number(0, 1e12);
  capture.cost.trace_hash = cost.at("trace_hash").whole<std::uint64_t>(0, kAny);
  // Older recordings and real rigs do not say.
  if (cost.has("messages")) {
    capture.cost.messages = cost.at("messages").whole<std::uint64_t>(0, kAny);
  }
  capture.complete = value.at("complete").truth();
  const Value lines = value.at("lines");
  capture.frames = lines.at("frames").whole<std::uint64_t>(0, kAny);
  capture.other_events = lines.at("events").whole<std::uint64_t>(0, kAny);
  capture.notes = value.at("notes").texts(100'000);
  return capture;
}

Json parsed(const std::string& text, const std::string& path) {
  const auto check_depth = [&path](int depth, Json::parse_event_t, Json&) {
    if (depth <= kDeepest) return true;
    throw RecordingFolderError(fmt::format("{}: nested deeper than {}", path, kDeepest));
  };
  try {
    return Json::parse(text, check_depth);
  } catch (const Json::exception& error) {  // no JSON, or a number that no double holds
    const std::string_view what = error.what();
    const std::size_t prefix = what.find("] ");
    throw RecordingFolderError(fmt::format(
        "{}: {}", path, what.substr(prefix == std::string_view::npos ? 0 : prefix + 2)));
  }
}

void check_format_version(const Value& root) {
  const Value format = root.at("format_version");
  const bool is_newer = format.json().is_number_unsigned() &&
                        format.json().get<std::uint64_t>() > std::uint64_t{kRecordingFormatVersion};
  if (is_newer) {
    const std::string writer = root.has("version") ? root.at("version").text() : "";
    format.fail(
        fmt::format("at most {}; {}", kRecordingFormatVersion, advice_on_newer_format(writer)));
  }
  format.whole(1, kRecordingFormatVersion);
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
               {"planned",
                {{"pipelines", description.planned.pipelines},
                 {"first_seed", description.planned.first_seed},
                 {"seeds", description.planned.seeds}}},
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
  if (!std::filesystem::exists(path, error)) {
    throw RecordingFolderError(fmt::format(
        "{}: is no recording, it has no manifest.json; `simbench record` makes one", folder));
  }
  if (std::filesystem::exists(folder + "/results.json", error)) {
    throw RecordingFolderError(fmt::format(
        "{}: is the archive of a run, and no recording; `simbench record` makes one", folder));
  }
  try {
    return parse_manifest(file_content(path, kLargestManifest, Pipes::kRefused), path);
  } catch (const FileError& failure) {
    throw RecordingFolderError(fmt::format("{}: cannot be read: {}", path, failure.what()));
  }
}

std::string capture_folder(const std::string& folder, const std::string& pipeline,
                           std::uint64_t seed) {
  return fmt::format("{}/{}/{}", folder, file_name(pipeline), seed);
}

RecordingManifest parse_manifest(const std::string& text, const std::string& path) {
  const Json document = parsed(text, path);
  const Value root(document, "", path);
  if (root.at("format").text() != kRecordingFormat) {
    root.at("format").fail(fmt::format("'{}'", kRecordingFormat));
  }
  check_format_version(root);
  RecordingManifest manifest;
  manifest.description.backend = root.at("backend").text();
  manifest.description.hosts = names_of(root.at("hosts"), kMostHosts);
  manifest.description.cameras = names_of(root.at("cameras"), kMostCameras);
  // Earlier recordings lack it.
  if (root.has("planned")) manifest.description.planned = planned_of(root.at("planned"));
  const Value scenario = root.at("scenario");
  if (!scenario.json().is_null()) {
    if (!scenario.json().is_object()) scenario.fail("an object, null");
    manifest.description.scenario_json =
        scenario.json().dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  }
  const Value captures = root.at("captures");
  const std::size_t count = captures.size(1'000'000);
  std::set<std::pair<std::string, std::uint64_t>> known;
  for (std::size_t i = 0; i < count; ++i) {
    const Value capture = captures.at(i);
    manifest.captures.push_back(capture_of(capture));
    const RecordedCapture& read = manifest.captures.back();
    if (!known.emplace(read.pipeline, read.seed).second) {
      capture.at("seed").fail("each pipeline and seed once");
    }
  }
  return manifest;
}

}  // namespace simbench
