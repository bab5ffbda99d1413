#include "reports/figures/gnuplot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "evaluation/statistics/statistics.h"
#include "reports/figures/figure.h"
#include "reports/text/output_file.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using evaluation::kNan;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

FigureSeries line_series(const std::string& label, std::vector<double> y, int colour) {
  FigureSeries made;
  made.label = label;
  made.mark = Mark::kLine;
  for (std::size_t i = 0; i < y.size(); ++i) made.x.push_back(static_cast<double>(i));
  made.y = std::move(y);
  made.colour = colour;
  return made;
}

Figure sample_figure() {
  FigurePanel panel;
  panel.title = "It's a title, \"quoted\" \\n";
  panel.x_label = "pulse";
  panel.y_label = "ms";
  panel.series = {line_series("host 0, camera 0", {1, kNan, 2.5}, 0),
                  line_series("host 0, camera 1", {2, 3, 4}, 0), line_series("mine", {5, 6, 7}, 1)};
  panel.lines = {{.label = "mine, published", .at = 5.5, .colour = 1}, {"start", true, 1}};
  panel.spans = {{"warm-up", 0, 1}};
  Figure figure;
  figure.id = "sample";
  figure.title = "Sample";
  figure.panels = {panel, panel};
  return figure;
}

Figure photographs() {
  Figure figure;
  figure.title = "Photographs";
  figure.photographs = {
      {"mine", {{"host 0, camera 0", {{"00:01.008", 0.75}, {"00:01.016", 0.25}}}}}};
  return figure;
}

// The source names a changed world.
FigureSource sample_source() {
  return {.scenario = "sample",
          .derivation = {.base = "sample", .changes = {{"/a", "1", "2"}}},
          .pipeline = "mine",
          .first_seed = 7,
          .seeds = 2,
          .version = "1.2.3",
          .commit = "abc"};
}

class GnuplotTest : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_ / name; }
  std::string content(const std::string& name) const { return folder_.content(name); }
  std::size_t files() const { return folder_.names().size(); }

  const ScratchFolder folder_;
};

TEST_F(GnuplotTest, DrawsPanelsAsSvg) {
  draw(sample_figure(), PlotFormat::kSvg, file("x.svg"));
  const std::string svg = content("x.svg");
  EXPECT_THAT(svg, StartsWith("<?xml"));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, HasSubstr("It's a title, \"quoted\" \\n"));
  EXPECT_THAT(svg, HasSubstr("mine, published"));
  EXPECT_THAT(svg, HasSubstr("warm-up"));
  EXPECT_EQ(files(), 1U);
}

TEST_F(GnuplotTest, AnSvgHasTheTitleAndTheSourceOfItsFigure) {
  for (Figure figure : {sample_figure(), photographs()}) {
    figure.title = "A & B";
    figure.source = sample_source();
    draw(figure, PlotFormat::kSvg, file("x.svg"));
    const std::string svg = content("x.svg");
    EXPECT_THAT(svg, HasSubstr("<title>A &amp; B</title>\n<desc>sample (changed), mine, 2 seeds "
                               "(7-8), simbench 1.2.3 (abc); changed: /a 1 → 2</desc>"));
    EXPECT_THAT(svg, Not(HasSubstr("Gnuplot")));
    const std::string script = gnuplot_script(figure, PlotFormat::kPdf, "x.pdf");
    EXPECT_THAT(script, HasSubstr("'sample (changed), mine, 2 seeds (7-8), simbench 1.2.3 (abc)'"));
    EXPECT_THAT(script, HasSubstr("'changed: /a 1 → 2'"));
  }
}

TEST(FigureSourceTest, CutsManyChangesAndMayBeUnknown) {
  FigureSource source = sample_source();
  source.pipeline = "";
  source.derivation.changes.assign(8, {"/a", "1", ""});
  const std::vector<std::string> lines = source_lines(source);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "sample (changed), 2 seeds (7-8), simbench 1.2.3 (abc)");
  EXPECT_THAT(lines[1], testing::EndsWith(", /a 1 → none, and 2 more"));
  EXPECT_TRUE(source_lines({}).empty());
}

