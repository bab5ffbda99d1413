#include "hardware/experiment/stack_delays.h"

#include <gtest/gtest.h>

#include "tests/hardware/experiment/in_sandbox.h"

namespace simbench::hardware {
namespace {

TEST(StackDelays, AreMeasuredForEveryMessage) {
  const int result = in_sandbox([] {
    const StackDelays delays = measure_stack_delays({.messages = 20, .busy_threads = 1});
    if (delays.transmit_us.size() != 20 || delays.passage_us.size() != 20) return 1;
    if (delays.wake_up_us.size() != 20) return 2;
    // The kernel stamps between the calls, so no part is negative, and none takes no time at all
    // on the way through the socket layer and back to the program.
    for (const double each : delays.transmit_us) {
      if (!(each > 0)) return 3;
    }
    for (const double each : delays.passage_us) {
      if (!(each >= 0)) return 4;
    }
    for (const double each : delays.wake_up_us) {
      if (!(each > 0)) return 5;
    }
    return kGood;
  });
  SKIP_WITHOUT_NAMESPACES(result);
  EXPECT_EQ(result, kGood);
}

TEST(StackDelays, EndWhenCancelled) {
  const int result = in_sandbox([] {
    return measure_stack_delays({.cancelled = [] { return true; }}).wake_up_us.empty() ? kGood : 1;
  });
  SKIP_WITHOUT_NAMESPACES(result);
  EXPECT_EQ(result, kGood);
}

}  // namespace
}  // namespace simbench::hardware
