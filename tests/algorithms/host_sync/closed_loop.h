// The loop of a service closed in a scripted world: named limits over shared defaults.
//
//   ScriptWorld world(3);
//   world.run(service, from_ms(60e3));
//   expect_locked(world, {.error_us = 0.5});
//   expect_refused(world, 2, "has not locked");
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/algorithms/host_sync/script_host.h"
#include "tests/nonempty.h"

namespace simbench {

struct LoopLimits {
  double error_us = 0.01;  // of a slave's clock against the master's
  PeerId slave = 0;        // that one alone; 0: all
};

inline double lead_us(ScriptWorld& world, PeerId slave) {
  return to_ms(world.host(slave).lead_over(world.host(0))) * 1e3;
}

inline void expect_aligned(ScriptWorld& world, const LoopLimits& limits = {}) {
  for (const PeerId slave : nonempty(world.slaves())) {
    if (limits.slave != 0 && slave != limits.slave) continue;
    EXPECT_NEAR(lead_us(world, slave), 0, limits.error_us) << "slave " << slave;
  }
}

// The slaves are aligned, and each has reported once that it is.
inline void expect_locked(ScriptWorld& world, const LoopLimits& limits = {}) {
  expect_aligned(world, limits);
  for (const PeerId slave : nonempty(world.slaves())) {
    if (limits.slave != 0 && slave != limits.slave) continue;
    ASSERT_EQ(world.host(slave).outcomes.size(), 1u) << "slave " << slave;
    const SyncOutcome& outcome = world.host(slave).outcomes[0];
    EXPECT_TRUE(outcome.synchronised) << "slave " << slave << ": " << outcome.message;
  }
}

// The slave has reported one failure, which says so.
inline void expect_refused(ScriptWorld& world, PeerId slave, const std::string& message) {
  ASSERT_EQ(world.host(slave).outcomes.size(), 1u) << "slave " << slave << ", " << message;
  const SyncOutcome& outcome = world.host(slave).outcomes[0];
  EXPECT_FALSE(outcome.synchronised) << "slave " << slave;
  EXPECT_NE(outcome.message.find(message), std::string::npos) << outcome.message;
}

// A link on which nothing arrives.
inline void cut(ScriptWorld& world, PeerId from, PeerId to) {
  world.script_link(from, to, [](std::size_t, const Bytes&) { return std::vector<Nanoseconds>{}; });
}

}  // namespace simbench
