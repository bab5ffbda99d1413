// The reading half of recording_manifest.h.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "recording/recording_manifest.h"
#include "recording/text_fields.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;

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
  Value at(std::size_t index) const {
    return {json_[index], fmt::format("{}/{}", pointer_, index), path_};
  }
  // Of an array.
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

}  // namespace

RecordingManifest parse_manifest(const std::string& text, const std::string& path) {
  const Json document = parsed(text, path);
  const Value root(document, "", path);
  if (root.at("format").text() != kRecordingFormat) {
    root.at("format").fail(fmt::format("'{}'", kRecordingFormat));
  }
  root.at("format_version").whole(kRecordingFormatVersion, kRecordingFormatVersion);
  RecordingManifest manifest;
  manifest.description.backend = root.at("backend").text();
  manifest.description.hosts = root.at("hosts").texts(kMostHosts);
  manifest.description.cameras = root.at("cameras").texts(kMostCameras);
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
