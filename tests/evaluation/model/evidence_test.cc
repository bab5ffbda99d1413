#include "evaluation/model/evidence.h"

#include <gtest/gtest.h>

namespace simbench::evaluation {
namespace {

TEST(Evidence, EveryStageRestsOnSomethingAndSaysWhy) {
  EXPECT_EQ(model_evidence().size(), 12);
  for (const StageEvidence& stage : model_evidence()) {
    int count = 0;
    for (const Evidence evidence : kAllEvidence) count += stage.has(evidence) ? 1 : 0;
    EXPECT_GE(count, 1) << stage.stage;
    EXPECT_GT(stage.why.size(), 20) << stage.stage;
  }
}

// The experiment has no cameras: it cannot be evidence for any stage of them.
TEST(Evidence, TheExperimentIsNoEvidenceForCameras) {
  int stages_of_cameras = 0;
  for (const StageEvidence& stage : model_evidence()) {
    const bool of_cameras = stage.stage == "trigger" || stage.stage == "exposure" ||
                            stage.stage == "device clock" || stage.stage == "USB and host stack";
    if (!of_cameras) continue;
    ++stages_of_cameras;
    EXPECT_FALSE(stage.has(Evidence::kExperiment)) << stage.stage;
  }
  EXPECT_EQ(stages_of_cameras, 4);
}

}  // namespace
}  // namespace simbench::evaluation
