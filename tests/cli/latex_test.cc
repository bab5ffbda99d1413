// What `--format latex` prints is a part of a document that pdflatex sets without a line that is
// too wide: of every command that has it, on A4 and Letter, in small letters and large ones.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct LatexCase {
  const char* name = "";
  std::vector<std::string> command{};
};

const std::vector<std::string> kShort = {"--seeds", "2", "--set", "/timeline/frames=60",
                                         "--no-levers"};

std::vector<std::string> with_short(std::vector<std::string> command) {
  command.insert(command.end(), kShort.begin(), kShort.end());
  return command;
}

std::vector<LatexCase> latex_cases() {
  return {
      {"Run", with_short({"run", "--scenario", "18cam_6host_45fps", "--verbose"})},
      {"Steered",
       with_short({"run", "--scenario", "18cam_6host_30fps_without_trigger", "--verbose"})},
      {"Colour", with_short({"run", "--scenario", "18cam_6host_90fps_full_slave", "--verbose"})},
      {"Leaderboard",
       {"run", "--scenario", "leaderboard_lan", "--seeds", "1", "--set", "/timeline/frames=30",
        "--verbose", "--no-levers"}},
      {"Budget",
       {"run", "--scenario", "3cam_1host_30fps", "--seeds", "1", "--set", "/timeline/frames=60",
        "--pipelines", "oracle", "--budget"}},
      {"Compare", {"compare", "archive", "--with-baseline", "oracle"}},
      {"Clocks", {"clocks", "--scenario", "6host_star", "--duration-s", "600", "--seeds", "2"}},
      {"Paper", {"paper", "--seeds", "2", "--no-table-4"}},
      {"Reality", {"reality", "--seeds", "1"}},
      {"Replay", {"replay", "rig.csv"}}};
}

// Ten seconds of two cameras, the second of which has a long name.
std::string two_cameras() {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";
  for (int i = 0; i < 300; ++i) {
    const double ms = i * 1000 / 30.0;
    for (const char* camera : {"left", "a_camera_with_a_name_that_no_column_has_room_for"}) {
      text += fmt::format("Depth,0,{},{:.3f},{:.6f},{},pc\n", i, 700 + ms,
                          ms + 9 + i * 7919 % 97 * 0.005, camera);
    }
  }
  return text;
}

class Latex : public ProgramTest, public testing::WithParamInterface<LatexCase> {
 protected:
  bool has_pdflatex() const { return std::system("command -v pdflatex > /dev/null 2>&1") == 0; }

  // Sets a document of what was printed, and returns pdflatex's log.
  std::string log_of(const std::string& options) const {
    file("document.tex", fmt::format("\\documentclass[{}]{{article}}\n"
                                     "\\usepackage{{array,booktabs,longtable}}\n"
                                     "\\begin{{document}}\n\\input{{printed}}\n\\end{{document}}\n",
                                     options));
    const std::string command = fmt::format(
        "cd '{}' && pdflatex -interaction=nonstopmode -halt-on-error document > /dev/null 2>&1",
        folder().string());
    std::string log;
    for (int pass = 0; pass < 2; ++pass) {  // a longtable needs two
      const int status = std::system(command.c_str());
      log = content("document.log");
      EXPECT_EQ(status, 0) << options << "\n"
                           << log.substr(log.size() - std::min<std::size_t>(log.size(), 1500));
    }
    return log;
  }
};

TEST_P(Latex, FitsThePage) {
  file("rig.csv", two_cameras());
  if (std::string(GetParam().name) == "Compare") {
    const ProgramResult made =
        run(with_short({"run", "--scenario", "18cam_6host_45fps", "--output", "archive"}));
    ASSERT_EQ(made.status, 0) << made.err;
  }
  std::vector<std::string> command = GetParam().command;
  command.insert(command.end(), {"--format", "latex"});
  const ProgramResult printed = run(command);
  ASSERT_EQ(printed.status, 0) << printed.err;
  EXPECT_THAT(printed.out, StartsWith("% Needs \\usepackage{array,booktabs,longtable}."));
  EXPECT_THAT(printed.out, HasSubstr("\\toprule"));
  if (!has_pdflatex()) GTEST_SKIP() << "there is no pdflatex: texlive-latex-recommended has it";
  file("printed.tex", printed.out);
  for (const char* options : {"10pt,a4paper", "12pt,letterpaper"}) {
    const std::string log = log_of(options);
    EXPECT_EQ(log.find("Overfull \\hbox"), std::string::npos)
        << options << ": " << log.substr(log.find("Overfull \\hbox"), 300);
    EXPECT_THAT(log, HasSubstr("Output written on"));
  }
}

class TableColumns : public ProgramTest {};

TEST_F(TableColumns, AreThoseThatAreNamed) {
  const std::vector<std::string> command = with_short(
      {"run", "--scenario", "3cam_1host_30fps", "--table-columns", "AMD median,RMDV median"});
  const auto printed = [&](const char* format) {
    std::vector<std::string> words = command;
    words.insert(words.end(), {"--format", format});
    return run(words);
  };
  EXPECT_THAT(printed("latex").out, HasSubstr("\\begin{tabular}{lrr}"));
  EXPECT_THAT(printed("markdown").out, HasSubstr("| pipeline | AMD median | RMDV median |"));
  EXPECT_EQ(printed("csv").status, 2);
  EXPECT_THAT(printed("csv").err, HasSubstr("allowed with: table, markdown, latex"));
  const ProgramResult unknown = run(with_short(
      {"run", "--scenario", "3cam_1host_30fps", "--format", "latex", "--table-columns", "AMB"}));
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("found 'AMB', allowed: AMD median"));
}

INSTANTIATE_TEST_SUITE_P(Of, Latex, testing::ValuesIn(latex_cases()),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
}  // namespace simbench
