// The limits of capture_alignment: cameras that nobody steers, and cameras that need no steering.

#include <memory>
#include <utility>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// Sends nothing.
class Unaligned final : public CaptureAlignment {
 public:
  explicit Unaligned(Steering steering) : steering_(steering) {}
  Steering steering() const override { return steering_; }
  Task<void> run_master(Host& /*host*/, std::vector<PeerId> /*slaves*/) override { co_return; }
  Task<void> run_slave(Host& /*host*/, PeerId /*master*/) override { co_return; }

 private:
  Steering steering_;
};

CaptureAlignmentEntry alignment_limit(const char* name, const char* summary, Steering steering,
                                      std::vector<Need> needs) {
  return {.info = {.name = name,
                   .family = "limits",
                   .summary = summary,
                   .source = "a definition",
                   .needs = std::move(needs)},
          .make = [steering](const Parameters&) { return std::make_unique<Unaligned>(steering); }};
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_limits() {
  return {alignment_limit("free_run", "nobody steers: each camera runs by its own oscillator",
                          Steering::kByControls, {Need::kFrameControl}),
          alignment_limit("oracle", "all cameras expose at once, each to its nearest granule",
                          Steering::kIdeal, {Need::kFrameControl, Need::kTruth})};
}

}  // namespace simbench
