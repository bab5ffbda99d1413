// Runs work that reports its progress and may be interrupted, the way every long command does.
//
// Progress goes to standard error. After the first Ctrl-C the work ends at its next run; then a
// line says how far it got, and there is no result. With --json all of it is JSON lines
// (cli/progress.h); a command needs to do nothing for that but run its work in here.
//
//   const auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
//     return evaluation::evaluate(scenario, make_source, options, progress);
//   });
//   if (!results) return kInterrupted;
#ifndef SIMBENCH_CLI_WATCHED_H_
#define SIMBENCH_CLI_WATCHED_H_

#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <iostream>
#include <optional>
#include <string>

#include "app/interrupt.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "evaluation/run/evaluate.h"

namespace simbench::cli {

// `work` returns a Result (or none: an empty std::optional). `unit`: what it counts, in the plural.
// Everything that `work` throws passes through, unless it was interrupted.
template <class Result, class Work>
std::optional<Result> watched(const Work& work, const std::string& unit = "runs") {
  const app::InterruptHandler handler;
  Progress progress(std::cerr, progress_style(), unit);
  std::uint64_t finished = 0;
  std::uint64_t all = 0;
  try {
    std::optional<Result> result = work([&](std::uint64_t done, std::uint64_t total) {
      finished = done;
      all = total;
      progress.update(done, total);
    });
    progress.finish();
    return result;
  } catch (const std::exception&) {
    if (!app::InterruptHandler::raised()) throw;
  }
  progress.interrupt();
  if (!messages_are_json()) {
    std::cerr << fmt::format("interrupted after {} of {} {}; no result was written\n", finished,
                             all ? std::to_string(all) : "all", unit);
  }
  return std::nullopt;
}

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_WATCHED_H_
