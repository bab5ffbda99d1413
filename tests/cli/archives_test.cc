// Archives of every release so far, as that release wrote them (tests/data/archives/), read by the
// commands of today: the values are those of the files. tools/freeze_archives writes a release's.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "recording/version.h"
#include "reports/text/metric_text.h"
#include "tests/cli/program.h"
#include "tests/data/test_data.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

struct Release {
  std::string version;

  std::string path(const std::string& name) const {
    return test_data_path("archives/" + version + "/" + name);
  }
  Json document(const std::string& name) const {
    return test_data_json("archives/" + version + "/" + name);
  }
};

void PrintTo(const Release& release, std::ostream* out) { *out << release.version; }

std::vector<Release> releases() {
  std::vector<Release> all;
  for (const auto& entry : fs::directory_iterator(test_data_path("archives"))) {
    all.push_back({entry.path().filename().string()});
  }
  std::ranges::sort(all, {}, &Release::version);
  return all;
}

class Archives : public ProgramTest, public testing::WithParamInterface<Release> {
 protected:
  std::string path(const std::string& name) const { return GetParam().path(name); }
  Json document(const std::string& name) const { return GetParam().document(name); }

  // The result of a command, which must end well and print JSON.
  Json result_of(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out, nullptr, false);
  }

  // A copy of a file or folder, whose file `edited` has `version` and the number of a format that
  // nobody knows yet.
  std::string newer(const std::string& name, const std::string& edited,
                    const std::string& format) const {
    const fs::path copy = folder() / name;
    fs::copy(path(name), copy, fs::copy_options::recursive);
    Json root = document(edited);
    root["version"] = "97.0.0";
    root.at(format) = 99;
    file(edited, root.dump(2) + "\n");
    return copy.string();
  }
};

INSTANTIATE_TEST_SUITE_P(Releases, Archives, testing::ValuesIn(releases()),
                         [](const auto& release) {
                           std::string name = release.param.version;
                           std::ranges::replace(name, '.', '_');
                           return name;
                         });

