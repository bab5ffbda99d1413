#include "evaluation/advice/requirement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    (void)parse_requirement(text);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Requirement, HasAMetricASignAndALimit) {
  const Requirement amd = parse_requirement("amd<0.1ms");
  EXPECT_STREQ(amd.metric->id, "amd_ms");
  EXPECT_FALSE(amd.is_least);
  EXPECT_DOUBLE_EQ(amd.limit, 0.1);
  const Requirement recall = parse_requirement(" recall >= 99.5 % ");
  EXPECT_STREQ(recall.metric->id, "seed_recall");
  EXPECT_TRUE(recall.is_least);
  EXPECT_DOUBLE_EQ(recall.limit, 0.995);
}

TEST(Requirement, KnowsUnitsAndNames) {
  EXPECT_DOUBLE_EQ(parse_requirement("error<50us").limit, 0.05);
  EXPECT_DOUBLE_EQ(parse_requirement("absolute_error_ms<2s").limit, 2000);
  EXPECT_DOUBLE_EQ(parse_requirement("host_error<100ns").limit, 1e-4);
  EXPECT_DOUBLE_EQ(parse_requirement("precision>0.9").limit, 0.9);
  EXPECT_DOUBLE_EQ(parse_requirement("packets<50").limit, 50);
  EXPECT_STREQ(parse_requirement("max_te<1ms").metric->id, "max_te_ms");
  EXPECT_DOUBLE_EQ(parse_requirement("aligned_1_ms<30s").limit, 30);
  EXPECT_DOUBLE_EQ(parse_requirement("aligned_1_ms<500ms").limit, 0.5);
  EXPECT_DOUBLE_EQ(parse_requirement("exposure_drift<20ppm").limit, 20);
  EXPECT_DOUBLE_EQ(parse_requirement("disturbed_frames<50").limit, 50);
}

TEST(Requirement, IsMetOnItsSideOfTheLimit) {
  EXPECT_TRUE(parse_requirement("amd<1ms").is_met_by(0.999));
  EXPECT_FALSE(parse_requirement("amd<1ms").is_met_by(1));
  EXPECT_TRUE(parse_requirement("amd<=1ms").is_met_by(1));
  EXPECT_FALSE(parse_requirement("amd<1ms").is_met_by(std::nan("")));
  EXPECT_TRUE(parse_requirement("recall>=100%").is_met_by(1));
  EXPECT_FALSE(parse_requirement("bias<1ms").is_met_by(-2)) << "its size counts";
  EXPECT_TRUE(parse_requirement("bias<1ms").is_met_by(-0.5));
}

TEST(Requirement, HasAMargin) {
  EXPECT_DOUBLE_EQ(parse_requirement("amd<1ms").margin_of(0.25), 4);
  EXPECT_NEAR(parse_requirement("recall>99%").margin_of(0.995), 2, 1e-9);
  EXPECT_TRUE(std::isinf(parse_requirement("recall>99%").margin_of(1)));
  const std::vector<double> values = {0, 1, 2, 3, 4};
  EXPECT_DOUBLE_EQ(parse_requirement("amd<1ms").bad_quantile(values, 1), 4);
  EXPECT_DOUBLE_EQ(parse_requirement("recall>99%").bad_quantile(values, 1), 0);
}

TEST(Requirement, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal("speed<1ms"),
              HasSubstr("--require: found 'speed', allowed a metric: aligned_0_01_ms, "));
  EXPECT_THAT(refusal("amd"), HasSubstr("found 'amd', allowed METRIC<VALUE"));
  EXPECT_THAT(refusal("amd<1kg"), HasSubstr("AMD with the unit s, ms, us or ns"));
  EXPECT_THAT(refusal("amd<1"), HasSubstr("AMD with the unit s, ms, us or ns"));
  EXPECT_THAT(refusal("recall>1ms"), HasSubstr("% or as a share"));
  EXPECT_THAT(refusal("exposure_drift<20"), HasSubstr("exposure drift with the unit ppm"));
  EXPECT_THAT(refusal("aligned_1_ms<30"), HasSubstr("with the unit s, ms, us or ns"));
  EXPECT_THAT(refusal("amd<ms"), HasSubstr("a number from 0"));
  EXPECT_THAT(refusal("amd<-1ms"), HasSubstr("a number from 0"));
  EXPECT_THAT(refusal("amd<1.2.3ms"), HasSubstr("a number from 0"));
  EXPECT_THAT(refusal("amd<" + std::string(400, '9') + "ms"), HasSubstr("a number from 0"));
}

TEST(Requirement, RefusesWhatSaysNothingAndWhatNothingMeets) {
  EXPECT_THAT(refusal("amd>1ms"), HasSubstr("AMD < is what one asks for"));
  EXPECT_THAT(refusal("recall<50%"), HasSubstr("recall > is what one asks for"));
  EXPECT_THAT(refusal("amd<0ms"), HasSubstr("nothing is below 0"));
  EXPECT_THAT(refusal("recall>100%"), HasSubstr("nothing is above 100 %"));
  EXPECT_THAT(refusal("recall>=101%"), HasSubstr("at most 100 %"));
}

}  // namespace
}  // namespace simbench::evaluation
