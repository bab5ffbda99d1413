#include "reports/advice/advice_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/reports/whole_text.h"

namespace simbench::reports {
namespace {

using evaluation::Advice;
using evaluation::OptionAdvice;
using evaluation::PipelineAdvice;
using testing::HasSubstr;
using testing::StartsWith;

PipelineAdvice pipeline(std::int64_t met, std::int64_t seeds, double margin) {
  return {.pipeline = {.name = "pps.poll.yoon2021",
                       .host_sync = "pps",
                       .device_time = "poll",
                       .gathering = "yoon2021"},
          .met = met,
          .seeds = seeds,
          .margin = margin,
          .median = {0.025},
          .bad_quantile = {0.05}};
}

scenarios::Part named_part(const std::string& part_name, const std::string& name) {
  scenarios::Part part;
  part.part = part_name;
  part.name = name;
  return part;
}

OptionAdvice option(std::int64_t hosts, double price_eur, const PipelineAdvice& best,
                    bool is_settled) {
  OptionAdvice option;
  option.option.hosts = hosts;
  option.option.cameras_per_host = 4;
  option.option.host = named_part("small_pc", "A small computer");
  if (hosts > 1) {
    option.option.network_switch = named_part("a_switch", "A switch");
    option.option.clock = named_part("pps_wires", "Wires");
  }
  option.option.price = {price_eur, 2 * price_eur};
  option.pipelines = {best};
  option.is_settled = is_settled;
  return option;
}

// The second of three meets it, and is settled.
Advice sample() {
  Advice advice;
  advice.request.rig.cameras = 8;
  advice.request.rig.rate_hz = 60;
  advice.request.requirements = evaluation::parse_requirements({"amd<0.1ms"});
  advice.options_of_run.first_seed = 5;
  advice.options = {option(1, 500, pipeline(40, 72, 0.5), true),
                    option(2, 1500, pipeline(72, 72, 2), true),
                    option(4, 9000, pipeline(8, 8, 3), false)};
  advice.recommended = 1;
  advice.fails_first = {.metric = "AMD", .stage = "USB delivery", .share = 0.46};
  return advice;
}

TEST(AdviceReport, AnswersWithTheRecommendedRig) {
  const std::string answer = whole_text(advice_answer(sample()));
  EXPECT_THAT(answer, HasSubstr("meets amd<0.1ms for 8 cameras at 60 Hz in 72 of 72 simulated"));
  EXPECT_THAT(answer, HasSubstr("with pps.poll.yoon2021"));
  EXPECT_THAT(answer, HasSubstr("price class middle (1500-3000 EUR)"));
  EXPECT_THAT(answer, HasSubstr("2: the limit over the 95 % quantile"));
  EXPECT_THAT(answer, HasSubstr("The stage USB delivery, which makes 46.0 % of the AMD."));
}

TEST(AdviceReport, NamesTheNearestWhereNoneMeetsIt) {
  Advice advice = sample();
  advice.recommended.reset();
  advice.options.pop_back();
  advice.options.back() = option(2, 1500, pipeline(60, 72, 0.9), true);
  EXPECT_THAT(advice_answer(advice).lead,
              testing::AllOf(StartsWith("None of 2 rigs meets amd<0.1ms for 8 cameras at 60 Hz"),
                             HasSubstr("60 of 72 simulated rigs do, at a margin of 0.9")));
}

// 69 of 72 are 95.8 %, but as few as 88 % of all rigs may do.
TEST(AdviceReport, AShareOfNinetyFivePercentIsNotShownByItsInterval) {
  Advice advice = sample();
  advice.recommended.reset();
  advice.options = {option(2, 1500, pipeline(69, 72, 1.1), true)};
  EXPECT_THAT(advice_answer(advice).lead,
              testing::AllOf(StartsWith("No rig is shown to meet amd<0.1ms"),
                             HasSubstr("69 of 72 simulated rigs do, a probability of 88 to 99 %")));
  EXPECT_EQ(advice_document(advice).blocks[0].table->rows[0][3], "perhaps");
}

TEST(AdviceReport, AMarginWithoutAValueSaysSo) {
  Advice advice = sample();
  advice.recommended.reset();
  advice.options = {option(2, 1500, pipeline(0, 72, evaluation::kNan), true)};
  EXPECT_THAT(advice_answer(advice).lead, HasSubstr("at no margin, since a metric that is asked"));
  EXPECT_EQ(advice_document(advice).blocks[0].table->rows[0][3], "no");
}

TEST(AdviceReport, HasAVerdictForEachRig) {
  Advice advice = sample();
  advice.options.push_back(option(8, 20000, pipeline(8, 8, 3), true));
  advice.options.back().pipelines[0].frames_dropped = 1;
  const Document document = advice_document(advice);
  EXPECT_EQ(document.title, "8 cameras at 60 Hz: amd<0.1ms");
  ASSERT_EQ(document.blocks.size(), 2U);
  const Table& table = *document.blocks[0].table;
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(table.rows[0][3], "no");
  EXPECT_EQ(table.rows[1][3], "yes");
  EXPECT_EQ(table.rows[2][3], "perhaps") << "8 of 8 are too few for 95 %";
  EXPECT_EQ(table.rows[3][3], "no: USB drops frames");
  EXPECT_THAT(plain(document), HasSubstr("pps + poll + yoon2021"));
}

TEST(AdviceReport, StatesEachPartOnce) {
  const Document document = advice_document(sample());
  EXPECT_EQ(document.blocks[1].items.size(), 3U);
  EXPECT_THAT(document.blocks[1].items[0], StartsWith("small_pc: A small computer; nothing"));
}

TEST(AdviceReport, IsJson) {
  const auto json = nlohmann::json::parse(file_text(advice_json(sample())));
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["answer"]["lead"], advice_answer(sample()).lead);
  EXPECT_EQ(json["answer"]["lines"][1]["label"], "Margin");
  EXPECT_EQ(json["cameras"], 8);
  EXPECT_EQ(json["rate_hz"], 60);
  EXPECT_EQ(json["requirements"][0], "amd<0.1ms");
  EXPECT_EQ(json["seeds"]["first"], 5);
  EXPECT_EQ(json["recommended"], 1);
  EXPECT_EQ(json["fails_first"]["stage"], "USB delivery");
  EXPECT_TRUE(json["rare"].is_null());
  ASSERT_EQ(json["options"].size(), 3U);
  EXPECT_EQ(json["options"][0]["hosts"], 1);
  EXPECT_EQ(json["options"][0]["parts"], nlohmann::json({"small_pc"}));
  const auto& best = json["options"][1]["pipelines"][0];
  EXPECT_EQ(best["met"], 72);
  EXPECT_EQ(best["probability"], 1);
  EXPECT_EQ(best["medians"]["amd_ms"], 0.025);
}

TEST(AdviceReport, ClassesPricesByTheirMiddle) {
  EXPECT_EQ(price_class({60, 180}), "low (60-180 EUR)");
  EXPECT_EQ(price_class({800, 1200}), "middle (800-1200 EUR)");
  EXPECT_EQ(price_class({9000, 12000}), "high (9000-12000 EUR)");
}

}  // namespace
}  // namespace simbench::reports
