#include "bags/recorded_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "bags/frame_track.h"
#include "bags/rosbag2_folder.h"
#include "bags/video_times.h"
#include "recording/text_fields.h"
#include "scenarios/input_file.h"

namespace simbench::bags {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTopicsShown = 30;

std::vector<std::string> files_of(const std::string& path,
                                  std::vector<std::string>* notes = nullptr) {
  return fs::is_directory(path) ? rosbag2_files(path, notes) : std::vector<std::string>{path};
}

// By arrival, whatever the order of the files was.
void sort_by_arrival(RecordedStream& stream) {
  std::vector<std::size_t> order(stream.frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return stream.frames[i].arrival; });
  const auto sort = [&order](auto& values) {
    auto sorted = values;
    for (std::size_t i = 0; i < values.size(); ++i) sorted[i] = values[order[i]];
    values = std::move(sorted);
  };
  sort(stream.frames);
  sort(stream.origin.messages);
  stream.columns.for_each(sort);
}

// Beside the frames, after these were joined.
void append_columns(RecordedStream& stream, const RecordedStream& next) {
  const std::size_t before = stream.frames.size() - next.frames.size();
  std::vector<std::vector<double>> added;
  FrameColumns columns = next.columns;
  columns.for_each([&added](std::vector<double>& column) { added.push_back(std::move(column)); });
  auto more = added.begin();
  stream.columns.for_each([&](std::vector<double>& column) {
    if (!column.empty() || !more->empty()) {
      column.resize(before, std::numeric_limits<double>::quiet_NaN());
      column.insert(column.end(), more->begin(), more->end());
    }
    ++more;
  });
  stream.complete_columns();
}

void append(RecordedStream& stream, const RecordedStream& next, std::uint64_t messages_before) {
  const bool goes_on = next.frames.front().arrival >= stream.frames.back().arrival;
  for (const std::uint64_t message : next.origin.messages) {
    stream.origin.messages.push_back(message == kNoMessage ? message : messages_before + message);
  }
  stream.frames.insert(stream.frames.end(), next.frames.begin(), next.frames.end());
  append_columns(stream, next);
  if (!goes_on) sort_by_arrival(stream);
  stream.counted = stream.counted && next.counted;
  if (stream.counted) return;
  for (std::size_t i = 0; i < stream.frames.size(); ++i) stream.frames[i].counter = i;
}

// The part of a recording that stands in its next file.
void append(BagScan& scan, BagScan next) {
  std::map<std::string, std::uint64_t> messages;  // of each topic, in the files so far
  for (const TopicScan& topic : scan.topics) {
    messages[topic.topic.name] += topic.messages + topic.copies;
  }
  for (RecordedStream& stream : next.streams) {
    const std::uint64_t before = messages[stream.origin.topic];
    const auto known = std::ranges::find_if(scan.streams, [&stream](const RecordedStream& s) {
      return s.camera == stream.camera && s.stream == stream.stream;
    });
    if (known != scan.streams.end()) {
      append(*known, stream, before);
      continue;
    }
    for (std::uint64_t& message : stream.origin.messages) {
      if (message != kNoMessage) message += before;
    }
    scan.streams.push_back(std::move(stream));
  }
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  for (std::size_t i = 0; i < scan.topics.size(); ++i) {
    places.emplace(std::pair(scan.topics[i].topic.name, scan.topics[i].topic.publisher), i);
  }
  for (TopicScan& topic : next.topics) {
    const auto known = places.find({topic.topic.name, topic.topic.publisher});
    if (known == places.end()) {
      scan.topics.push_back(std::move(topic));
    } else {
      scan.topics[known->second].append(topic);
    }
  }
  scan.notes.insert(scan.notes.end(), next.notes.begin(), next.notes.end());
  scan.facts.messages += next.facts.messages;
  scan.facts.lost_bytes += next.facts.lost_bytes;
  scan.facts.indexed = scan.facts.indexed && next.facts.indexed;
}

// What a bag without cameras has, and how its topics are read all the same.
[[noreturn]] void fail_without_cameras(const std::string& path, const BagScan& scan) {
  std::string topics;
  for (std::size_t i = 0; i < std::min(scan.topics.size(), kMostTopicsShown); ++i) {
    const BagTopic& topic = scan.topics[i].topic;
    topics += fmt::format("{}{} ({})", i > 0 ? ", " : "", printable_name(topic.name),
                          topic.type.empty() ? "unknown type" : printable_name(topic.type));
  }
  if (scan.topics.size() > kMostTopicsShown) topics += ", ...";
  std::vector<std::string> headed = headed_topics(scan);
  for (std::string& name : headed) name = printable_name(name);
  throw BagError(fmt::format("{}: found no frames of a camera; its topics: {}. {}", path, topics,
                             headed.empty()
                                 ? "None has messages that begin with a header"
                                 : fmt::format("Those whose messages begin with a header can be "
                                               "read: --topics {}",
                                               fmt::join(headed, ","))));
}

