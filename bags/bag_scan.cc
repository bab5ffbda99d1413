#include "bags/bag_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bags/camera_topics.h"
#include "bags/fields.h"
#include "bags/foxglove.h"
#include "bags/frame_track.h"
#include "bags/message_types.h"
#include "bags/stream_maker.h"
#include "recording/counted.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr std::size_t kHeaderHead = 512;
constexpr std::size_t kMetadataHead = 8192;
constexpr std::size_t kMostNamesGiven = 30;
constexpr std::size_t kMostDevices = 64;

// The places of one publisher's messages among all of its topic.
class PlacesInTopic {
 public:
  // `own`: the number among the publisher's messages. Called for each of them.
  void add(std::uint64_t own, std::uint64_t of_topic) {
    if (others_.empty() && own == of_topic) return;
    if (others_.empty()) alone_ = own;
    others_.push_back(of_topic);
  }
  std::uint64_t of(std::uint64_t own) const {
    return own < alone_ ? own : others_[static_cast<std::size_t>(own - alone_)];
  }

 private:
  std::uint64_t alone_ = std::numeric_limits<std::uint64_t>::max();  // as long as nobody else wrote
  std::vector<std::uint64_t> others_{};
};

// Collects what the messages of a bag say.
class Scanner final : public BagSink {
 public:
  Scanner(const std::string& path, const ScanOptions& options) : path_(path), options_(options) {}

  std::size_t on_topic(std::uint32_t number, const BagTopic& topic) override;
  void on_message(const BagMessage& message) override;

  std::vector<TopicScan>& topics() { return topics_; }
  std::vector<FrameTrack>& tracks() { return tracks_; }
  // Sorts by time of arrival, once, after the last message.
  void conclude();
  std::vector<std::string> devices() const;
  std::vector<std::string> notes() const;

 private:
  struct Known {
    CameraTopic camera{};
    TopicArrivals arrivals{};
    PlacesInTopic places{};
    std::uint64_t* messages_of_name = nullptr;
    std::map<std::string, std::size_t, std::less<>> tracks{};  // by frame id
    std::size_t last_track = 0;
    std::string last_frame_id{};
    bool is_one = false;  // it has too many frame ids
  };

  void expect_header(const BagTopic& topic) const;
  bool is_chosen(const BagTopic& topic, const CameraTopic& camera) const;
  void take_headed(const BagMessage& message);
  void take_ros_metadata(const BagMessage& message, FieldBytes& fields, FrameTrack& track);
  void take_sdk_metadata(const BagMessage& message);
  void take_info(const BagMessage& message);
  // Null beyond the limit.
  FrameTrack* track_of(std::uint32_t topic, std::string_view frame_id);
  FrameTrack* new_track(std::uint32_t topic, std::string_view frame_id);
  FrameTrack* take_as_one(Known& known);
  FrameTrack* sdk_track(const std::string& base);

  const std::string& path_;
  const ScanOptions& options_;
  std::vector<TopicScan> topics_;
  std::vector<Known> known_;
  std::map<std::string, std::uint64_t> messages_of_names_;  // of all publishers
  std::vector<FrameTrack> tracks_;
  std::map<std::string, std::size_t> sdk_tracks_;  // by base
  std::map<std::string, std::map<std::string, std::string>> info_;
  std::uint64_t unreadable_ = 0;  // messages of a camera's topic that are no such messages
  std::uint64_t beyond_ = 0;      // messages, for which there was no track
};

// Nothing for what is no such message. `fields` stand behind it then.
std::optional<MessageHeader> header_of(std::string_view head, const BagTopic& topic,
                                       FieldBytes& fields) {
  MessageHeader header;
  if (is_foxglove(topic.type)) {
    const std::optional<Nanoseconds> stamp = foxglove_stamp(head, topic.encoding);
    if (!stamp) return std::nullopt;
    header.stamp = *stamp;
    return header;
  }
  header = read_header(fields);
  return fields.ok() ? std::optional(header) : std::nullopt;
}

