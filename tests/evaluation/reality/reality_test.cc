#include "evaluation/reality/reality.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace simbench::evaluation {
namespace {

// A world whose slaves stand still: host h is 10 us times h times the seed off the master, which is
// 5 us off the truth; twice that if the scenario has another buffer. Four messages stay 4, 5, 9 and
// 100 us in the switch; the last is not for host 1, and one is lost.
class StandingClocks final : public ClockSource {
 public:
  explicit StandingClocks(double scale) : scale_(scale) {}
  ClockCost run(const ClockRequest& request, ClockSink& sink) override {
    const double unit_s = 10e-6 * scale_ * static_cast<double>(request.seed);
    const std::vector<double> errors_s = {0, unit_s, 2 * unit_s, 3 * unit_s};
    message(sink, 1, 4);
    message(sink, 1, 9);
    message(sink, 1, 5);
    message(sink, 2, 100);
    sink.on_message({.from = 0, .to = 1, .lost = true});
    const Nanoseconds end = request.duration + request.master_lost_for + request.recovery;
    for (Nanoseconds at{}; at <= end; at += request.interval) {
      sink.on_master(5e-6);
      sink.on_errors(TrueTime(at), errors_s);
    }
    return {};
  }

 private:
  static void message(ClockSink& sink, std::uint32_t to, double residence_us) {
    sink.on_message({.from = 0,
                     .to = to,
                     .at_switch = TrueTime{} + from_us(7),
                     .arrived = TrueTime{} + from_us(7 + residence_us)});
  }

  double scale_;
};

scenarios::RealRecording recording() {
  using enum scenarios::RealityQuantity;
  const scenarios::RealitySetting setting{.name = "host 1",
                                          .scenario = "4host_chain",
                                          .set = {},
                                          .pipeline = "chrony_hw",
                                          .host = 1,
                                          .quantity = kPairMedianAbsTe,
                                          .measured_us = {10, 40, 30},
                                          .factor = 1.6,
                                          .used_for = ""};
  scenarios::RealRecording all{.name = "test",
                               .title = "a test",
                               .source = "nobody",
                               .instrument = "none",
                               .duration_s = 60,
                               .from_s = 10,
                               .seeds = 3,
                               .settings = {setting, setting},
                               .unknown = {{.what = "buffer",
                                            .pointer = "/network/buffer_kb",
                                            .nominal = "96",
                                            .values = {"50"},
                                            .source = "a guess"},
                                           {.what = "nothing that is there",
                                            .pointer = "/network/bufer_kb",
                                            .nominal = "1",
                                            .values = {"2"},
                                            .source = "a guess"}}};
  all.settings[1].quantity = kMedianAbsTe;
  all.settings[1].host = 2;
  return all;
}

std::vector<RealityRow> compared(const scenarios::RealRecording& measured, bool spans) {
  const ClockWorldFactory make_world = [](const scenarios::Scenario& scenario) {
    return std::make_unique<StandingClocks>(scenario.network.buffer_kb == 50 ? 2 : 1);
  };
  return compare_with_reality(measured, make_world, {.spans_unknown = spans}, nullptr);
}

TEST(Reality, TheMediansOverSeedsAndStretchesAreCompared) {
  const scenarios::RealRecording measured = recording();
  const std::vector<RealityRow> rows = compared(measured, false);
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(rows[0].predicted_us.size(), 3U);
  EXPECT_NEAR(rows[0].predicted_us[2], 30, 1e-9);
  EXPECT_NEAR(rows[0].median_us(), 20, 1e-9);
  EXPECT_EQ(rows[0].measured_us(), 30);
  EXPECT_EQ(rows[0].least_measured_us(), 10);
  EXPECT_EQ(rows[0].largest_measured_us(), 40);
  EXPECT_NEAR(rows[0].ratio(), 2.0 / 3, 1e-9);
  EXPECT_TRUE(rows[0].is_within()) << "1.5 is below 1.6";
  EXPECT_NEAR(rows[1].median_us(), 45, 1e-9) << "against true time: twice 20 and the master's 5";
  EXPECT_TRUE(rows[1].is_within());
  EXPECT_TRUE(rows[0].spans.empty());
}

TEST(Reality, UnknownParametersSpanPredictions) {
  const scenarios::RealRecording measured = recording();
  const std::vector<RealityRow> rows = compared(measured, true);
  ASSERT_EQ(rows[0].spans.size(), 1U) << "a member that the scenario does not have spans nothing";
  EXPECT_EQ(rows[0].spans[0].parameter, &measured.unknown[0]);
  EXPECT_NEAR(rows[0].spans[0].predicted_us, 40, 1e-9);
}

TEST(Reality, APairMayBeOfTwoSlaves) {
  scenarios::RealRecording measured = recording();
  measured.pairs_with = 2;
  measured.settings[0].host = 3;
  measured.settings[1].quantity = scenarios::RealityQuantity::kPairSdTe;
  const std::vector<RealityRow> rows = compared(measured, false);
  EXPECT_NEAR(rows[0].median_us(), 20, 1e-9) << "three units and two: one apart";
  EXPECT_NEAR(rows[1].median_us(), 0, 1e-9) << "standing clocks";
}

TEST(Reality, ResidencesAreThoseOfTheMastersMessages) {
  scenarios::RealRecording measured = recording();
  measured.settings[0].quantity = scenarios::RealityQuantity::kResidenceMedian;
  measured.settings[1].quantity = scenarios::RealityQuantity::kResidenceMax;
  measured.settings[1].host = 1;
  const std::vector<RealityRow> rows = compared(measured, false);
  EXPECT_NEAR(rows[0].median_us(), 5, 1e-9);
  EXPECT_NEAR(rows[1].median_us(), 9, 1e-9);
}

TEST(Reality, AFigureThatWasKnownDoesNotCount) {
  scenarios::RealRecording measured = recording();
  measured.settings[0].used_for = "its size";
  const std::vector<RealityRow> rows = compared(measured, false);
  EXPECT_FALSE(rows[0].counts());
  EXPECT_TRUE(rows[1].counts());
}

}  // namespace
}  // namespace simbench::evaluation
