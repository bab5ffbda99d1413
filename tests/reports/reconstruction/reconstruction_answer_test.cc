#include <gmock/gmock.h>

#include <string>

#include "reports/reconstruction/reconstruction_document.h"
#include "tests/reports/sample_reconstruction.h"
#include "tests/reports/whole_text.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string reconstruction_text(const reconstruction::ReconstructionResults& results) {
  return whole_text(reconstruction_answer(results));
}

TEST(ReconstructionAnswer, SaysWhichIsBestAndHowFarApartHostsMayBe) {
  const std::string text = reconstruction_text(sample_reconstruction());
  EXPECT_THAT(text, StartsWith("yoon2021_both gives the best reconstruction of the "));
  EXPECT_THAT(text, HasSubstr("mean error 2.40 [2.04, 2.58] cm, its exposures 5.0 ms apart."));
  EXPECT_THAT(text, HasSubstr("These seeds cannot tell "));
  // 10 % of 2 cm at 0.01 cm/ms from 10 ms on.
  EXPECT_THAT(text,
              HasSubstr("At 1.20 m/s hosts may be 30.0 ms apart until the error is 10 % above "
                        "its floor of 2.00 cm"));
  EXPECT_THAT(text, HasSubstr("3 seeds say little about other worlds"));
}

TEST(ReconstructionAnswer, ARowWhoseExposuresNeedTheTruthIsNotTheBest) {
  auto results = sample_reconstruction();
  for (auto& row : results.rows) {
    if (row.pipeline == "yoon2021_both") row.capture_alignment = "oracle";
  }
  EXPECT_THAT(reconstruction_text(results), testing::Not(StartsWith("yoon2021_both gives")));
}

TEST(ReconstructionAnswer, WithoutRowsThereIsNone) {
  EXPECT_EQ(reconstruction_text({}), "No pipeline that a rig can run was reconstructed.");
}

}  // namespace
}  // namespace simbench::reports
