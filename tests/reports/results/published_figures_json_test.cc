
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "reports/archive/archive.h"
#include "reports/results/json.h"
#include "scenarios/loader.h"
#include "tests/reports/sample_results.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(PublishedFiguresJson, HasWhatIsPublishedAndItsPlace) {
  const Json root = Json::parse(json(sample_figure_results()));
  const Json& figures = root.at("published_figures");
  ASSERT_EQ(figures.size(), 3U);
  const Json& bound = figures[0];
  EXPECT_EQ(bound["pipeline"], "yoon2021_both");
  EXPECT_EQ(bound["metric"], "amd_ms");
  EXPECT_EQ(bound["at_most"], 2.44);
  EXPECT_EQ(bound["conditions"], "a rig in a hall");
  EXPECT_EQ(bound["source"], "a paper");
  EXPECT_EQ(bound["percentile"], 50);
  EXPECT_NEAR(bound["percentile_interval"][0].get<double>(), 1.258, 0.001);
  EXPECT_EQ(bound["kept_percent"], 50);
  EXPECT_NEAR(bound["kept_percent_interval"][1].get<double>(), 98.742, 0.001);
  EXPECT_TRUE(bound["verdict"].is_null());
  EXPECT_EQ(figures[1]["at_least"], 3);
  EXPECT_EQ(figures[1]["kept_percent"], 0);
  EXPECT_TRUE(figures[1]["verdict"].is_null());
  EXPECT_EQ(figures[2]["value"], 0.75);
  EXPECT_FALSE(figures[2].contains("kept_percent"));
}

TEST(PublishedFiguresJson, IsNotThereWithoutFigures) {
  EXPECT_FALSE(Json::parse(json(sample_results())).contains("published_figures"));
}

TEST(PublishedFiguresJson, NamesEveryVerdict) {
  evaluation::Results results = sample_figure_results();
  using evaluation::FigureVerdict;
  results.published_figures[0].verdict = FigureVerdict::kHolds;
  results.published_figures[1].verdict = FigureVerdict::kInside;
  results.published_figures[2].verdict = FigureVerdict::kOutside;
  Json root;
  state_published_figures(results, root);
  EXPECT_EQ(root["published_figures"][0]["verdict"], "holds");
  EXPECT_EQ(root["published_figures"][1]["verdict"], "inside");
  EXPECT_EQ(root["published_figures"][2]["verdict"], "outside");
}

class FiguresInArchive : public testing::Test {
 protected:
  FiguresInArchive() {
    const scenarios::Scenario scenario = scenarios::load_scenario("3cam_1host_30fps");
    written_.scenario = scenario.name;
    OutputFolder output(folder_.path());
    write_archive(output, written_, scenario,
                  {.command = {"simbench", "run"}, .started = {}, .finished = {}});
  }

  // What reading says once each `from` is `to`.
  std::string problem_with(const std::string& from, const std::string& to) const {
    std::string text = folder_.content("results.json");
    const std::size_t figures = text.find("\"published_figures\"");
    const std::size_t at = text.find(from, figures);
    if (at == std::string::npos) return "nothing to replace";
    folder_.write("results.json", text.replace(at, from.size(), to));
    try {
      read_archive(folder_.path().string());
    } catch (const scenarios::InputError& error) {
      return error.what();
    }
    return "nothing";
  }

  ScratchFolder folder_;
  evaluation::Results written_ = sample_figure_results();
};

TEST_F(FiguresInArchive, AreReadAndWrittenAgain) {
  const evaluation::Results read = read_archive(folder_.path().string()).results;
  ASSERT_EQ(read.published_figures.size(), 3U);
  EXPECT_EQ(read.published_figures[0].figure.at_most, 2.44);
  EXPECT_EQ(read.published_figures[0].figure.conditions, "a rig in a hall");
  EXPECT_EQ(read.published_figures[1].figure.at_least, 3);
  EXPECT_EQ(Json::parse(json(read)).at("published_figures"),
            Json::parse(json(written_)).at("published_figures"));
}

TEST_F(FiguresInArchive, AreComparedAnew) {
  EXPECT_EQ(problem_with("\"verdict\": null", "\"verdict\": \"holds\""), "nothing");
  const evaluation::Results read = read_archive(folder_.path().string()).results;
  EXPECT_EQ(read.published_figures.at(0).verdict, evaluation::FigureVerdict::kTooFewSeeds);
}

TEST_F(FiguresInArchive, AreRefusedWithoutAMetricOfSeeds) {
  EXPECT_THAT(problem_with("\"metric\": \"amd_ms\"", "\"metric\": \"margin_ms\""),
              AllOf(HasSubstr("/published_figures/0/metric"), HasSubstr("margin_ms"),
                    HasSubstr("a metric with a value of each seed")));
}

TEST_F(FiguresInArchive, AreRefusedWithoutARow) {
  EXPECT_THAT(problem_with("\"pipeline\": \"yoon2021_both\"", "\"pipeline\": \"none\""),
              AllOf(HasSubstr("/published_figures/0/pipeline"), HasSubstr("a pipeline of /rows")));
}

TEST_F(FiguresInArchive, AreRefusedWithoutExactlyOneNumber) {
  EXPECT_THAT(problem_with("\"at_most\": 2.44", "\"at_most\": 2.44, \"value\": 1"),
              AllOf(HasSubstr("/published_figures/0"),
                    HasSubstr("exactly one of at_most, value and at_least")));
}

TEST_F(FiguresInArchive, AreRefusedWithANumberThatTheMetricCannotHave) {
  EXPECT_THAT(problem_with("\"at_most\": 2.44", "\"at_most\": -2"),
              AllOf(HasSubstr("/published_figures/0/at_most"), HasSubstr("a number from 0")));
}

}  // namespace
}  // namespace simbench::reports
