// The parsers of a recording folder: any bytes are what would be written for them, or refused.
//
// The first byte chooses: 'l' a line of events, 'm' a manifest, 'f' and 'e' the frames.csv and
// events.csv of a capture of two hosts and three cameras.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "algorithms/ports/assert.h"
#include "recording/event.h"
#include "recording/event_text.h"
#include "recording/recording_folder.h"
#include "recording/recording_manifest.h"

namespace {

using simbench::RecordingFolder;

void read_lines(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    try {
      SIMBENCH_ASSERT(simbench::to_line(simbench::from_line(line)) == line,
                      "a line has one way to be written");
    } catch (const simbench::EventTextError&) {
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

void read_manifest(const std::string& text) {
  try {
    const simbench::RecordingManifest manifest = simbench::parse_manifest(text, "fuzz.json");
    const std::string again = simbench::manifest_text(manifest);
    SIMBENCH_ASSERT(simbench::manifest_text(simbench::parse_manifest(again, "again.json")) == again,
                    "a manifest that was read can be written");
  } catch (const simbench::RecordingFolderError&) {
  }
}

// Two captures, one with an end and one without, whose files the input replaces.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz_recording_XXXXXX").string();
    SIMBENCH_ASSERT(mkdtemp(name.data()) != nullptr, "a scratch folder");
    path_ = name;
    simbench::RecordingWriter writer(path_, {.backend = "sim"});
    for (const std::uint64_t seed : {1U, 2U}) {
      simbench::RecordingSink& sink = writer.begin("p", seed);
      sink.on_start({.hosts = 2,
                     .cameras = {{0}, {0}, {1}},
                     .frame_rate_hz = 30,
                     .first_pulse = 0,
                     .pulses = 10});
      for (std::uint32_t i = 0; i < 3; ++i) {
        sink.on_frame({}, nullptr);
        sink.on_event(simbench::SyncOutcome{});
        sink.on_event(simbench::AlignmentReport{});
        sink.on_event(simbench::LedSighting{});
        sink.on_event(simbench::SessionDelays{});
      }
      if (seed == 1) {
        writer.end({});
      } else {
        writer.abandon();
      }
    }
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void play_with(const char* file, std::string_view content) const {
    const RecordingFolder folder(path_);
    for (const std::uint64_t seed : {1U, 2U}) {
      std::ofstream(path_ + "/p/" + std::to_string(seed) + "/" + file, std::ios::binary) << content;
      simbench::KeptRecording kept;
      simbench::make_recorded_source(folder)->record({.seed = seed, .pipeline = "p"}, kept);
    }
  }

 private:
  std::string path_;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  static const Folder frames;
  static const Folder events;
  switch (data[0]) {
    case 'l':
      read_lines(text);
      break;
    case 'm':
      read_manifest(text);
      break;
    case 'f':
      frames.play_with("frames.csv", text);
      break;
    case 'e':
      events.play_with("events.csv", text);
      break;
    default:
      break;
  }
  return 0;
}