TEST_F(GnuplotTest, SeriesOfOneColourAreOneEntryOfTheLegend) {
  const std::string script = gnuplot_script(sample_figure(), PlotFormat::kSvg, "x.svg");
  EXPECT_THAT(script, HasSubstr("title 'host 0'"));
  EXPECT_THAT(script, Not(HasSubstr("'host 0, camera 1'")));
}

TEST_F(GnuplotTest, ALineHasTheColourOfItsSeriesOrNone) {
  const std::string script = gnuplot_script(sample_figure(), PlotFormat::kSvg, "x.svg");
  EXPECT_THAT(script, HasSubstr("lw 1.2 dt 3 lc rgb '#D55E00' title 'mine, published'"));
  EXPECT_THAT(script, HasSubstr("lw 1.2 dt 3 lc rgb '#555555' title 'start'"));
}

TEST_F(GnuplotTest, BandsAreDrawnAndWithinTheAxis) {
  Figure figure = sample_figure();
  figure.panels.pop_back();
  FigureSeries& marked = figure.panels[0].series[2];
  marked.mark = Mark::kMarkedLine;
  marked.low = {4, 5, 6};
  marked.high = {9, 9, 20};
  const std::string script = gnuplot_script(figure, PlotFormat::kSvg, "x.svg");
  EXPECT_THAT(script, HasSubstr("\n2 7 6 20\n"));
  EXPECT_THAT(script, HasSubstr("using 1:3:4 with filledcurves"));
  EXPECT_THAT(script, HasSubstr("with linespoints"));
  EXPECT_THAT(script, HasSubstr("set yrange [-0.1"));  // 1 to 20 and some room
  marked.mark = Mark::kPoints;
  EXPECT_THAT(gnuplot_script(figure, PlotFormat::kSvg, "x.svg"),
              HasSubstr("using 1:2:3:4 with yerrorbars"));
  draw(figure, PlotFormat::kSvg, file("x.svg"));
  EXPECT_EQ(files(), 1U);
}

TEST_F(GnuplotTest, BarsOfOneCategoryStandSideBySide) {
  Figure figure = sample_figure();
  figure.panels.pop_back();
  FigurePanel& panel = figure.panels[0];
  panel.categories = {"a", "b", "c"};
  panel.series.resize(2);
  for (FigureSeries& bars : panel.series) bars.mark = Mark::kBars;
  const std::string script = gnuplot_script(figure, PlotFormat::kSvg, "x.svg");
  EXPECT_THAT(script, HasSubstr("$data0 using ($1+(-0.175)):2:(0.35) with boxes"));
  EXPECT_THAT(script, HasSubstr("$data1 using ($1+(0.175)):2:(0.35) with boxes"));
  draw(figure, PlotFormat::kSvg, file("x.svg"));
}

TEST_F(GnuplotTest, DrawsPhotographsAsPdf) {
  draw(photographs(), PlotFormat::kPdf, file("x.pdf"));
  EXPECT_THAT(content("x.pdf"), StartsWith("%PDF"));
  draw(photographs(), PlotFormat::kSvg, file("x.svg"));
  EXPECT_THAT(content("x.svg"), HasSubstr("00:01.016"));
  EXPECT_THAT(content("x.svg"), HasSubstr("25 %"));
}

TEST_F(GnuplotTest, AFigureOfConstantsAndNothingElseIsDrawn) {
  Figure figure = sample_figure();
  for (FigurePanel& panel : figure.panels) {
    panel.log_y = true;
    panel.lines.clear();
    for (FigureSeries& each : panel.series) each.y.assign(each.y.size(), 0);
  }
  figure.panels[1].series[0] = line_series("nothing", {kNan}, 0);
  draw(figure, PlotFormat::kSvg, file("x.svg"));
  EXPECT_THAT(content("x.svg"), HasSubstr("</svg>"));
}

