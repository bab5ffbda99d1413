// The options of commands that judge clocks by limits: --mask, --limit.
//
//   MaskOptions limits;
//   add_mask_options(command, limits);
//   const std::vector<evaluation::ClockMask> masks = masks_of(limits);
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "evaluation/stability/masks.h"

namespace simbench::cli {

struct MaskOptions {
  std::string mask{};
  std::vector<std::string> limits{};
};

void add_mask_options(Command& command, MaskOptions& options);

// Throws scenarios::InputError for limits that are none.
std::vector<evaluation::ClockMask> masks_of(const MaskOptions& options);

}  // namespace simbench::cli
