// Reports how the synchronisation of a slave ended, as seen by the slave: its first outcome, and
// that it came to its master all the same after a failure.
//
//   OutcomeReport outcome(host);
//   outcome.failed(8, "no reply from the master; is it running?");  // "slave 3: no reply from ..."
#pragma once

#include <cstdint>
#include <string>

#include "algorithms/ports/host.h"

namespace simbench {

class OutcomeReport {
 public:
  // The host must outlive this.
  explicit OutcomeReport(Host& host) : host_(host) {}

  bool is_reported() const { return is_reported_; }
  void synchronised(std::uint32_t passes) { report(passes, true, ""); }
  // `why` says what would help.
  void failed(std::uint32_t passes, const std::string& why) {
    report(passes, false, "slave " + std::to_string(host_.id()) + ": " + why);
  }

 private:
  void report(std::uint32_t passes, bool synchronised, const std::string& message) {
    if (is_reported_ && (is_synchronised_ || !synchronised)) return;
    is_reported_ = true;
    is_synchronised_ = synchronised;
    host_.report_outcome(
        {.slave = host_.id(), .synchronised = synchronised, .passes = passes, .message = message});
  }

  Host& host_;
  bool is_reported_ = false;
  bool is_synchronised_ = false;
};

}  // namespace simbench
