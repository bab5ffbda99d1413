#include "bags/bag_scan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "bags/camera_topics.h"
#include "bags/fields.h"
#include "bags/frame_track.h"
#include "recording/counted.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr std::size_t kHeaderHead = 512;
constexpr std::size_t kMetadataHead = 8192;
constexpr std::size_t kMostDevices = 64;

// Collects what the messages of a bag say.
class Scanner final : public BagSink {
 public:
  explicit Scanner(const ScanOptions& options) : options_(options) {}

  std::size_t on_topic(std::uint32_t number, const BagTopic& topic) override;
  void on_message(const BagMessage& message) override;

  std::vector<TopicScan>& topics() { return topics_; }
  std::vector<FrameTrack>& tracks() { return tracks_; }
  std::vector<std::string> devices() const;
  // Messages of a camera's topic that are no such messages.
  std::uint64_t unreadable() const { return unreadable_; }

 private:
  struct Known {
    CameraTopic camera{};
    std::map<std::string, std::size_t, std::less<>> tracks{};  // by frame id
    std::size_t last_track = 0;
    std::string last_frame_id{};
  };

  bool is_chosen(const BagTopic& topic, const CameraTopic& camera) const;
  void take_headed(const BagMessage& message);
  void take_ros_metadata(const BagMessage& message, FieldBytes& fields, FrameTrack& track);
  void take_sdk_metadata(const BagMessage& message);
  void take_info(const BagMessage& message);
  FrameTrack& track_of(std::uint32_t topic, std::string_view frame_id);
  FrameTrack& sdk_track(const std::string& base);

  const ScanOptions& options_;
  std::vector<TopicScan> topics_;
  std::vector<Known> known_;
  std::vector<FrameTrack> tracks_;
  std::map<std::string, std::size_t> sdk_tracks_;  // by base
  std::map<std::string, std::map<std::string, std::string>> info_;
  std::uint64_t unreadable_ = 0;
};

bool Scanner::is_chosen(const BagTopic& topic, const CameraTopic& camera) const {
  if (options_.topics.empty()) return true;
  if (camera.kind == TopicKind::kSdkInfo) return true;
  return std::ranges::any_of(options_.topics, [&](const std::string& name) {
    return name == topic.name || (camera.kind == TopicKind::kSdkMetadata &&
                                  camera_topic({.name = name}).base == camera.base);
  });
}

std::size_t Scanner::on_topic(std::uint32_t /*number*/, const BagTopic& topic) {
  CameraTopic camera = camera_topic(topic);
  // A topic that is named is believed to begin with a header.
  const bool named = std::ranges::find(options_.topics, topic.name) != options_.topics.end();
  if (named && camera.kind == TopicKind::kOther) camera = {TopicKind::kImage, topic.name};
  if (!is_chosen(topic, camera)) camera = {};
  if (topic.encoding == Encoding::kOther && camera.kind != TopicKind::kOther) camera = {};
  topics_.push_back({.topic = topic, .is_camera = camera.kind != TopicKind::kOther});
  known_.push_back({.camera = camera});
  switch (camera.kind) {
    case TopicKind::kOther:
      return options_.all_topics ? 0 : kLeaveOut;
    case TopicKind::kMetadata:
      return kMetadataHead;
    default:
      return kHeaderHead;
  }
}

void Scanner::on_message(const BagMessage& message) {
  TopicScan& scan = topics_[message.topic];
  if (scan.messages == 0) {
    scan.first = message.log_time;
  } else if (message.log_time - scan.last > scan.longest_gap) {
    scan.longest_gap = message.log_time - scan.last;
    scan.gap_at = scan.last;
  }
  scan.last = message.log_time;
  ++scan.messages;
  scan.bytes += message.size;
  switch (known_[message.topic].camera.kind) {
    case TopicKind::kOther:
      return;
    case TopicKind::kSdkMetadata:
      return take_sdk_metadata(message);
    case TopicKind::kSdkInfo:
      return take_info(message);
    default:
      return take_headed(message);
  }
}