TEST_F(GnuplotTest, WithoutGnuplotNothingIsWrittenAndTheMessageSaysWhatToInstall) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  std::string message;
  try {
    draw(sample_figure(), PlotFormat::kSvg, file("x.svg"));
  } catch (const OutputError& error) {
    message = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(message, HasSubstr("apt-get install gnuplot-nox"));
  EXPECT_EQ(files(), 0U);
}

TEST_F(GnuplotTest, WhatGnuplotRefusesLeavesNothingBehind) {
  folder_.write("gnuplot", "#!/bin/sh\necho 'line 7: no' >&2\nexit 1\n");
  fs::permissions(folder_ / "gnuplot", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder_.path().string() + ":" + path).c_str(), 1);
  std::string message;
  try {
    draw(sample_figure(), PlotFormat::kSvg, file("x.svg"));
  } catch (const OutputError& error) {
    message = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(message, HasSubstr("line 7: no"));
  EXPECT_EQ(files(), 1U);  // the false gnuplot
}

TEST_F(GnuplotTest, AMissingFolderIsRefused) {
  EXPECT_THROW(draw(sample_figure(), PlotFormat::kSvg, file("none/x.svg")), OutputError);
}

TEST(FigureCsvTest, HasALineForEveryPoint) {
  Figure figure = sample_figure();
  figure.panels.pop_back();
  figure.panels[0].title = "A, B";
  EXPECT_EQ(figure_csv(figure),
            "panel,series,x,y\n"
            "\"A, B\",\"host 0, camera 0\",0,1\n"
            "\"A, B\",\"host 0, camera 0\",1,\n"
            "\"A, B\",\"host 0, camera 0\",2,2.5\n"
            "\"A, B\",\"host 0, camera 1\",0,2\n"
            "\"A, B\",\"host 0, camera 1\",1,3\n"
            "\"A, B\",\"host 0, camera 1\",2,4\n"
            "\"A, B\",mine,0,5\n"
            "\"A, B\",mine,1,6\n"
            "\"A, B\",mine,2,7\n"
            "\"A, B\",\"mine, published\",,5.5\n"
            "\"A, B\",start,1,\n"
            "\"A, B\",warm-up,0,\n"
            "\"A, B\",warm-up,1,\n");
}

TEST(FigureCsvTest, AChangedWorldHasAColumn) {
  Figure figure;
  FigurePanel panel;
  panel.title = "AMD";
  panel.series = {line_series("mine", {2}, 0)};
  figure.panels = {panel};
  figure.source = sample_source();
  EXPECT_EQ(figure_csv(figure), "panel,series,x,y,changed\nAMD,mine,0,2,changed: /a 1 → 2\n");
}

TEST(FigureCsvTest, ABandIsTwoMoreSeries) {
  Figure figure;
  FigurePanel panel;
  panel.title = "AMD";
  panel.series = {line_series("mine", {2}, 0)};
  panel.series[0].low = {1};
  panel.series[0].high = {3};
  figure.panels = {panel};
  EXPECT_EQ(figure_csv(figure),
            "panel,series,x,y\nAMD,mine,0,2\nAMD,\"mine, 5 %\",0,1\nAMD,\"mine, 95 %\",0,3\n");
}

TEST(FigureCsvTest, BarsHaveTheirCategoriesAndPhotographsTheirReadings) {
  Figure figure;
  FigurePanel panel;
  panel.title = "Parts";
  panel.categories = {"trigger", "host clock"};
  panel.series = {line_series("mean", {0.25, 3}, 0)};
  figure.panels = {panel};
  figure.photographs = photographs().photographs;
  EXPECT_EQ(figure_csv(figure),
            "panel,series,x,y\n"
            "Parts,mean,trigger,0.25\n"
            "Parts,mean,host clock,3\n"
            "mine,\"host 0, camera 0\",00:01.008,0.75\n"
            "mine,\"host 0, camera 0\",00:01.016,0.25\n");
}

}  // namespace
}  // namespace simbench::reports
