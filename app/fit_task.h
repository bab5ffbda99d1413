// What a fit is made of: the data of a recording, and the scenario that gives what no recording
// shows. For `simbench fit`, and for whoever wants the model at once.
//
//   const FitTask task = fit_task({"front.bag", "back.bag"}, {});
//   const auto study = evaluation::study_fit(task.input, task.base, "rig.json", simulated_world);
//
// Errors: evaluation::FitError, and those of app/recorded_streams.h and of loading the base.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "evaluation/fit/fit_input.h"
#include "evaluation/fit/fit_model.h"

namespace simbench::app {

struct FitChoice {
  std::string base{};  // the recording's own; for files a built-in one with their counts and rate
  std::string pipeline{};               // of the capture in a recording folder; empty: the first
  std::optional<std::uint64_t> seed{};  // likewise
  bool one_host = false;  // one computer stamped all arrivals, even if the files name several hosts
};

struct FitTask {
  evaluation::FitInput input;
  evaluation::FitBase base;
  std::string capture{};             // of a recording folder: which
  std::vector<std::string> notes{};  // for the user
};

// `inputs`: a recording folder, or files (app/recorded_streams.h).
FitTask fit_task(const std::vector<std::string>& inputs, const FitChoice& choice,
                 const bags::FileOptions& options = {}, const ReadProgress& progress = {});

}  // namespace simbench::app
