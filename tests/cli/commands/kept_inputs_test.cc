// No command destroys what it reads, nor a recording that lies where it would write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/commands/rs_csv_files.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Words = std::vector<std::string>;

const std::string kBag = "#ROSBAG V2.0\nwhat took a day to record";

// Every option that writes, in a command line that is right up to its value.
const std::vector<Words>& writing_commands() {
  static const std::vector<Words> lines = {
      {"run", "--scenario", "6cam_2host_30fps", "--output"},
      {"run", "--scenario", "6cam_2host_30fps", "--program-log"},
      {"sweep", "--study", "scalability", "--output"},
      {"clocks", "--scenario", "6host_star", "--output"},
      {"clocks", "--scenario", "6host_star", "--figure"},
      {"clocks", "--scenario", "6host_star", "--program-log"},
      {"reconstruct", "--scenario", "18cam_6host_30fps_studio", "--output"},
      {"paper", "--output"},
      {"explore", "3cam_1host_30fps", "--export"},
      {"report", "results", "--output"},
      {"trace", "--scenario", "6cam_2host_30fps", "--output"},
      {"trace", "--scenario", "6cam_2host_30fps", "--program-log"},
      {"figure", "phases", "in.csv", "--output"},
      {"gate", "results", "--save-baseline"},
      {"gate", "results", "--baseline", "b.json", "--junit"},
      {"gate", "results", "--baseline", "b.json", "--markdown"},
      {"record", "--scenario", "6cam_2host_30fps", "--output"},
      {"record", "--scenario", "6cam_2host_30fps", "--output", "new", "--program-log"},
      {"replay", "in.csv", "--output"},
      {"stability", "in.csv", "--figure"},
      {"stability", "in.csv", "--html"},
      {"compare", "my.json", "--with-baseline", "oracle", "--html"},
      {"diagnose", "in.csv", "--html"},
      {"diagnose", "in.csv", "--pack"},
      {"export", "in.csv", "--output"},
      {"fit", "in.csv", "--output"},
      {"code", "18cam_6host_90fps_coded", "--export"},
      {"certify", "18cam_6host_45fps_lan", "--pairs"},
      {"keygen", "FILE"},
      {"node", "--rig", "rig.json", "--name", "a", "--journal"},
      {"node", "--rig", "rig.json", "--name", "a", "--programs-on", "lo", "--program-log"},
      {"validate-model", "--scenario", "6node_relay", "--save"},
      {"validate-model", "--scenario", "6node_relay", "--stack"},
      {"validate-model", "--scenario", "6node_relay", "--program-log"}};
  return lines;
}

class KeptInputs : public ProgramTest {
 protected:
  // Neither status 0 nor a changed file.
  void refuses(const Words& words, const std::string& path, const std::string& message) {
    SCOPED_TRACE(testing::PrintToString(words));
    const std::string before = content(path);
    const auto names = names_in();
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(content(path), before);
    EXPECT_EQ(names_in(), names);
  }

  Words commands() const {
    const std::string allowed = run({"no_such_command"}).err;
    const std::size_t begin = allowed.find("allowed: ") + 9;
    Words names;
    const std::regex word("[a-z-]+(?=,)");
    for (std::sregex_iterator
             it(allowed.begin() + static_cast<std::ptrdiff_t>(begin), allowed.end(), word),
         end;
         it != end; ++it) {
      names.push_back(it->str());
    }
    return names;
  }
};

TEST_F(KeptInputs, AnOutputThatIsAnInputIsRefusedByEveryCommand) {
  file("a.bag", kBag);
  file("b.bag", kBag);
  file("in.csv", kHeader + "Depth,0,1,10,20\n");
  file("my.json", "{\"base\": \"6cam_2host_30fps\"}");
  const std::vector<std::pair<Words, std::string>> lines = {
      {{"export", "in.csv", "-o", "in.csv"}, "in.csv"},
      {{"export", "a.bag", "b.bag", "-o", "b.bag"}, "b.bag"},
      {{"diagnose", "a.bag", "--html", "a.bag"}, "a.bag"},
      {{"stability", "in.csv", "--html", "in.csv"}, "in.csv"},
      {{"compare", "my.json", "--with-baseline", "oracle", "--html", "my.json"}, "my.json"},
      {{"fit", "b.bag", "a.bag", "-o", "./a.bag"}, "a.bag"},
      {{"fit", "b.bag", "--base", "my.json", "-o", "my.json"}, "my.json"},
      {{"diagnose", "my.json", "--pack", "my.json"}, "my.json"},
      {{"figure", "phases", "in.csv", "-o", "in.csv"}, "in.csv"},
      {{"replay", "in.csv", "-o", "in.csv"}, "in.csv"},
      {{"explore", "my.json", "--export", "my.json"}, "my.json"},
      {{"report", "my.json", "-o", "my.json"}, "my.json"},
      {{"gate", "my.json", "--save-baseline", "my.json"}, "my.json"},
      {{"gate", "x.json", "--baseline", "my.json", "--junit", "my.json"}, "my.json"},
      {{"gate", "x.json", "--baseline", "my.json", "--markdown", "my.json"}, "my.json"},
      {{"run", "--scenario", "my.json", "-o", "my.json"}, "my.json"},
      {{"trace", "--scenario", "my.json", "-o", "my.json"}, "my.json"},
      {{"trace", "--scenario", "6cam_2host_30fps", "--program", "p=my.json", "-o", "my.json"},
       "my.json"},
      {{"clocks", "--scenario", "my.json", "--figure", "my.json"}, "my.json"},
      {{"record", "--scenario", "my.json", "-o", "my.json"}, "my.json"},
      {{"sweep", "--scenario", "my.json", "--sweep", "/x=1", "-o", "my.json"}, "my.json"},
      {{"validate-model", "--scenario", "6node_relay", "--measured", "my.json", "--save",
        "my.json"},
       "my.json"},
      {{"node", "--rig", "my.json", "--name", "a", "--journal", "my.json"}, "my.json"}};
  for (const auto& [words, path] : lines) {
    refuses(words, path, "is one of the inputs, allowed: another f");
  }
}

