#include "app/figure_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "reports/figures/figure.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::app {
namespace {

using reports::Archive;
using reports::Figure;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kScenario = "18cam_6host_45fps";

scenarios::Scenario short_scenario() {
  return scenarios::load_scenario(kScenario, {{"/timeline/frames", "60"}});
}

// As if it had been written and read again.
Archive archive_of(const scenarios::Scenario& scenario, std::uint64_t seeds) {
  Archive archive;
  archive.path = "results";
  archive.version = "0";
  archive.scenario_json = scenario.resolved_json();
  archive.results = evaluation::evaluate(
      scenario, [&] { return sim::make_simulation(scenario); },
      {.first_seed = 5, .seeds = seeds, .keep_pulses = true}, nullptr);
  return archive;
}

bool has_data(const Figure& figure) {
  if (!figure.photographs.empty()) return !figure.photographs.front().photographs.empty();
  for (const reports::FigurePanel& panel : figure.panels) {
    for (const reports::FigureSeries& series : panel.series) {
      for (const double y : series.y) {
        if (!std::isnan(y)) return true;
      }
    }
  }
  return false;
}

TEST(FigureSourceTest, EveryFigureOfTheCatalogueHasDataForTheDefaultScenario) {
  const scenarios::Scenario scenario = short_scenario();
  const ArchiveFigures made = scenario_figures(
      scenario, {.pipelines = {"ntp_last_set", "yoon2021_both", "genlock"}, .budget_seeds = 1}, 2);
  EXPECT_THAT(made.notes, IsEmpty());
  std::set<std::string> ids;
  for (const Figure& figure : nonempty(made.figures)) {
    ids.insert(figure.id);
    EXPECT_TRUE(figure.absent.empty()) << figure.id << ": " << figure.absent;
    EXPECT_TRUE(has_data(figure)) << figure.id;
    EXPECT_FALSE(figure.title.empty()) << figure.id;
    EXPECT_FALSE(figure.caption.empty()) << figure.id;
    for (const reports::FigurePanel& panel : figure.panels) {
      for (const reports::FigureSeries& series : panel.series) {
        EXPECT_EQ(series.x.size(), series.y.size()) << figure.id;
        EXPECT_TRUE(series.mark == reports::Mark::kPoints ||
                    std::is_sorted(series.x.begin(), series.x.end()))
            << figure.id << ", " << series.label;
      }
    }
  }
  for (const reports::FigureEntry& entry : nonempty(reports::figure_catalogue())) {
    if (entry.scope == reports::FigureScope::kRecording) continue;
    if (entry.id == reports::kCodeFigure) continue;  // its trigger has none
    EXPECT_THAT(ids, Contains(entry.id));
  }
}

TEST(FigureSourceTest, TheMeanOfFrameErrorsIsTheArchivesAmd) {
  Archive archive = archive_of(short_scenario(), 2);
  const ArchiveFigures made =
      archive_figures(archive, {.seeds = {5, 6}, .figures = {"frame_errors"}});
  ASSERT_THAT(made.figures, SizeIs(2));
  for (std::size_t seed = 0; seed < 2; ++seed) {
    EXPECT_EQ(made.figures[seed].seed, 5 + seed);
    ASSERT_THAT(made.figures[seed].panels, SizeIs(2));
    ASSERT_THAT(made.figures[seed].panels[0].series, SizeIs(4));
    for (const reports::FigureSeries& series : made.figures[seed].panels[0].series) {
      double sum = 0;
      for (const double y : series.y) sum += y;
      const std::vector<evaluation::Row>& rows = archive.results.rows;
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const evaluation::Row& each) {
        return each.pipeline == series.label;
      });
      ASSERT_NE(row, rows.end()) << series.label;
      EXPECT_NEAR(sum / static_cast<double>(series.y.size()), row->amd_ms.values[seed], 1e-9);
    }
  }
}

