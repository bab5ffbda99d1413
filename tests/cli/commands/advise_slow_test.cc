// simbench advise --per-day through the real program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace simbench {
namespace {

class AdvisePerDay : public ProgramTest {};

TEST_F(AdvisePerDay, SaysHowOftenItGoesWrong) {
  const ProgramResult result =
      run({"advise", "--require", "amd<0.1ms", "--cameras", "4", "--rate", "30", "--hosts", "2",
           "--seeds", "72", "--set", "/timeline/frames=60", "--per-day", "--bound-ms", "0.02",
           "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rare = nlohmann::json::parse(result.out)["rare"];
  ASSERT_EQ(rare.size(), 2U);
  const double probability = rare[0]["probability"];
  EXPECT_GT(probability, 0);
  EXPECT_LE(rare[0]["low"], probability);
  EXPECT_GE(rare[0]["high"], probability);
  EXPECT_DOUBLE_EQ(rare[0]["per_day"], probability * 30 * 86400);
}

}  // namespace
}  // namespace simbench