FrameTrack& Scanner::track_of(std::uint32_t topic, std::string_view frame_id) {
  Known& known = known_[topic];
  if (!known.tracks.empty() && known.last_frame_id == frame_id) return tracks_[known.last_track];
  const auto found = known.tracks.find(frame_id);
  if (found == known.tracks.end()) {
    known.last_track = tracks_.size();
    known.tracks.emplace(std::string(frame_id), tracks_.size());
    tracks_.push_back({.topic = topic,
                       .camera = known.camera,
                       .topic_name = topics_[topic].topic.name,
                       .frame_id = std::string(frame_id)});
  } else {
    known.last_track = found->second;
  }
  known.last_frame_id = std::string(frame_id);
  return tracks_[known.last_track];
}

FrameTrack& Scanner::sdk_track(const std::string& base) {
  const auto [found, is_new] = sdk_tracks_.try_emplace(base, tracks_.size());
  if (is_new) {
    FrameTrack& added = tracks_.emplace_back();
    added.camera.kind = TopicKind::kSdkImage;
    added.camera.base = base;
    added.topic_name = base + "/image/data";
  }
  return tracks_[found->second];
}

void Scanner::take_headed(const BagMessage& message) {
  const TopicScan& scan = topics_[message.topic];
  const CameraTopic& camera = known_[message.topic].camera;
  FieldBytes fields(message.head, scan.topic.encoding);
  const MessageHeader header = read_header(fields);
  if (!fields.ok()) {
    ++unreadable_;
    return;
  }
  const bool sdk = camera.kind == TopicKind::kSdkImage;
  FrameTrack& track = sdk ? sdk_track(camera.base) : track_of(message.topic, header.frame);
  const std::int64_t log_ns = message.log_time.count();
  // Metadata may have come first.
  const bool begun = sdk && !track.frames.empty() && track.frames.back().log_ns == log_ns &&
                     track.frames.back().message == kNoMessage;
  if (!begun) track.frames.push_back({.log_ns = log_ns});
  RawFrame& frame = track.frames.back();
  frame.message = scan.messages - 1;
  frame.header_ns = header.stamp.count();
  if (header.sequence && frame.counter == kNoStamp) frame.counter = *header.sequence;
  if (camera.kind == TopicKind::kMetadata) take_ros_metadata(message, fields, track);
}

void Scanner::take_ros_metadata(const BagMessage& /*message*/, FieldBytes& fields,
                                FrameTrack& track) {
  const std::string_view text = fields.text();
  const nlohmann::json values = nlohmann::json::parse(text, nullptr, false);
  if (!fields.ok() || !values.is_object()) {
    ++unreadable_;
    return;
  }
  RawFrame& frame = track.frames.back();
  // The camera's count where there is one, else the SDK's.
  for (const char* name : {"frame_number", "frame_counter", "sensor_timestamp", "hw_timestamp"}) {
    const auto value = values.find(name);
    if (value != values.end() && value->is_number_integer()) {
      frame.set(name, value->get<std::int64_t>());
    }
  }
  const auto domain = values.find("clock_domain");
  if (track.domain.empty() && domain != values.end() && domain->is_string()) {
    track.domain = domain->get<std::string>();
  }
}

void Scanner::take_sdk_metadata(const BagMessage& message) {
  FieldBytes fields(message.head, Encoding::kRos1);
  const std::string_view key = fields.text();
  const std::string_view value = fields.text();
  if (!fields.ok()) {
    ++unreadable_;
    return;
  }
  FrameTrack& track = sdk_track(known_[message.topic].camera.base);
  const std::int64_t log_ns = message.log_time.count();
  if (track.frames.empty() || track.frames.back().log_ns != log_ns) {
    track.frames.push_back({.log_ns = log_ns});
  }
  if (key == "timestamp_domain" && track.domain.empty()) track.domain = std::string(value);
  if (const auto number = whole_number(value)) track.frames.back().set(key, *number);
}

void Scanner::take_info(const BagMessage& message) {
  FieldBytes fields(message.head, Encoding::kRos1);
  const std::string key(fields.text());
  const std::string value(fields.text());
  if (!fields.ok() || info_.size() > kMostDevices) return;
  if (key != "Name" && key != "Serial Number") return;
  info_[known_[message.topic].camera.base][key] = printable_name(value);
}

std::vector<std::string> Scanner::devices() const {
  std::vector<std::string> texts;
  for (const auto& [base, values] : info_) {
    const auto value = [&values = values](const char* key) {
      const auto found = values.find(key);
      return found == values.end() ? std::string("unknown") : found->second;
    };
    texts.push_back(fmt::format("{}, serial number {}", value("Name"), value("Serial Number")));
  }
  return texts;
}