bool holds_video(const std::string& path) {
  if (!fs::is_regular_file(path)) return false;
  try {
    return is_video(path);
  } catch (const FileError& error) {
    throw BagError(path + ": cannot be read: " + error.what());
  }
}

}  // namespace

bool is_bag(const std::string& path) {
  if (fs::is_directory(path)) return is_rosbag2_folder(path);
  // A pipe may be a CSV; a bag is read from several places.
  if (fs::exists(path) && !fs::is_regular_file(path)) return false;
  try {
    return bag_format(path).has_value() || is_compressed_whole(path);
  } catch (const FileError& error) {
    throw BagError(path + ": cannot be read: " + error.what());
  }
}

std::uint64_t recording_bytes(const std::string& path) {
  std::uint64_t bytes = 0;
  for (const std::string& file : files_of(path)) {
    std::error_code none;
    const std::uintmax_t size = fs::file_size(file, none);
    if (!none) bytes += size;
  }
  return bytes;
}

void tell_apart(const std::vector<RecordedStreams*>& recordings,
                const std::vector<std::string>& names) {
  std::map<std::string, std::set<std::size_t>> users;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    for (const RecordedStream& stream : recordings[i]->streams) users[stream.camera].insert(i);
  }
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    for (RecordedStream& stream : recordings[i]->streams) {
      if (users[stream.camera].size() > 1) stream.camera = names[i] + "/" + stream.camera;
    }
  }
}

BagScan scan_recording(const std::string& path, const std::string& name, const ScanOptions& options,
                       const ReadProgress& progress) {
  std::optional<BagScan> all;
  const std::uint64_t total = recording_bytes(path);
  std::uint64_t before = 0;
  std::vector<std::string> notes;
  const std::vector<std::string> files = files_of(path, &notes);
  for (const std::string& file : files) {
    BagScan scan = scan_bag(file, name, options, [&](std::uint64_t done, std::uint64_t) {
      if (progress) progress(before + done, total);
    });
    before += recording_bytes(file);
    if (!all) {
      all = std::move(scan);
    } else {
      append(*all, std::move(scan));
    }
  }
  if (!all) throw BagError(path + ": found no bag in this folder");
  all->notes.insert(all->notes.begin(), notes.begin(), notes.end());
  if (files.size() > 1) {
    for (RecordedStream& stream : all->streams) stream.origin.file = path;
  }
  return std::move(*all);
}

RecordedStreams read_recorded_files(const std::vector<std::string>& files,
                                    const FileOptions& options, const ReadProgress& progress) {
  check_given_once(files);
  const std::vector<std::string> names = camera_names(files);
  std::uint64_t total = 0;
  for (const std::string& file : files) total += recording_bytes(file);
  std::uint64_t before = 0;
  CsvRecordingReader csv =
      options.columns ? CsvRecordingReader(*options.columns) : CsvRecordingReader();
  std::vector<RecordedStreams> recordings(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ReadProgress counted = [&](std::uint64_t done, std::uint64_t) {
      if (progress) progress(std::min(before + done, total), total);
    };
    if (is_bag(files[i])) {
      BagScan scan = scan_recording(files[i], names[i], {.topics = options.topics}, counted);
      if (scan.streams.empty()) fail_without_cameras(files[i], scan);
      recordings[i] = {std::move(scan.streams), std::move(scan.notes)};
    } else if (holds_video(files[i])) {
      recordings[i] = read_video(files[i], names[i], counted);
    } else {
      csv.read_file(files[i], names[i], counted);
    }
    before += recording_bytes(files[i]);
  }
  std::vector<RecordedStreams*> of_bags;
  of_bags.reserve(recordings.size());
  for (RecordedStreams& recording : recordings) of_bags.push_back(&recording);
  tell_apart(of_bags, names);
  RecordedStreams all{csv.take(), csv.notes()};
  for (RecordedStreams& recording : recordings) {
    std::ranges::move(recording.streams, std::back_inserter(all.streams));
    std::ranges::move(recording.notes, std::back_inserter(all.notes));
  }
  return all;
}

}  // namespace simbench::bags