TEST(FigureSourceTest, ARepeatedRunThatDiffersIsLeftOutAndSaidSo) {
  Archive archive = archive_of(short_scenario(), 1);
  archive.results.rows[4].amd_ms.values[0] *= 1.000001;
  const ArchiveFigures made = archive_figures(archive, {.figures = {"hosts"}});
  EXPECT_THAT(made.figures, SizeIs(archive.results.rows.size() - 1));
  ASSERT_THAT(made.notes, SizeIs(1));
  EXPECT_THAT(made.notes[0], HasSubstr("yoon2021_both, seed 5"));
}

TEST(FigureSourceTest, FiguresComeInTheOrderOfTheCatalogue) {
  Archive archive = archive_of(short_scenario(), 1);
  const ArchiveFigures made = archive_figures(
      archive, {.pipelines = {"oracle"}, .figures = {"fig5", "synchronisation", "frame_errors"}});
  ASSERT_THAT(made.figures, SizeIs(3));
  EXPECT_EQ(made.figures[0].id, "frame_errors");
  EXPECT_EQ(made.figures[1].id, "synchronisation");
  EXPECT_EQ(made.figures[2].id, "hosts");
  EXPECT_EQ(made.figures[2].pipeline, "oracle");
}

// Worlds are shared by the pipelines of a seed, and by their budgets.
TEST(FigureSourceTest, PipelinesTogetherHaveTheFiguresOfEachAlone) {
  Archive archive = archive_of(short_scenario(), 2);
  FigureOptions options = {.seeds = {5, 6},
                           .pipelines = {"yoon2021_both", "oracle", "genlock"},
                           .budget_seeds = 1,
                           .figures = {"hosts", "fig7", "budget"}};
  std::vector<std::string> together;
  for (const Figure& figure : archive_figures(archive, options).figures) {
    together.push_back(figure_csv(figure));
  }
  std::vector<std::string> alone;
  for (const std::string pipeline : {"yoon2021_both", "oracle", "genlock"}) {
    options.pipelines = {pipeline};
    for (const Figure& figure : archive_figures(archive, options).figures) {
      alone.push_back(figure_csv(figure));
    }
  }
  EXPECT_GT(together.size(), 9U);
  EXPECT_THAT(together, ::testing::UnorderedElementsAreArray(alone));
}

TEST(FigureSourceTest, WithoutAManifestOnlyWhatIsInTheResultsIsDrawn) {
  Archive archive = archive_of(short_scenario(), 1);
  archive.scenario_json.clear();
  const ArchiveFigures made = archive_figures(archive, {.figures = {"hosts", "distributions"}});
  ASSERT_FALSE(made.figures.empty());
  for (const Figure& figure : made.figures) EXPECT_EQ(figure.id, "distributions");
  ASSERT_THAT(made.notes, SizeIs(1));
  EXPECT_THAT(made.notes[0], HasSubstr("no manifest"));
}

TEST(FigureSourceTest, UnknownNamesAreRefused) {
  Archive archive = archive_of(short_scenario(), 1);
  EXPECT_THROW(archive_figures(archive, {.figures = {"fig99"}}), scenarios::InputError);
  EXPECT_THROW(archive_figures(archive, {.seeds = {6}}), scenarios::InputError);
  EXPECT_THROW(archive_figures(archive, {.pipelines = {"none"}}), scenarios::InputError);
}

TEST(FigureSourceTest, ARigOfOneCameraHasFiguresOrReasons) {
  const scenarios::Scenario scenario = scenarios::load_scenario(
      "3cam_1host_30fps", {{"/timeline/frames", "30"}, {"/cameras/count", "1"}});
  const ArchiveFigures made = scenario_figures(scenario, {}, 1);
  for (const Figure& figure : nonempty(made.figures)) {
    EXPECT_NE(has_data(figure), !figure.absent.empty()) << figure.id;
  }
}

}  // namespace
}  // namespace simbench::app