// Makes streams of tracks: one for each base, named.
class StreamMaker {
 public:
  StreamMaker(const std::string& path, const std::string& name, const ScanOptions& options,
              BagScan& scan)
      : path_(path), name_(name), options_(options), scan_(scan) {}

  void make(std::vector<FrameTrack>& tracks) {
    drop_empty(tracks);
    join_publishers(tracks);
    leave_out_copies(tracks);
    for (const FrameTrack& track : tracks) {
      RecordedStream stream;
      if (!make_stream(track, path_, stream, scan_.notes)) continue;
      point_to_images(track, stream);
      names_.push_back(named(track));
      scan_.streams.push_back(std::move(stream));
    }
    name_streams();
  }

 private:
  static void drop_empty(std::vector<FrameTrack>& tracks) {
    for (FrameTrack& track : tracks) {
      std::erase_if(track.frames, [](const RawFrame& f) { return f.message == kNoMessage; });
    }
    std::erase_if(tracks, [](const FrameTrack& track) { return track.frames.empty(); });
  }

  // A publisher that begins where another one of its topic ended is the same, restarted.
  void join_publishers(std::vector<FrameTrack>& tracks) {
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      for (std::size_t j = i + 1; j < tracks.size(); ++j) {
        FrameTrack& a = tracks[i];
        FrameTrack& b = tracks[j];
        if (a.topic_name != b.topic_name) continue;
        if (a.frame_id == b.frame_id && a.frames.back().log_ns <= b.frames.front().log_ns) {
          a.frames.insert(a.frames.end(), b.frames.begin(), b.frames.end());
          tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(j--));
          continue;
        }
        if (!shared_.insert(a.topic_name).second) continue;
        scan_.notes.push_back(fmt::format(
            "{}: {}: several cameras write this topic ({}); each is a stream of its own", path_,
            printable_name(a.topic_name),
            a.frame_id == b.frame_id ? std::string("publishers of one frame id")
                                     : fmt::format("frame ids {} and {}", quoted_bytes(a.frame_id),
                                                   quoted_bytes(b.frame_id))));
      }
    }
  }

  // The topics of a stream that are not the best, copies of other streams, and what only repeats
  // the stamps of a camera's images.
  void leave_out_copies(std::vector<FrameTrack>& tracks) {
    if (!options_.topics.empty()) return;
    std::map<std::string, std::pair<int, std::uint32_t>> best;  // rank and topic, by base
    for (const FrameTrack& track : tracks) {
      if (is_derived(track.camera.base)) continue;
      const auto candidate = std::pair(track.camera.rank, track.topic);
      const auto [found, is_new] = best.try_emplace(track.camera.base, candidate);
      if (!is_new) found->second = std::min(found->second, candidate);
    }
    std::vector<FrameTrack> kept;
    for (FrameTrack& track : tracks) {
      const auto found = best.find(track.camera.base);
      const bool speaks = found != best.end() && found->second.second == track.topic;
      if (speaks && !(is_secondary(track) && has_images(track, tracks))) {
        kept.push_back(std::move(track));
      } else {
        left_out_.push_back(std::move(track));
      }
    }
    tracks = std::move(kept);
    std::vector<std::string> names;
    for (const FrameTrack& track : left_out_) names.push_back(printable_name(track.topic_name));
    if (names.empty()) return;
    scan_.notes.push_back(
        fmt::format("{}: left out, since other topics have the stamps of the same frames: {} "
                    "(--topics chooses)",
                    path_, fmt::join(names, ", ")));
  }

  static bool is_secondary(const FrameTrack& track) {
    return track.camera.kind == TopicKind::kPoints || track.camera.kind == TopicKind::kCameraInfo;
  }
  static bool has_images(const FrameTrack& track, const std::vector<FrameTrack>& tracks) {
    return std::ranges::any_of(tracks, [&track](const FrameTrack& other) {
      if (is_secondary(other)) return false;
      const std::string camera = "/" + camera_of(other.camera).camera;
      return (track.camera.base + "/").starts_with(camera + "/");
    });
  }

  // A stream of metadata: its frames are the images with the same header stamps.
  void point_to_images(const FrameTrack& track, RecordedStream& stream) const {
    if (track.camera.kind != TopicKind::kMetadata) return;
    const FrameTrack* images = nullptr;
    for (const FrameTrack& other : left_out_) {
      if (other.camera.base != track.camera.base || other.camera.kind != TopicKind::kImage)
        continue;
      if (images == nullptr || other.camera.rank < images->camera.rank) images = &other;
    }
    if (images == nullptr) return;
    std::map<std::int64_t, std::uint64_t> by_stamp;
    for (const RawFrame& frame : images->frames) by_stamp.emplace(frame.header_ns, frame.message);
    std::map<std::uint64_t, std::int64_t> stamps;
    for (const RawFrame& frame : track.frames) stamps.emplace(frame.message, frame.header_ns);
    for (std::uint64_t& message : stream.origin.messages) {
      const auto found = by_stamp.find(stamps.at(message));
      message = found == by_stamp.end() ? kNoMessage : found->second;
    }
    stream.origin.topic = images->topic_name;
  }

  NamedStream named(const FrameTrack& track) const {
    NamedStream name = camera_of(track.camera);
    if (shared_.contains(track.topic_name)) {
      name.camera += fmt::format(
          "{}{}", name.camera.empty() ? "" : " ",
          track.frame_id.empty() ? fmt::format("publisher {}", track.topic) : track.frame_id);
    }
    return name;
  }

  // A bag of one camera is that camera: its file has the better name. Two streams never share both
  // names.
  void name_streams() {
    std::set<std::string> cameras;
    for (const NamedStream& name : names_) cameras.insert(name.camera);
    std::map<std::string, int> uses;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      RecordedStream& stream = scan_.streams[i];
      const std::string& own = names_[i].camera;
      stream.camera = cameras.size() == 1 || own.empty() ? name_ : own;
      stream.camera = printable_name(stream.camera);
      stream.stream = printable_name(names_[i].stream);
      stream.host = printable_name(name_);
      if (const int use = ++uses[stream.camera + "\n" + stream.stream]; use > 1) {
        stream.stream += fmt::format(" ({})", use);
      }
    }
  }

  const std::string& path_;
  const std::string& name_;
  const ScanOptions& options_;
  BagScan& scan_;
  std::set<std::string> shared_;
  std::vector<FrameTrack> left_out_;
  std::vector<NamedStream> names_;
};

