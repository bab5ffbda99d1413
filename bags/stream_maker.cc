#include "bags/stream_maker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "bags/camera_topics.h"
#include "recording/counted.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr std::size_t kMostNamesSaid = 30;

bool is_secondary(const FrameTrack& track) {
  return track.camera.kind == TopicKind::kPoints || track.camera.kind == TopicKind::kCameraInfo;
}

void drop_empty(std::vector<FrameTrack>& tracks) {
  for (FrameTrack& track : tracks) {
    std::erase_if(track.frames, [](const RawFrame& f) { return f.message == kNoMessage; });
  }
  std::erase_if(tracks, [](const FrameTrack& track) { return track.frames.empty(); });
}

class StreamMaker {
 public:
  StreamMaker(const StreamNames& names, BagScan& scan) : of_(names), scan_(scan) {}

  void make(std::vector<FrameTrack>& tracks) {
    drop_empty(tracks);
    join_publishers(tracks);
    if (!of_.all_chosen) leave_out_copies(tracks);
    for (FrameTrack& track : tracks) {
      RecordedStream stream;
      if (!make_stream(track, of_.path, stream, scan_.notes)) continue;
      point_to_images(track, stream);
      track.frames = {};
      names_.push_back(named(track));
      scan_.streams.push_back(std::move(stream));
    }
    name_streams();
    note_missing_numbers(tracks);
  }

 private:
  using Tracks = std::vector<FrameTrack>;

  void join_publishers(Tracks& tracks);
  void join_topic(Tracks& tracks, std::vector<std::size_t>& of_topic);
  void leave_out_copies(Tracks& tracks);
  void note_left_out();
  void point_to_images(const FrameTrack& track, RecordedStream& stream) const;
  void note_missing_numbers(const Tracks& tracks);
  NamedStream named(const FrameTrack& track) const;
  void name_streams();

  const StreamNames& of_;
  BagScan& scan_;
  std::set<std::string> shared_{};
  Tracks left_out_{};
  std::vector<NamedStream> names_{};
};

void StreamMaker::join_publishers(Tracks& tracks) {
  std::map<std::string, std::vector<std::size_t>> by_topic;
  for (std::size_t i = 0; i < tracks.size(); ++i) by_topic[tracks[i].topic_name].push_back(i);
  for (auto& [name, of_topic] : by_topic) {
    if (of_topic.size() > 1) join_topic(tracks, of_topic);
  }
  drop_empty(tracks);
}

// A publisher that begins where another one of its topic and frame id ended is the same, restarted.
void StreamMaker::join_topic(Tracks& tracks, std::vector<std::size_t>& of_topic) {
  std::ranges::stable_sort(of_topic, {},
                           [&tracks](std::size_t i) { return tracks[i].frames.front().log_ns; });
  std::map<std::string, std::vector<std::size_t>> by_frame_id;  // those that others go on from
  for (const std::size_t i : of_topic) {
    FrameTrack& track = tracks[i];
    std::vector<std::size_t>& begun = by_frame_id[track.frame_id];
    const auto before = std::ranges::find_if(begun, [&](std::size_t other) {
      return tracks[other].frames.back().log_ns <= track.frames.front().log_ns;
    });
    if (before == begun.end()) {
      begun.push_back(i);
      continue;
    }
    std::vector<RawFrame>& frames = tracks[*before].frames;
    frames.insert(frames.end(), track.frames.begin(), track.frames.end());
    track.frames = {};
  }
  std::vector<std::string> cameras;
  for (const auto& [frame_id, begun] : by_frame_id) {
    cameras.insert(cameras.end(), begun.size(), frame_id);
  }
  if (cameras.size() < 2) return;
  const std::string& topic = tracks[of_topic.front()].topic_name;
  shared_.insert(topic);
  scan_.notes.push_back(fmt::format(
      "{}: {}: several cameras write this topic ({}); each is a stream of its own", of_.path,
      printable_name(topic),
      cameras[0] == cameras[1] ? std::string("publishers of one frame id")
                               : fmt::format("frame ids {} and {}", quoted_bytes(cameras[0]),
                                             quoted_bytes(cameras[1]))));
}

