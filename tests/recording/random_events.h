// Random events of a recording, with extreme values among them, and their comparison.
#pragma once

#include <random>

#include "recording/event.h"

namespace simbench {

struct RandomEventBounds {
  // Numbers below it; where it is below 100, a pulse has an error of each.
  std::uint32_t hosts = 0xffffffff;
  std::uint32_t cameras = 0xffffffff;
};

KeptEvent random_event(std::mt19937_64& random, const RandomEventBounds& bounds = {});

// Member by member, doubles bit by bit.
bool same(const KeptEvent& a, const KeptEvent& b);
bool same(const RigLayout& a, const RigLayout& b);

}  // namespace simbench
