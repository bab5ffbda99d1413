#include "cli/mask_options.h"

#include "recording/collected.h"

namespace simbench::cli {

void add_mask_options(Command& command, MaskOptions& options) {
  command.word("--mask", "MASK", options.mask,
               collected(evaluation::masks(), &evaluation::ClockMask::id),
               "Judge by the limits of ITU-T: G.8272 (prtc), G.8273.2 (class), G.813 (sec)");
  command.list("--limit", "LIMIT,...", options.limits,
               "Judge by limits of your own: max_te, cte, te_p2p, p50, p95, p99, p99.9, mtie@TAU,\n"
               "tdev@TAU with a time, adev@TAU, mdev@TAU, hdev@TAU with a number");
}

std::vector<evaluation::ClockMask> masks_of(const MaskOptions& options) {
  std::vector<evaluation::ClockMask> masks;
  if (!options.mask.empty()) masks.push_back(evaluation::mask_named(options.mask));
  if (!options.limits.empty()) masks.push_back(evaluation::limits_mask(options.limits));
  return masks;
}

}  // namespace simbench::cli
