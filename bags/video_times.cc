#include "bags/video_times.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bags/bag.h"
#include "bags/read_budget.h"
#include "recording/counted.h"
#include "recording/file_kind.h"
#include "recording/number_in.h"
#include "recording/shell_quoted.h"
#include "recording/stamp_unit.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr int kNoSuchProgram = 127;  // of /bin/sh
constexpr std::size_t kLongestLine = 4096;
constexpr std::size_t kLongestTitle = 64;

// The lines that a command prints; what it says besides is among them.
class CommandLines {
 public:
  explicit CommandLines(const std::string& command) : output_(popen(command.c_str(), "re")) {
    if (!output_) throw BagError("/bin/sh: cannot be started");
  }
  // Nothing at the end. A line that is longer than any that is known comes in parts.
  std::optional<std::string_view> next() {
    if (fgets(line_, sizeof line_, output_.get()) == nullptr) return std::nullopt;
    std::string_view line(line_);
    while (line.ends_with('\n') || line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  // Its exit status.
  int wait() {
    const int status = pclose(output_.release());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  struct Close {
    void operator()(std::FILE* output) const { pclose(output); }
  };
  std::unique_ptr<std::FILE, Close> output_;
  char line_[kLongestLine]{};
};

struct Track {
  std::vector<std::int64_t> stamps;  // in units of the time base
  std::int64_t unstamped = 0;
  std::optional<StampUnit> time_base;
  std::string title;
};

// What ffprobe prints, as CSV: "packet,TRACK,STAMP,POSITION", and at the end
// "stream,TRACK,1/15360,TITLE".
class ProbedTracks {
 public:
  // False for a line of another kind: a message.
  bool take(std::string_view line) {
    const std::string_view kind = take_cell(line);
    if (kind != "packet" && kind != "stream") return false;
    const auto number = number_in<int>(take_cell(line));
    if (!number) return false;
    Track& track = tracks_[*number];
    if (kind == "stream") {
      track.time_base = unit_named(fmt::format("{} s", take_cell(line)));
      track.title = printable_name(std::string(line.substr(0, kLongestTitle)));
      return true;
    }
    if (const auto stamp = number_in<std::int64_t>(take_cell(line))) {
      track.stamps.push_back(*stamp);
    } else {
      ++track.unstamped;
    }
    if (const auto at = number_in<std::uint64_t>(take_cell(line))) {
      position_ = std::max(position_, *at);
    }
    return true;
  }
  std::uint64_t position() const { return position_; }
  const std::map<int, Track>& tracks() const { return tracks_; }

 private:
  std::map<int, Track> tracks_;
  std::uint64_t position_ = 0;
};

// Reads `path`, even if its name looks like an address or an option.
std::string probe_command(const std::string& path) {
  return fmt::format(
      "exec ffprobe -v error -protocol_whitelist file -select_streams v -show_entries "
      "packet=stream_index,pts,pos:stream=index,time_base:stream_tags=title -of csv {} 2>&1 "
      "< /dev/null",
      shell_quoted("file:" + path));
}

// "1 ms", "1/15360 s".
std::string step_text(const StampUnit& unit) {
  const std::string text = unit_text(unit);
  return text.front() >= '0' && text.front() <= '9' ? text : "1 " + text;
}

// The title, or, where there is none or several tracks have it, with the track's number.
std::string stream_name(const std::map<int, Track>& tracks, int number) {
  const std::string& title = tracks.at(number).title;
  const auto with_it = std::ranges::count_if(
      tracks, [&title](const auto& track) { return track.second.title == title; });
  if (!title.empty() && with_it == 1) return title;
  return fmt::format("{} {}", title.empty() ? "video" : title, number);
}

RecordedStream stream_of(const Track& track, const std::string& path, const std::string& camera,
                         std::string name) {
  RecordedStream stream{
      .camera = camera, .host = camera, .stream = std::move(name), .frames = {}, .counted = false};
  std::vector<std::int64_t> stamps = track.stamps;
  std::ranges::sort(stamps);
  for (const std::int64_t stamp : stamps) {
    const std::optional<Nanoseconds> at = time_in(fmt::format("{}", stamp), *track.time_base);
    if (at) stream.frames.push_back({stream.frames.size(), *at, *at});
  }
  stream.origin.file = path;
  stream.origin.stamps =
      fmt::format("the container's, in steps of {}", step_text(*track.time_base));
  stream.origin.arrivals = "none: the stamps stand for them";
  return stream;
}

void probe(const std::string& path, ProbedTracks& probed, const ReadProgress& progress) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  ReadBudget budget(none ? 0 : size);
  CommandLines lines(probe_command(path));
  std::string message;
  while (const auto line = lines.next()) {
    if (!probed.take(*line)) {
      if (message.empty()) message = printable_name(std::string(*line));
      continue;
    }
    budget.take_message();
    if (progress) progress(std::min<std::uint64_t>(probed.position(), size), size);
  }
  const int status = lines.wait();
  if (status == kNoSuchProgram) {
    throw BagError(path +
                   ": it is a video, whose frame times ffprobe reads; found no ffprobe on PATH, "
                   "which FFmpeg has (Debian and Ubuntu: ffmpeg)");
  }
  if (status != 0) throw BagError(fmt::format("{}: ffprobe: {}", path, message));
}

}  // namespace

bool is_video(const std::string& path) {
  FileBytes file(path);
  std::string first(kFileKindBytes, '\0');
  first.resize(file.read_up_to(first.data(), first.size()));
  const std::optional<FileKind> kind = file_kind(first);
  return kind && kind->is_video;
}

RecordedStreams read_video(const std::string& path, const std::string& camera,
                           const ReadProgress& progress) {
  ProbedTracks probed;
  RecordedStreams all;
  try {
    probe(path, probed, progress);
  } catch (const BudgetSpent& spent) {
    all.notes.push_back(fmt::format("{}: {}", path, spent.what()));
  }
  for (const auto& [number, track] : probed.tracks()) {
    if (track.stamps.empty() || !track.time_base) continue;
    all.streams.push_back(stream_of(track, path, camera, stream_name(probed.tracks(), number)));
    const RecordedStream& stream = all.streams.back();
    const auto left_out = track.unstamped + static_cast<std::int64_t>(track.stamps.size()) -
                          static_cast<std::int64_t>(stream.frames.size());
    if (left_out > 0) {
      all.notes.push_back(fmt::format("{}: {}: {} without a time stamp left out", path,
                                      stream.stream, counted(left_out, "frame")));
    }
  }
  std::erase_if(all.streams, [](const RecordedStream& stream) { return stream.frames.empty(); });
  if (all.streams.empty()) {
    throw BagError(path + ": found no video track with time stamps, allowed: one at least");
  }
  return all;
}

}  // namespace simbench::bags
