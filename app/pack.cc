#include "app/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>
#include <variant>

#include "recording/collected.h"
#include "recording/forwarding_sink.h"
#include "recording/recording_folder.h"
#include "recording/rs_csv_text.h"
#include "reports/text/output_file.h"
#include "scenarios/document.h"

namespace simbench::app {
namespace {

constexpr const char* kReadMe =
    "Stamps of a camera rig, packed by `simbench diagnose --pack`: no images, no names.\n"
    "frames.csv has a line a frame: its counter, the camera's stamp, its arrival.\n"
    "host0.1.csv and the like, if there are any: logs of the hosts' clocks, time and error in "
    "seconds.\n"
    "Look at it with: simbench diagnose frames.csv\n";

// New names in the order in which the old ones come.
class NewNames {
 public:
  explicit NewNames(std::string kind) : kind_(std::move(kind)) {}

  std::string of(const std::string& old) {
    const auto number = std::ranges::find(old_, old) - old_.begin();
    if (number == std::ssize(old_)) old_.push_back(old);
    return kind_ + std::to_string(number);
  }

  void add_notes(std::vector<std::string>& notes) const {
    for (std::size_t i = 0; i < old_.size(); ++i) {
      notes.push_back(fmt::format("{}{} is {}", kind_, i, old_[i].empty() ? "unnamed" : old_[i]));
    }
  }

 private:
  std::string kind_;
  std::vector<std::string> old_;
};

void check_new(const std::string& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder, ignored)) return;
  if (std::filesystem::is_directory(folder, ignored) &&
      std::filesystem::is_empty(folder, ignored)) {
    return;
  }
  throw scenarios::InputError(
      fmt::format("--pack: found '{}', which is there already; allowed: a "
                  "new or empty folder",
                  scenarios::shown_text(folder)));
}

// Leaves out what programs wrote, which may have names.
class NamelessSink final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;

  void on_event(const RecordingEvent& event) override {
    const auto* failure = std::get_if<ProgramFailure>(&event);
    if (failure == nullptr) return ForwardingSink::on_event(event);
    ProgramFailure nameless = *failure;
    nameless.last_words.clear();
    nameless.log.clear();
    ForwardingSink::on_event(nameless);
  }
};

std::string log_text(const evaluation::ClockLog& log) {
  std::string text = "time_s,error_s\n";
  for (const evaluation::ClockLogPoint& point : log.points) {
    text +=
        fmt::format("{:.6f},{}\n", static_cast<double>(point.time.count()) * 1e-6, point.error_s);
  }
  return text;
}

}  // namespace

Pack pack_streams(const RecordedStreams& rig, const std::vector<evaluation::HostLog>& logs,
                  const std::string& folder) {
  check_new(folder);
  Pack packed;
  NewNames cameras("camera"), hosts("host");
  std::vector<RecordedStream> streams = rig.streams;
  for (RecordedStream& stream : streams) {
    stream.camera = cameras.of(stream.camera);
    stream.host = hosts.of(stream.host);
  }
  std::vector<std::pair<std::string, std::string>> files = {{"README.txt", kReadMe},
                                                            {"frames.csv", rs_csv_text(streams)}};
  for (const evaluation::HostLog& log : logs) {
    if (log.log.are_summaries()) {
      packed.notes.push_back(log.log.path + ": left out, it has summaries in place of errors");
      continue;
    }
    const std::string host = log.host.empty() ? "clock" : hosts.of(log.host);
    files.emplace_back(fmt::format("{}.{}.csv", host, files.size() - 1), log_text(log.log));
  }
  reports::OutputFolder output(folder,
                               collected(files, &std::pair<std::string, std::string>::first));
  for (const auto& [name, text] : files) output.file(name) << text;
  output.publish();
  cameras.add_notes(packed.notes);
  hosts.add_notes(packed.notes);
  return packed;
}

Pack pack_recording(const std::string& recording, const std::string& folder) {
  check_new(folder);
  Pack packed;
  const RecordingFolder source(recording);
  RecordingDescription description = source.description();
  NewNames cameras("camera"), hosts("host");
  for (std::string& name : description.cameras) name = cameras.of(name);
  for (std::string& name : description.hosts) name = hosts.of(name);
  RecordingWriter writer(folder, description);
  for (std::size_t i = 0; i < source.captures().size(); ++i) {
    const RecordedCapture& capture = source.captures()[i];
    NamelessSink sink(writer.begin(capture.pipeline, capture.seed));
    source.play(i, sink);
    RecordingCost cost = capture.cost;
    // Notes, and what programs wrote, may have names.
    cost.notes.clear();
    cost.program_failures.clear();
    if (capture.complete) {
      writer.end(cost);
    } else {
      writer.abandon();
    }
  }
  cameras.add_notes(packed.notes);
  hosts.add_notes(packed.notes);
  return packed;
}

}  // namespace simbench::app