TEST_F(KeptInputs, AlsoThroughLinks) {
  file("in.csv", kHeader + "Depth,0,1,10,20\n");
  fs::create_symlink("in.csv", folder() / "link.csv");
  fs::create_hard_link(folder() / "in.csv", folder() / "hard.csv");
  refuses({"export", "in.csv", "-o", "link.csv"}, "in.csv", "link.csv is one of the inputs");
  refuses({"export", "link.csv", "-o", "in.csv"}, "in.csv", "in.csv is one of the inputs");
  refuses({"export", "in.csv", "-o", "hard.csv"}, "in.csv", "hard.csv is one of the inputs");
}

TEST_F(KeptInputs, AnOutputFolderThatIsAnInputFolderIsRefused) {
  ASSERT_EQ(run({"record", "--scenario", "6cam_2host_30fps", "--pipelines", "yoon2021_both",
                 "--set", "/timeline/frames=30", "-o", "monday"})
                .status,
            0);
  refuses({"replay", "monday", "-o", "monday/"}, "monday/manifest.json",
          "is one of the inputs, allowed: another folder");
  // A part of it is not replaced either.
  const std::string frames = "monday/yoon2021_both/1/frames.csv";
  refuses({"export", "monday", "-o", frames}, frames, "is a part of a recording folder");
  const std::string events = "monday/yoon2021_both/1/events.csv";
  refuses({"export", "monday", "-o", events}, events, "is a part of monday/yoon2021_both/1");
  refuses({"fit", "monday", "-o", "monday/manifest.json"}, "monday/manifest.json",
          "is a part of monday");
}

TEST_F(KeptInputs, NamesOfBuiltInThingsAreNoInputs) {
  fs::create_directory(folder() / "6cam_2host_30fps");
  fs::create_directory(folder() / "yoon2021_both");
  for (const char* const output : {"6cam_2host_30fps", "yoon2021_both"}) {
    EXPECT_EQ(run({"run", "--scenario", "6cam_2host_30fps", "--pipelines", "yoon2021_both",
                   "--seeds", "1", "--set", "/timeline/frames=30", "-o", output})
                  .status,
              0);
  }
}

// As a glob behind -o makes it: the first of the files is the output.
TEST_F(KeptInputs, NoOptionReplacesARecording) {
  file("a.bag", kBag);
  file("in.csv", kHeader + "Depth,0,1,10,20\n");
  for (Words words : writing_commands()) {
    if (words.back() == "FILE") words.pop_back();
    words.push_back("a.bag");
    refuses(words, "a.bag", "a.bag is a rosbag 2.0 bag, allowed: another f");
  }
  file("first.csv", kHeader + "Depth,0,1,10,20\n");
  refuses({"export", "-o", "first.csv", "in.csv"}, "first.csv", "first.csv is a CSV recording");
}

TEST_F(KeptInputs, ThisTestKnowsEveryOptionThatWrites) {
  std::set<std::string> known;
  for (const Words& words : writing_commands()) known.insert(words.front() + " " + words.back());
  const Words names = commands();
  EXPECT_GT(names.size(), 20U);
  const std::regex option(
      R"(\n  (?:-\w,)?(--[a-z-]+|FILE) (?:(?:FILE|DIR)\S*)? +((?:.|\n {6,})+))");
  const std::regex writes(
      "[Ww]rit|Replaces|Keep what|The folder|Folder for|[Ii]nto\\s+this file|Draw");
  std::set<std::string> found;
  for (const std::string& name : names) {
    const std::string help = run({name, "--help"}, {.environment = {"COLUMNS=200"}}).out;
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
      const bool takes_path = std::regex_search(it->str(), std::regex("(FILE|DIR)\\S* "));
      if (takes_path && std::regex_search((*it)[2].str(), writes)) {
        found.insert(name + " " + (*it)[1].str());
      }
    }
  }
  EXPECT_EQ(found, known);
}

TEST_F(KeptInputs, AnEarlierResultIsReplacedAsEver) {
  std::string csv = kHeader;
  for (int i = 0; i < 100; ++i) {
    csv += "Depth,0," + std::to_string(i) + "," + std::to_string(1000 + 33 * i) + "," +
           std::to_string(2000 + 33 * i) + "\n";
  }
  file("in.csv", csv);
  const Words words = {"export", "in.csv", "--stamps", "hull_300", "-o", "frames.csv"};
  ASSERT_EQ(run(words).status, 0);
  const std::string first = content("frames.csv");
  file("frames.csv", "camera,of another run\n");
  ASSERT_EQ(run(words).status, 0);
  EXPECT_EQ(content("frames.csv"), first);
  EXPECT_EQ(content("in.csv"), csv);
}

}  // namespace
}  // namespace simbench
