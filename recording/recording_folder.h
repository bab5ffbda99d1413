// Recordings as files: a folder that every backend writes alike, and that plays back as recorded.
//
//   DIR/manifest.json              format, simbench version and commit, backend, resolved scenario,
//                                  names of hosts and cameras, what was planned, and the captures
//                                  that were begun, with seed,
//                                  pipeline, layout, cost, notes, and whether they are complete
//   DIR/<pipeline>/<seed>/frames.csv   one line a frame, with a header: order, then the columns of
//                                  recording/event_text.h (truth columns empty without truth)
//   DIR/<pipeline>/<seed>/events.csv   the other events: order, then a line of event_text.h
//
// In the name of a pipeline's folder, bytes other than letters, digits, _ - and inner dots stand as
// %XX.
//
// `order` counts the events of a capture across both files; playing merges by it, so a sink gets
// the same calls with the same values in the same order as when it was recorded, and scores of a
// replay equal those of the run.
//
// When the writer dies, no more than 100 ms or 1000 events are lost: frames are written through to
// the kernel that often, and a folder whose capture has no end is readable up to its last whole
// line (RecordedCapture::complete is then false, and a note says so). A new recording never
// overwrites: the folder must be new or empty.
//
// Errors: RecordingFolderError, "FILE:LINE: ..." with what was found and allowed, also for a full
// disk; it is thrown by the call that failed, and what was written stays readable.
//
//   RecordingWriter writer("monday", {.backend = "sim", .scenario_json =
//   scenario.resolved_json()}); source.record(request, writer.begin("yoon2021_both", 1));
//   writer.end(cost);                // or abandon(notes)
//
//   RecordingFolder folder("monday");
//   folder.play(folder.find("yoon2021_both", 1).value(), scorer);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "recording/recording.h"

namespace simbench {

class RecordingFolderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What was to be recorded: these pipelines, each at every seed. Empty: nobody said.
struct PlannedCaptures {
  std::vector<std::string> pipelines{};
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
};

// What all captures of a folder share.
struct RecordingDescription {
  std::string backend{};               // "sim" or "hardware"
  std::string scenario_json{};         // resolved
  std::vector<std::string> hosts{};    // names, by number; empty: "host0", ...
  std::vector<std::string> cameras{};  // serials, by number; empty: "camera0", ...
  PlannedCaptures planned{};
};

// One capture of a folder.
struct RecordedCapture {
  std::string pipeline;
  std::uint64_t seed = 1;  // on a real rig: which repetition
  RigLayout layout;
  RecordingCost cost;
  bool complete = false;
  std::vector<std::string> notes{};  // what went wrong, a line each
  // Lines of frames.csv and of events.csv; 0 unless complete.
  std::uint64_t frames = 0;
  std::uint64_t other_events = 0;
};

class RecordingWriter {
 public:
  RecordingWriter(std::string folder, RecordingDescription description);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // The sink of a new capture, valid until end() or abandon(); one at a time, each pipeline and
  // seed once. Events without an on_start are not written.
  RecordingSink& begin(const std::string& pipeline, std::uint64_t seed);
  // The notes of `cost` and `notes` are kept.
  void end(const RecordingCost& cost, std::vector<std::string> notes = {});
  // Leaves the capture without an end: what was recorded until now stays.
  void abandon(std::vector<std::string> notes = {});

 private:
  class State;
  std::unique_ptr<State> state_;
};

class RecordingFolder {
 public:
  explicit RecordingFolder(std::string folder);

  const RecordingDescription& description() const { return description_; }
  const std::vector<RecordedCapture>& captures() const { return captures_; }
  std::optional<std::size_t> find(const std::string& pipeline, std::uint64_t seed) const;
  // Streams a capture; its memory does not grow with it. For a damaged one, the sink gets what
  // comes before the damage, then RecordingFolderError is thrown.
  void play(std::size_t capture, RecordingSink& sink) const;

 private:
  std::string folder_;
  RecordingDescription description_;
  std::vector<RecordedCapture> captures_;
};

// A folder as a backend: it plays the requested pipeline and seed, or throws RecordingFailed if
// they were not recorded. The cost has the capture's notes, and one on its damage. `folder`
// outlives it.
std::unique_ptr<RecordingSource> make_recorded_source(const RecordingFolder& folder);

}  // namespace simbench
