// The page as text: what stands in it, and what may not. How it looks and behaves is tested in a
// browser (tests/browser/).
#include "reports/page/html_report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "reports/page/html_page.h"
#include "reports/results/results_document.h"
#include "reports/text/escaped_text.h"
#include "reports/text/json_node.h"
#include "tests/reports/sample_figures.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

ReportedArchive monday_archive() {
  Archive archive;
  archive.path = "results/monday";
  archive.version = "0.1.0";
  archive.commit = "abc";
  archive.command = {"build/bin/simbench", "run", "--scenario", "it's mine.json"};
  archive.started = "2026-11-21T05:00:00.000Z";
  archive.finished = "2026-11-21T05:00:02.000Z";
  archive.scenario_json = R"({"name": "sample", "summary": "A rig.", "hosts": {"count": 6}})";
  archive.results = sample_results();
  return {.archive = archive, .figures = sample_figures(), .notes = {"a note"}};
}

std::string page_of(const std::vector<ReportedArchive>& archives) {
  return html_report({.archives = archives, .command = {"simbench", "report", "results/monday"}});
}

// What the page's script reads.
Json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" class=\"data\">";
  const std::size_t start = page.find(open) + open.size();
  return Json::parse(page.substr(start, page.find("</script>", start) - start));
}

// Not HasSubstr: a failure would print the page, which is long.
bool has(const std::string& page, const std::string& part) {
  return page.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(HtmlReport, HasTheNumbersOfTheTable) {
  const std::string page = page_of({monday_archive()});
  for (const char* part :
       {"<th scope=\"row\" class=\"text\">yoon2021_both</th><td>2.00 ms</td><td>[1.50, 2.50] "
        "ms</td>",
        "<td>2.44 ms</td><td class=\"text\">inside</td><td>50 % [32-68]</td>",
        "<td class=\"text\">not attainable</td>", "<td>29.0 ms</td>", "<td>75.0 %</td>",
        "none is worst", "(needs 18cam_6host_15fps)", "a host was not synchronised",
        "1.23 M events", "2 seeds (1-2)", "0.1.0 (abc)", "A rig.", "a note"}) {
    EXPECT_TRUE(has(page, part)) << part;
  }
}

ReportedArchive reported(evaluation::Results results) {
  ReportedArchive archive = monday_archive();
  archive.archive.results = std::move(results);
  return archive;
}

// Whatever `simbench run` prints of results stands on their page too.
TEST(HtmlReport, SaysWhatTheTerminalSays) {
  for (const evaluation::Results& results :
       {sample_results(), sample_rig_results(), sample_genlock_results()}) {
    const std::string page = page_of({reported(results)});
    std::size_t cells = 0;
    for (const Block& block : results_document(results, "").blocks) {
      EXPECT_TRUE(has(page, html_escaped(block.heading))) << block.heading;
      for (const std::string& text : block.prose)
        EXPECT_TRUE(has(page, html_escaped(text))) << text;
      for (const std::string& text : block.items)
        EXPECT_TRUE(has(page, html_escaped(text))) << text;
      if (!block.table) continue;
      for (const auto& row : block.table->rows) {
        for (const std::string& cell : row) {
          ++cells;
          EXPECT_TRUE(has(page, ">" + html_escaped(cell) + "<")) << cell;
        }
      }
    }
    EXPECT_GT(cells, 30U);
  }
}

TEST(HtmlReport, ARealRigMeetsNoCommonWorlds) {
  const std::string page = page_of({reported(sample_rig_results())});
  EXPECT_FALSE(has(page, "meets the same worlds"));
  EXPECT_TRUE(has(page, "Every repetition of a pipeline is a capture of its own."));
  EXPECT_TRUE(has(page, "<td class=\"text\">unverified</td>"));
  EXPECT_TRUE(has(page, "<li>yoon2021_both, repetition 2: camera 7 was unplugged</li>"));
  EXPECT_TRUE(has(page_of({monday_archive()}), "Every pipeline meets the same worlds"));
}

TEST(HtmlReport, IndexErrorsOfUnverifiedSetsAreNotKnown) {
  evaluation::Results results = sample_rig_results();
  results.rows[1].gathering = "epsilon";  // so that the sets are shown
  EXPECT_TRUE(has(page_of({reported(results)}),
                  "<td class=\"text\">yoon2021</td><td>720</td><td>-</td><td>-</td><td>-</td>"
                  "<td>4</td>"));
}

TEST(HtmlReport, ARealRigSimulatesNoSeconds) {
  const std::string page = page_of({reported(sample_rig_results())});
  EXPECT_FALSE(has(page, "simulated seconds"));
  EXPECT_FALSE(has(page, "events/s"));
  EXPECT_TRUE(has(page, "Cost: 0.25 s (0.50 s of CPU)."));
}

TEST(HtmlReport, ABoardOfGatheringIsAboutSets) {
  evaluation::Results results = sample_results();
  results.rows.resize(1);
  for (const char* name : {"yoon2021", "epsilon"}) {
    evaluation::Row row = results.rows.front();
    row.pipeline = fmt::format("sets.{}", name);
    row.gathering = name;
    results.rows.push_back(row);
  }
  for (const bool real : {false, true}) {
    if (real) {
      for (evaluation::Row& row : results.rows) row.ground_truth = evaluation::GroundTruth::kNone;
    }
    ReportedArchive archive = reported(results);
    archive.archive.scenario_json = R"({"evaluation": {"table": "leaderboard"}})";
    const std::string page = page_of({archive});
    const std::size_t heading =
        page.find("<h3>sets: yoon2021_both + regression_30 + each gathering");
    ASSERT_NE(heading, std::string::npos);
    const std::string board = page.substr(heading, page.find("</section>", heading) - heading);
    EXPECT_TRUE(has(board, "index errors</th>"));
    EXPECT_FALSE(has(board, "oracle&#39;s</th>"));
    EXPECT_EQ(has(page, "meets the same worlds"), !real);
    // The references beside it have their errors.
    EXPECT_TRUE(has(page, "error / oracle&#39;s</th>"));
  }
}

TEST(HtmlReport, SaysHowToReproduceIt) {
  const std::string page = page_of({monday_archive()});
  EXPECT_TRUE(has(page, "simbench run --scenario &#39;it&#39;\\&#39;&#39;s mine.json&#39;"));
  EXPECT_TRUE(has(page, "simbench report results/monday<"));
  EXPECT_TRUE(has(page, "simbench figure frame_errors results/monday -o frame_errors.svg"));
  EXPECT_TRUE(has(page, "&quot;count&quot;: 6"));
}

TEST(HtmlReport, AsksNothingOfAnyServer) {
  const std::string page = page_of({monday_archive()});
  EXPECT_TRUE(has(page, "Content-Security-Policy\" content=\"default-src 'none'"));
  EXPECT_FALSE(has(page, "src="));
  EXPECT_FALSE(has(page, "@import"));
  // Only of the page's own parts.
  EXPECT_EQ(count(page, "url("), count(page, "url(#"));
  EXPECT_EQ(count(page, "href="), count(page, "href=\"data:,\""));
  EXPECT_TRUE(has(page, "The MIT License"));  // uPlot's, which has to come along
}

TEST(HtmlReport, HoldsTheFiguresAsData) {
  const Json data = data_of(page_of({monday_archive()}));
  ASSERT_EQ(data["figures"].size(), 7U);
  const Json& curves = data["figures"][0];
  EXPECT_EQ(curves["id"], "frame_errors");
  EXPECT_EQ(curves["seed"], "1");
  const Json& panel = curves["panels"][0];
  EXPECT_EQ(panel["x_is_pulse"], true);
  EXPECT_EQ(panel["lines"][0]["at"], 2.438);
  EXPECT_EQ(panel["spans"][0]["to"], 260);
  EXPECT_EQ(panel["series"][1]["mark"], "steps");
  // One column of pulses for all curves of all pipelines and seeds.
  const std::size_t pulses = panel["series"][0]["x"];
  EXPECT_EQ(data["columns"][pulses]["n"], 300);
  EXPECT_EQ(data["figures"][2]["panels"][0]["series"][1]["x"], pulses);
  EXPECT_EQ(data["figures"][6]["absent"], "This scenario has one host.");
  EXPECT_EQ(data["figures"][5]["photographs"][1]["photographs"][0]["readings"][0]["share"], 0.6);
  EXPECT_TRUE(data["figures"][3]["seed"].is_null());
}

TEST(HtmlReport, MarkupInNamesIsText) {
  const std::string evil = "</script><img src=x onerror=alert(1)>\"'&";
  ReportedArchive archive = monday_archive();
  archive.archive.path = evil;
  archive.archive.version = evil;
  archive.archive.command = {evil, evil};
  archive.archive.scenario_json = Json{{"summary", evil}}.dump();
  archive.archive.results.scenario = evil;
  archive.archive.results.warnings = {evil};
  archive.archive.results.claims[0].text = evil;
  for (auto& row : archive.archive.results.rows) row.pipeline = row.gathering = evil;
  archive.notes = {evil};
  for (Figure& figure : archive.figures) figure.title = figure.caption = figure.id = evil;
  const std::string page =
      html_report({.archives = {archive, archive}, .command = {"simbench", evil}});
  EXPECT_FALSE(has(page, "<img"));
  // Each script ends once, and nothing ends one before.
  EXPECT_EQ(count(page, "</script>"), count(page, "<script"));
  EXPECT_EQ(data_of(page_of({archive}))["figures"][0]["title"], evil);
}

TEST(HtmlReport, SeveralArchivesAreComparedAndKeptApart) {
  ReportedArchive tuesday = monday_archive();
  tuesday.archive.path = "results/tuesday";
  tuesday.archive.results.rows[0].amd_ms = series(3, 5);
  tuesday.archive.results.rows.pop_back();
  const std::string page = page_of({monday_archive(), tuesday});
  EXPECT_TRUE(has(page, "The archives side by side"));
  EXPECT_TRUE(has(page,
                  "<td>2.00 ms [1.50, 2.50] ms</td><td>29.0 ms [28.0, 30.0] ms</td>"
                  "<td>4.00 ms [3.00, 5.00] ms</td>"));
  // One article compares them seed by seed.
  EXPECT_EQ(count(page, "<article class=\"archive\""), 3U);
  EXPECT_EQ(count(page, "class=\"data\">"), 3U);
  EXPECT_LT(page.find("<h2>results/tuesday against results/monday</h2>"),
            page.find("The archives side by side"));
  EXPECT_EQ(data_of(page)["figures"][0]["id"], "compared_distributions");
  EXPECT_FALSE(has(page_of({tuesday}), "The archives side by side"));
}

TEST(HtmlReport, ArchivesThatCannotBePairedSayWhy) {
  ReportedArchive tuesday = monday_archive();
  tuesday.archive.path = "results/tuesday";
  tuesday.archive.results.first_seed = 100;
  const std::string page = page_of({monday_archive(), tuesday});
  EXPECT_EQ(count(page, "<article class=\"archive\""), 2U);
  EXPECT_LT(page.find("The archives side by side"), page.find("<article"));
  EXPECT_TRUE(has(page, "Not compared seed by seed: "));
  EXPECT_TRUE(has(page, "none in common"));
}

TEST(HtmlReport, TheFirstOfThreeIsComparedWithTheOthers) {
  ReportedArchive tuesday = monday_archive();
  ReportedArchive wednesday = monday_archive();
  tuesday.archive.path = "results/tuesday";
  wednesday.archive.path = "results/wednesday";
  tuesday.archive.results.first_seed = 100;
  const std::string page = page_of({monday_archive(), tuesday, wednesday});
  EXPECT_EQ(count(page, "<article class=\"archive\""), 4U);
  EXPECT_TRUE(has(page, "<h2>results/wednesday against results/monday</h2>"));
  EXPECT_TRUE(has(page, "Not compared seed by seed: "));
}

TEST(HtmlReport, WithoutAManifestItSaysWhatIsMissing) {
  ReportedArchive archive = monday_archive();
  archive.archive.scenario_json.clear();
  archive.archive.command.clear();
  archive.archive.started.clear();
  archive.figures.clear();
  const std::string page = page_of({archive});
  EXPECT_TRUE(has(page, "holds neither the scenario nor the command"));
  EXPECT_FALSE(has(page, "simbench figure"));
}

TEST(HtmlReport, EqualInputGivesEqualBytes) {
  EXPECT_EQ(page_of({monday_archive()}), page_of({monday_archive()}));
}

}  // namespace
}  // namespace simbench::reports
