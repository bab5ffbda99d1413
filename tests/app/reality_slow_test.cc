// The predictions of real recordings as the bench makes them now, against those that the files keep
// for answers.

#include <gtest/gtest.h>

#include "app/interrupt.h"
#include "evaluation/reality/reality.h"
#include "tests/nonempty.h"

namespace simbench::app {
namespace {

TEST(RealitySlowTest, TheRecordedRatiosAreThoseOfTheBench) {
  for (const scenarios::RealRecording& recording : nonempty(scenarios::real_recordings())) {
    for (const evaluation::RealityRow& row : nonempty(evaluation::compare_with_reality(
             recording,
             [](const scenarios::Scenario& scenario) { return simulated_clocks(scenario); }, {},
             nullptr))) {
      EXPECT_NEAR(row.ratio() / row.setting->recorded_ratio, 1, 0.01)
          << recording.name << ": " << row.setting->name
          << ": write what `simbench reality --format json` prints to recorded_ratio";
    }
  }
}

}  // namespace
}  // namespace simbench::app
