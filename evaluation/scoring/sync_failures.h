// The hosts whose synchronisation failed, by what they reported: the last word of each counts, so a
// slave that came to its master late is none of them.
//
//   SyncFailures failures;
//   failures.add({.slave = 3, .synchronised = false, .message = "no reply"});
//   const std::vector<SyncOutcome> failed = failures.take();
#pragma once

#include <utility>
#include <vector>

#include "algorithms/ports/exchange.h"

namespace simbench::evaluation {

class SyncFailures {
 public:
  void add(const SyncOutcome& outcome) {
    std::erase_if(failures_,
                  [&](const SyncOutcome& before) { return before.slave == outcome.slave; });
    if (!outcome.synchronised) failures_.push_back(outcome);
  }
  // In the order in which they were reported.
  std::vector<SyncOutcome> take() { return std::move(failures_); }

 private:
  std::vector<SyncOutcome> failures_;
};

}  // namespace simbench::evaluation
