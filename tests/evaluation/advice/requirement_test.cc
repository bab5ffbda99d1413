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
    (void)parse_requirements({text});
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

TEST(Requirement, AToleranceOfTheTaskBecomesASpread) {
  const auto all = parse_requirements({"5mm at 2m/s", "amd<1ms"});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_STREQ(all[0].metric->id, "exposure_spread_ms");
  EXPECT_DOUBLE_EQ(all[0].limit, 2.5);
  EXPECT_EQ(all[0].text, "exposure_spread<=2.5ms");
  EXPECT_EQ(all[0].tolerance, "5mm at 2m/s");
  EXPECT_STREQ(all[1].metric->id, "seed_precision");
  EXPECT_DOUBLE_EQ(all[1].limit, 0.99);
  EXPECT_EQ(exposure_ms_of(all), std::nullopt);
}

TEST(Requirement, TheBlurOfAnExposureIsPartOfTheTolerance) {
  const auto all = parse_requirements({"1 cm at 36 km/h exposed 250us"});
  EXPECT_NEAR(all.front().limit, 0.75, 1e-12) << "10 mm at 10 m/s are 1 ms";
  EXPECT_EQ(exposure_ms_of(all), 0.25);
  EXPECT_NEAR(parse_tolerance("0.5m at 100mm/s").front().limit, 5000, 1e-9);
}

TEST(Requirement, RefusesATolerancePerhapsMeantOtherwise) {
  EXPECT_THAT(refusal("5mm"), HasSubstr("with its speed, as in '5mm at 2m/s'"));
  for (const char* text : {"5mm at ", "5 at 2m/s", "5mm at 2", "mm at 2m/s", "5mm at 2m/s exposed",
                           "5mm at 0m/s", "5mm at 2m/s exposed 3", "0mm at 2m/s"}) {
    EXPECT_THAT(refusal(text), HasSubstr("LENGTH at SPEED")) << text;
  }
  EXPECT_THAT(refusal("5mm at 2m/s exposed 1ms twice"), HasSubstr("nothing behind"));
  EXPECT_THAT(refusal("5mm at 2m/s exposed 3ms"), HasSubstr("an exposure below 2.5 ms"));
  EXPECT_THROW((void)exposure_ms_of(
                   parse_requirements({"5mm at 1m/s exposed 1ms", "5mm at 1m/s exposed 2ms"})),
               scenarios::InputError);
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