// The topics of a stream that are not the best, copies of other streams, and what only repeats the
// stamps of a camera's images.
void StreamMaker::leave_out_copies(Tracks& tracks) {
  std::map<std::string, std::tuple<int, std::uint32_t, std::string>> best;  // rank, topic; by base
  std::set<std::string> with_images;
  for (const FrameTrack& track : tracks) {
    if (!is_secondary(track))
      with_images.insert(std::string("/").append(camera_of(track.camera).camera));
    if (is_derived(track.camera.base)) continue;
    const auto candidate = std::tuple(track.camera.rank, track.topic, track.topic_name);
    const auto [found, is_new] = best.try_emplace(track.camera.base, candidate);
    if (!is_new) found->second = std::min(found->second, candidate);
  }
  // Its own camera, or the one that its name lies below.
  const auto has_images = [&with_images](const std::string& base) {
    for (std::size_t end = base.size(); end > 0 && end != std::string::npos;
         end = base.rfind('/', end - 1)) {
      if (with_images.contains(base.substr(0, end))) return true;
    }
    return false;
  };
  Tracks kept;
  for (FrameTrack& track : tracks) {
    const auto found = best.find(track.camera.base);
    const bool speaks = found != best.end() && std::get<2>(found->second) == track.topic_name;
    const bool repeats = is_secondary(track) && has_images(track.camera.base);
    (speaks && !repeats ? kept : left_out_).push_back(std::move(track));
  }
  tracks = std::move(kept);
  note_left_out();
}

void StreamMaker::note_left_out() {
  if (left_out_.empty()) return;
  std::vector<std::string> names;
  for (const FrameTrack& track : left_out_) {
    if (names.size() == kMostNamesSaid) break;
    names.push_back(printable_name(track.topic_name));
  }
  if (left_out_.size() > names.size()) names.emplace_back("...");
  scan_.notes.push_back(
      fmt::format("{}: left out, since other topics have the stamps of the same frames: {} "
                  "(--topics chooses)",
                  of_.path, fmt::join(names, ", ")));
}

// A stream of metadata: its frames are the images with the same header stamps.
void StreamMaker::point_to_images(const FrameTrack& track, RecordedStream& stream) const {
  if (track.camera.kind != TopicKind::kMetadata) return;
  const FrameTrack* images = nullptr;
  for (const FrameTrack& other : left_out_) {
    if (other.camera.base != track.camera.base || other.camera.kind != TopicKind::kImage) continue;
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

void StreamMaker::note_missing_numbers(const Tracks& tracks) {
  std::set<std::uint32_t> said;
  for (const FrameTrack& track : tracks) {
    if (track.topic >= scan_.topics.size() || !said.insert(track.topic).second) continue;
    const TopicScan& topic = scan_.topics[track.topic];
    if (topic.missing_numbers == 0) continue;
    scan_.notes.push_back(
        fmt::format("{}: {}: {} missing: messages that were published and not recorded", of_.path,
                    printable_name(topic.topic.name),
                    topic.missing_numbers == 1
                        ? "1 number of header.seq is"
                        : fmt::format("{} numbers of header.seq are", topic.missing_numbers)));
  }
}

NamedStream StreamMaker::named(const FrameTrack& track) const {
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
void StreamMaker::name_streams() {
  std::set<std::string> cameras;
  for (const NamedStream& name : names_) cameras.insert(name.camera);
  std::map<std::string, int> uses;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    RecordedStream& stream = scan_.streams[i];
    const std::string& own = names_[i].camera;
    stream.camera = cameras.size() == 1 || own.empty() ? of_.name : own;
    stream.camera = printable_name(stream.camera);
    stream.stream = printable_name(names_[i].stream);
    stream.host = printable_name(of_.name);
    if (const int use = ++uses[stream.camera + "\n" + stream.stream]; use > 1) {
      stream.stream += fmt::format(" ({})", use);
    }
  }
}

}  // namespace

void make_streams(std::vector<FrameTrack>& tracks, const StreamNames& names, BagScan& scan) {
  StreamMaker(names, scan).make(tracks);
}

}  // namespace simbench::bags
