#include "processes/program_endings.h"

#include <fmt/format.h>

#include <string_view>

#include "recording/program_failure.h"

namespace simbench::processes {
namespace {

constexpr PeerId kMaster = 0;
constexpr std::string_view kExited = "exited with status 0";

// What follows that stays: "..., and the preloaded library was never loaded".
std::string without_setting(const std::string& how) {
  const std::string rest = how.starts_with(kExited) ? how.substr(kExited.size()) : "";
  return "ended with status 0 without setting the clock" + rest;
}

}  // namespace

void ProgramEndings::fail(const ProgramEnd& end, const EndPlace& place) {
  failure_ = {.host = host_.id(),
              .program = end.program,
              .at = place.at,
              .how = end.how,
              .last_words = end.last_words,
              .log = place.log};
  host_.report_program_failure(*failure_);
  host_.report_outcome({.slave = host_.id(),
                        .synchronised = false,
                        .passes = 0,
                        .message = failure_text(*failure_)});
}

void ProgramEndings::add(ProgramEnd end, const EndPlace& place, bool clock_was_set) {
  --running_;
  if (failure_) return;
  if (end.status != 0) return fail(end, place);
  if (running_ > 0) return;
  if (host_.id() == kMaster) {
    notes_.push_back(
        fmt::format("host {}, at {}: {}: ended with status 0; nobody serves the hosts from then on",
                    host_.id(), run_time_text(place.at), end.program));
  } else if (clock_was_set) {
    host_.report_outcome(
        {.slave = host_.id(),
         .synchronised = true,
         .passes = 0,
         .message = fmt::format("host {}: {}: {} at {}, the clock is set", host_.id(), end.program,
                                end.how, run_time_text(place.at))});
  } else {
    end.how = without_setting(end.how);
    fail(end, place);
  }
}

}  // namespace simbench::processes
