// The 18-camera scenario cut down for the tests of evaluation/, and a backend that plays it from
// hand-made captures in place of the simulator.
#pragma once

#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "tests/evaluation/test_capture.h"

namespace simbench::evaluation {

// Pipelines "arrival" (raw_arrival) and "smooth" (regression_30), both gathered by Algorithm 3, of
// 4 cameras on 2 hosts at 50 Hz.
scenarios::Scenario test_scenario();

// Plays a capture whose stamps depend on seed and pipeline alone: camera 3 is late by the seed in
// milliseconds, and by a little more in "smooth".
class TestSource final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override;
};

}  // namespace simbench::evaluation
