// The options of commands that take recordings of real cameras: --topics, --columns.
//
//   InputOptions inputs;
//   add_input_options(command, inputs);
//   const RecordedStreams rig = app::recorded_streams({"rig.bag"}, file_options(inputs));
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "recording/recorded_streams.h"

namespace simbench::cli {

struct InputOptions {
  std::vector<std::string> topics;
  std::string columns;
};

// What a command says of its inputs in the help's list of arguments.
inline constexpr const char* kInputsText =
    "A recording folder; or bags (RealSense, ROS 1, ROS 2), CSV files, videos, and folders of them";

void add_input_options(Command& command, InputOptions& options);

// Throws CsvError for columns that make no sense.
bags::FileOptions file_options(const InputOptions& options);

// The options as words of a command line, which reads other inputs alike.
std::vector<std::string> reading_words(const InputOptions& options);

// Reports bytes from a megabyte on, and ends reading at an interruption. `progress` outlives it.
ReadProgress read_progress(const evaluation::Progress& progress);

// Runs `work`, which reads inputs and takes a ReadProgress, with that progress. Nothing after
// Ctrl-C.
template <class Result, class Work>
std::optional<Result> watched_reading(const Work& work) {
  return watched<Result>(
      [&](const evaluation::Progress& progress) { return work(read_progress(progress)); },
      {.unit = "byte"});
}

// The streams of the inputs (app/recorded_streams.h), with progress and with their notes printed.
// Nothing after Ctrl-C.
std::optional<RecordedStreams> read_inputs(const std::vector<std::string>& inputs,
                                           const InputOptions& options);

}  // namespace simbench::cli