// A topic that a user named, and that is no camera's by its type.
void Scanner::expect_header(const BagTopic& topic) const {
  if (topic.headed == Headed::kYes) return;
  const bool is_read = topic.encoding == Encoding::kRos1 || topic.encoding == Encoding::kCdr;
  throw BagError(
      fmt::format("{}: --topics: {}: found {}, {}; allowed: topics whose messages begin with a "
                  "std_msgs/Header, "
                  "or of Foxglove's images (simbench inspect lists the topics){}",
                  path_, printable_name(topic.name),
                  topic.type.empty() ? "an unknown type" : printable_name(topic.type),
                  !is_read                      ? "whose serialisation is not read"
                  : topic.headed == Headed::kNo ? "which has no header"
                                                : "whose definition is not in the bag",
                  is_read && topic.headed == Headed::kUnknown
                      ? ". MCAP and recorders since ROS 2 Iron write definitions"
                      : ""));
}

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
  const bool named = std::ranges::find(options_.topics, topic.name) != options_.topics.end();
  if (named && camera.kind == TopicKind::kOther) {
    expect_header(topic);
    camera = {TopicKind::kImage, topic.name};
  }
  if (!is_chosen(topic, camera)) camera = {};
  topics_.push_back({.topic = topic, .is_camera = camera.kind != TopicKind::kOther});
  known_.push_back({.camera = camera, .messages_of_name = &messages_of_names_[topic.name]});
  switch (camera.kind) {
    case TopicKind::kOther:
      return options_.all_topics ? TopicArrivals::kCompared : kLeaveOut;
    case TopicKind::kMetadata:
      return kMetadataHead;
    default:
      return topic.encoding == Encoding::kJson ? kMetadataHead : kHeaderHead;
  }
}

void Scanner::on_message(const BagMessage& message) {
  topics_[message.topic].bytes += message.size;
  Known& known = known_[message.topic];
  known.places.add(known.arrivals.size(), (*known.messages_of_name)++);
  known.arrivals.add(message);
  switch (known.camera.kind) {
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

FrameTrack* Scanner::track_of(std::uint32_t topic, std::string_view frame_id) {
  Known& known = known_[topic];
  if (known.is_one || (!known.tracks.empty() && known.last_frame_id == frame_id)) {
    return &tracks_[known.last_track];
  }
  const auto found = known.tracks.find(frame_id);
  if (found == known.tracks.end()) return new_track(topic, frame_id);
  known.last_track = found->second;
  known.last_frame_id = std::string(frame_id);
  return &tracks_[known.last_track];
}

FrameTrack* Scanner::new_track(std::uint32_t topic, std::string_view frame_id) {
  Known& known = known_[topic];
  if (known.tracks.size() == kMostFrameIds) return take_as_one(known);
  if (tracks_.size() == kMostTracks) return nullptr;
  known.last_track = tracks_.size();
  known.last_frame_id = std::string(frame_id);
  known.tracks.emplace(known.last_frame_id, tracks_.size());
  return &tracks_.emplace_back(FrameTrack{.topic = topic,
                                          .camera = known.camera,
                                          .topic_name = topics_[topic].topic.name,
                                          .frame_id = known.last_frame_id});
}

// A frame id that changes with the messages is no camera's name.
FrameTrack* Scanner::take_as_one(Known& known) {
  known.is_one = true;
  known.last_track = known.tracks.begin()->second;
  std::vector<RawFrame>& frames = tracks_[known.last_track].frames;
  for (const auto& [frame_id, number] : known.tracks) {
    if (number == known.last_track) continue;
    std::vector<RawFrame>& others = tracks_[number].frames;
    frames.insert(frames.end(), others.begin(), others.end());
    others = {};
  }
  return &tracks_[known.last_track];
}

std::vector<std::string> Scanner::notes() const {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!known_[i].is_one) continue;
    notes.push_back(fmt::format(
        "{}: {}: found more than {} frame ids; its messages are taken to be one camera's", path_,
        printable_name(topics_[i].topic.name), kMostFrameIds));
  }
  if (unreadable_ > 0) {
    notes.push_back(fmt::format("{}: {} of its cameras' topics left out: no such message", path_,
                                counted(unreadable_, "message")));
  }
  if (beyond_ > 0) {
    notes.push_back(
        fmt::format("{}: {} left out: found more than {} topics and frame ids of cameras", path_,
                    counted(beyond_, "message"), kMostTracks));
  }
  return notes;
}

FrameTrack* Scanner::sdk_track(const std::string& base) {
  if (tracks_.size() == kMostTracks && !sdk_tracks_.contains(base)) return nullptr;
  const auto [found, is_new] = sdk_tracks_.try_emplace(base, tracks_.size());
  if (is_new) {
    FrameTrack& added = tracks_.emplace_back();
    added.camera.kind = TopicKind::kSdkImage;
    added.camera.base = base;
    added.topic_name = base + "/image/data";
  }
  return &tracks_[found->second];
}

// By log time; what a copy of a message said is left out.
void order_frames(FrameTrack& track, const TopicArrivals& arrivals) {
  std::vector<RawFrame>& frames = track.frames;
  std::erase_if(frames, [&arrivals](const RawFrame& f) { return arrivals.is_copy(f.message); });
  const auto order = [](const RawFrame& frame) { return std::pair(frame.log_ns, frame.message); };
  if (std::ranges::is_sorted(frames, {}, &RawFrame::log_ns)) return;
  std::ranges::sort(frames, {}, order);
  // Metadata of the SDK that stood away from its image.
  std::size_t kept = 0;
  for (const RawFrame& frame : frames) {
    if (kept > 0 && frame.message == kNoMessage && frames[kept - 1].log_ns == frame.log_ns) {
      frames[kept - 1].take_metadata(frame);
    } else {
      frames[kept++] = frame;
    }
  }
  frames.resize(kept);
}