void check_topics(const std::string& path, const ScanOptions& options, const BagScan& scan) {
  for (const std::string& name : options.topics) {
    const auto found = std::ranges::find_if(
        scan.topics, [&name](const TopicScan& topic) { return topic.topic.name == name; });
    if (found == scan.topics.end()) {
      throw BagError(fmt::format("{}: --topics: found no {} in it (simbench inspect lists them)",
                                 path, quoted_bytes(name)));
    }
    if (!found->is_camera) {
      throw BagError(
          fmt::format("{}: --topics: {} has messages whose serialisation is not read, allowed: "
                      "those of ROS 1 and CDR",
                      path, quoted_bytes(name)));
    }
  }
}

}  // namespace

double TopicScan::rate_hz() const {
  const double span_s = to_seconds(last - first);
  return messages < 2 || !(span_s > 0) ? 0 : static_cast<double>(messages - 1) / span_s;
}

void TopicScan::append(const TopicScan& next) {
  if (messages == 0) {
    *this = next;
    return;
  }
  const auto take_gap = [this](Nanoseconds gap, Nanoseconds at) {
    if (gap <= longest_gap) return;
    longest_gap = gap;
    gap_at = at;
  };
  take_gap(next.first - last, last);
  take_gap(next.longest_gap, next.gap_at);
  last = next.last;
  messages += next.messages;
  bytes += next.bytes;
}

BagScan scan_bag(const std::string& path, const std::string& name, const ScanOptions& options,
                 const ReadProgress& progress) {
  BagScan scan;
  Scanner scanner(options);
  scan.facts = read_bag(path, scanner, progress);
  scan.topics = std::move(scanner.topics());
  scan.devices = scanner.devices();
  scan.notes = scan.facts.notes;
  check_topics(path, options, scan);
  if (scanner.unreadable() > 0) {
    scan.notes.push_back(fmt::format("{}: {} of its cameras' topics left out: no such message",
                                     path, counted(scanner.unreadable(), "message")));
  }
  StreamMaker(path, name, options, scan).make(scanner.tracks());
  return scan;
}

}  // namespace simbench::bags