double mean_of(const Json& values) {
  const auto all = values.get<std::vector<double>>();
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

TEST_P(Archives, EachStatesWhoWroteItAndItsFormat) {
  for (const char* name :
       {"run/manifest.json", "run/results.json", "clocks/manifest.json", "clocks/results.json",
        "sweep/manifest.json", "sweep/answer.json", "recording/manifest.json", "baseline.json",
        "comparison.json", "replay.json", "fit.json"}) {
    const Json root = document(name);
    EXPECT_EQ(root.at("version"), GetParam().version) << name;
    EXPECT_FALSE(root.at("commit").get<std::string>().empty()) << name;
    EXPECT_GE(root.value("schema_version", root.value("format_version", 0)), 1) << name;
  }
  EXPECT_THAT(document("model.json").at("summary").get<std::string>(),
              HasSubstr(fmt::format("by simbench {}.", GetParam().version)));
}

TEST_P(Archives, ReportShowsTheirValues) {
  const ProgramResult result = run({"report", path("run"), "--output", "page.html",
                                    "--budget-seeds", "0", "--seeds-in-detail", "1"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = content("page.html");
  const Json rows = document("run/results.json").at("rows");
  for (const Json& row : nonempty(rows)) {
    for (const char* metric : {"amd_ms", "rmdv_ms"}) {
      const auto median = row.at(metric).at("median").get<double>();
      EXPECT_THAT(page, HasSubstr(reports::metric_text(evaluation::metric(metric), median)))
          << row.at("pipeline");
    }
  }
  EXPECT_EQ(run({"report", path("clocks"), "--output", "clocks.html"}).status, 0);
}

TEST_P(Archives, CompareTakesTheirValues) {
  const Json compared =
      result_of({"compare", path("run"), "--with-baseline", "oracle", "--format", "json"});
  std::map<std::string, Json> rows;
  const Json results = document("run/results.json");
  for (const Json& row : results.at("rows")) rows[row.at("pipeline")] = row;
  const Json pipelines = compared.at("pipelines");
  ASSERT_EQ(pipelines.size(), rows.size() - 1);
  for (const Json& pipeline : pipelines) {
    for (const char* side : {"a", "b"}) {
      const Json& series = rows.at(pipeline.at(side)).at("amd_ms");
      EXPECT_EQ(pipeline.at("amd_ms").at(side).at("median"), series.at("median"));
      EXPECT_DOUBLE_EQ(pipeline.at("amd_ms").at(side).at("mean").get<double>(),
                       mean_of(series.at("values")));
    }
  }
  EXPECT_EQ(result_of({"compare", path("clocks"), "--with-baseline", "ntp", "--format", "json"})
                .at("pipelines")
                .size(),
            1U);
}

TEST_P(Archives, GateHoldsThemToTheirBaseline) {
  const Json same = result_of({"gate", path("run"), "--baseline", path("baseline.json"), "--json"});
  EXPECT_EQ(same.at("passed"), true);
  for (const Json& check : nonempty(same.at("checks"))) EXPECT_EQ(check.at("outcome"), "same");
  // A result that is worse by a tenth fails against that baseline.
  fs::copy(path("run"), folder() / "worse", fs::copy_options::recursive);
  Json worse = document("run/results.json");
  for (Json& value : worse.at("rows")[0].at("amd_ms").at("values")) {
    value = 1.1 * value.get<double>();
  }
  file("worse/results.json", worse.dump(2) + "\n");
  EXPECT_EQ(run({"gate", "worse", "--baseline", path("baseline.json")}).status, 3);
}

TEST_P(Archives, StabilityReadsTheClocksOfARun) {
  const Json stable = result_of(
      {"stability", path("clocks/series.csv"), "--series", "chrony 1", "--format", "json"});
  double largest_s = 0;
  std::size_t lines = 0;
  std::istringstream series(simbench::content(path("clocks/series.csv")));
  for (std::string line; std::getline(series, line);) {
    const auto cells = [&] {
      std::vector<std::string> all;
      std::istringstream rest(line);
      for (std::string cell; std::getline(rest, cell, ',');) all.push_back(cell);
      return all;
    }();
    if (cells.at(0) != "chrony" || cells.at(3) != "1") continue;
    ++lines;
    largest_s = std::max(largest_s, std::abs(std::stod(cells.at(4))));
  }
  ASSERT_GT(lines, 0U);
  EXPECT_EQ(stable.at("files")[0].at("points"), lines);
  EXPECT_DOUBLE_EQ(stable.at("files")[0].at("max_te_ms").get<double>(), 1e3 * largest_s);
}

TEST_P(Archives, InspectAndReplayReadARecording) {
  const Json inspected = result_of({"inspect", path("recording"), "--format", "json"});
  const std::string frames = simbench::content(path("recording/raw_arrival/1/frames.csv"));
  const auto lines = std::ranges::count(frames, '\n') - 1;
  std::int64_t counted = 0;
  for (const Json& stream : inspected.at("files")[0].at("streams")) {
    counted += stream.at("frames").get<std::int64_t>();
  }
  EXPECT_EQ(counted, lines);

  const Json replayed = result_of({"replay", path("recording"), "--format", "json"});
  const Json expected = document("replay.json");
  ASSERT_EQ(replayed.at("rows").size(), expected.at("rows").size());
  for (std::size_t i = 0; i < expected.at("rows").size(); ++i) {
    const Json& row = replayed.at("rows")[i];
    const Json& then = expected.at("rows")[i];
    EXPECT_EQ(row.at("pipeline"), then.at("pipeline"));
    for (const char* metric : {"amd_ms", "absolute_error_ms", "host_error_ms"}) {
      const Json& value = row.at(metric).at("median");
      const Json& stated = then.at(metric).at("median");
      ASSERT_EQ(value.is_null(), stated.is_null()) << metric;  // a single host's clocks
      if (stated.is_null()) continue;
      EXPECT_NEAR(value.get<double>(), stated.get<double>(), 1e-9)
          << metric << " of " << row.at("pipeline");
    }
  }
}

TEST_P(Archives, AFittedModelIsAScenario) {
  EXPECT_EQ(run({"validate", path("model.json")}).status, 0);
}

// A sweep goes on with the program that began it; another one names both and touches nothing.
TEST_P(Archives, ASweepIsContinuedByItsProgramAlone) {
  const Json manifest = document("sweep/manifest.json");
  fs::copy(path("sweep"), folder() / "sweep", fs::copy_options::recursive);
  const ProgramResult result =
      run({"sweep", "--scenario", "3cam_1host_30fps", "--set", "/timeline/frames=20", "--set",
           "/timeline/warm_up_ms=500", "--pipelines", "raw_arrival,oracle", "--seeds", "2",
           "--sweep", "/trigger/rate_hz=15,30", "--output", "sweep"});
  if (manifest.at("version") == version() && manifest.at("commit") == commit()) {
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("8 of 8 runs finished already"));
    return;
  }
  EXPECT_EQ(result.status, 2);
  const char* const member = manifest.at("version") == version() ? "commit" : "version";
  EXPECT_THAT(result.err, HasSubstr(fmt::format("holds another sweep: /{} is {} there and", member,
                                                manifest.at(member).dump())));
  EXPECT_EQ(content("sweep/runs.log"), simbench::content(path("sweep/runs.log")));
}

TEST_P(Archives, OfAFormatThatIsNewerOneLineNamesWhatReadsIt) {
  const std::string results = newer("run", "run/results.json", "schema_version");
  const std::string clocks = newer("clocks", "clocks/manifest.json", "schema_version");
  const std::string recording = newer("recording", "recording/manifest.json", "format_version");
  const std::string baseline = newer("baseline.json", "baseline.json", "schema_version");
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"report", results},
           {"compare", results, "--with-baseline", "oracle"},
           {"gate", results, "--baseline", path("baseline.json")},
           {"gate", path("run"), "--baseline", baseline},
           {"figure", "distributions", results, "--output", "figure.csv"},
           {"report", clocks},
           {"inspect", recording},
           {"replay", recording},
           {"diagnose", recording},
           {"fit", recording, "--output", "fitted.json"}}) {
    const ProgramResult result = run(command);
    EXPECT_EQ(result.status, 2) << command.front();
    EXPECT_THAT(result.err, AllOf(HasSubstr("found"), HasSubstr("99"),
                                  HasSubstr("a newer simbench (97.0.0) wrote this and reads it; "
                                            "this is simbench " +
                                            std::string(version()))))
        << command.front();
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << command.front() << ": " << result.err;
  }
}

}  // namespace
}  // namespace simbench