void Scanner::conclude() {
  for (std::size_t i = 0; i < topics_.size(); ++i) known_[i].arrivals.conclude(topics_[i]);
  for (FrameTrack& track : tracks_) {
    const Known& known = known_[track.topic];
    order_frames(track, known.arrivals);
    for (RawFrame& frame : track.frames) {
      if (frame.message != kNoMessage) frame.message = known.places.of(frame.message);
    }
  }
}

void Scanner::take_headed(const BagMessage& message) {
  Known& known = known_[message.topic];
  const CameraTopic& camera = known.camera;
  const BagTopic& topic = topics_[message.topic].topic;
  FieldBytes fields(message.head, topic.encoding);
  const std::optional<MessageHeader> read = header_of(message.head, topic, fields);
  if (!read) {
    ++unreadable_;
    return;
  }
  const MessageHeader& header = *read;
  const bool sdk = camera.kind == TopicKind::kSdkImage;
  FrameTrack* found = sdk ? sdk_track(camera.base) : track_of(message.topic, header.frame);
  if (found == nullptr) {
    ++beyond_;
    return;
  }
  FrameTrack& track = *found;
  const std::int64_t log_ns = message.log_time.count();
  // Metadata may have come first.
  const bool begun = sdk && !track.frames.empty() && track.frames.back().log_ns == log_ns &&
                     track.frames.back().message == kNoMessage;
  if (!begun) track.frames.push_back({.log_ns = log_ns});
  RawFrame& frame = track.frames.back();
  frame.message = known.arrivals.size() - 1;
  frame.header_ns = header.stamp.count();
  if (header.sequence) {
    // The SDK writes the camera's count there; what publishes to ROS counts its own messages.
    if (!sdk) {
      known.arrivals.set_sequence(*header.sequence);
    } else if (frame.counter == kNoStamp) {
      frame.counter = *header.sequence;
    }
  }
  track.topic = message.topic;
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
  FrameTrack* found = sdk_track(known_[message.topic].camera.base);
  if (found == nullptr) {
    ++beyond_;
    return;
  }
  FrameTrack& track = *found;
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

void check_topics(const std::string& path, const ScanOptions& options, const BagScan& scan) {
  for (const std::string& name : options.topics) {
    const auto found = std::ranges::find_if(
        scan.topics, [&name](const TopicScan& topic) { return topic.topic.name == name; });
    if (found == scan.topics.end()) {
      throw BagError(fmt::format("{}: --topics: found no {} in it (simbench inspect lists them)",
                                 path, quoted_bytes(name)));
    }
  }
}

void note_order(const std::string& path, BagScan& scan) {
  std::uint64_t out_of_order = 0;
  std::uint64_t copies = 0;
  for (const TopicScan& topic : scan.topics) {
    out_of_order += topic.out_of_order;
    copies += topic.copies;
  }
  scan.facts.messages -= copies;
  if (out_of_order > 0) {
    scan.notes.push_back(fmt::format(
        "{}: {} out of order of their log times; they were sorted", path,
        out_of_order == 1 ? "1 message stands" : fmt::format("{} messages stand", out_of_order)));
  }
  if (copies > 0) {
    scan.notes.push_back(fmt::format(
        "{}: {} twice in it, with the same log time and content; each counts once", path,
        copies == 1 ? "1 message stands" : fmt::format("{} messages stand", copies)));
  }
}

}  // namespace

std::vector<std::string> headed_topics(const BagScan& scan) {
  std::vector<std::string> names;
  for (const TopicScan& topic : scan.topics) {
    if (names.size() == kMostNamesGiven) break;
    const bool is_new = std::ranges::find(names, topic.topic.name) == names.end();
    if (topic.topic.headed == Headed::kYes && is_new) names.push_back(topic.topic.name);
  }
  return names;
}

BagScan scan_bag(const std::string& path, const std::string& name, const ScanOptions& options,
                 const ReadProgress& progress) {
  BagScan scan;
  Scanner scanner(path, options);
  scan.facts = read_bag(path, scanner, progress);
  scanner.conclude();
  const std::vector<std::string> notes = scanner.notes();
  scan.topics = std::move(scanner.topics());
  scan.devices = scanner.devices();
  scan.notes = scan.facts.notes;
  check_topics(path, options, scan);
  note_order(path, scan);
  scan.notes.insert(scan.notes.end(), notes.begin(), notes.end());
  make_streams(scanner.tracks(),
               {.path = path, .name = name, .all_chosen = !options.topics.empty()}, scan);
  return scan;
}

}  // namespace simbench::bags
