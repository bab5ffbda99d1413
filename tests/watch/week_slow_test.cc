// A week of a rig: memory does not grow, and nothing that did not happen is said.
#include <gtest/gtest.h>

#include <string>

#include "tests/watch/watched_rig.h"
#include "watch/rig_watch.h"

namespace simbench::watch {
namespace {

TEST(WatchedWeekTest, ThreeCamerasAtFiveHertz) {
  constexpr int kPulses = 7 * 24 * 3600 * 5;
  constexpr int kPiece = 5 * 600;
  const WatchedRig rig{.period_ms = 200, .jitter_ms = 2};
  RigWatch watch;
  std::size_t most = 0;
  for (int pulse = 0; pulse < kPulses; pulse += kPiece) {
    watch.add(rig.frames(pulse, std::min(pulse + kPiece, kPulses)));
    for (const WatchEvent& event : watch.look())
      ADD_FAILURE() << event.text << " at " << event.at_s;
    for (const WatchedCamera& camera : watch.cameras()) most = std::max(most, camera.kept.size());
  }
  EXPECT_LE(most, static_cast<std::size_t>(kPiece) + 5 * 60 + 2);
  EXPECT_EQ(watch.cameras()[0].frames, kPulses);
}

}  // namespace
}  // namespace simbench::watch
