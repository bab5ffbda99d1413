// Completion scripts as the shells run them, and man pages as groff reads them. What is not
// installed is skipped, and said to be.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

struct ShellResult {
  int status = -1;
  std::string out;  // with standard error
};

class Shell : public ProgramTest {
 protected:
  ShellResult shell(const std::string& command) const {
    const std::string line = "cd '" + folder().string() + "' && { " + command + "\n} 2>&1";
    ShellResult result;
    FILE* pipe = popen(line.c_str(), "r");
    if (pipe == nullptr) return result;
    std::array<char, 4096> part = {};
    while (const std::size_t size = fread(part.data(), 1, part.size(), pipe)) {
      result.out.append(part.data(), size);
    }
    const int status = pclose(pipe);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
  }
  bool has(const std::string& program) const { return shell("command -v " + program).status == 0; }
  static std::vector<std::string> lines(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> found;
    for (std::string line; std::getline(in, line);) found.push_back(line);
    return found;
  }
  std::vector<std::string> names() const { return lines(run({"manual", "--names"}).out); }
};

// What bash offers for words of a line; the last is being typed.
class Bash : public Shell {
 public:
  void SetUp() override {
    if (!has("bash")) GTEST_SKIP() << "not run: no bash";
    file("completion.bash", run({"completion", "bash"}).out);
    file("complete.bash",
         ". ./completion.bash\n"
         "compopt() { :; }\n"  // works only while bash itself completes
         "COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1))\n"
         "_simbench\n"
         "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
  }

 protected:
  std::vector<std::string> offers(const std::vector<std::string>& words) const {
    std::string command = "bash complete.bash '" SIMBENCH_PROGRAM "'";
    for (const std::string& word : words) command += " '" + word + "'";
    std::vector<std::string> found = lines(shell(command).out);
    std::erase(found, "");
    return found;
  }
};

TEST_F(Bash, TakesTheScript) {
  const ShellResult result = shell("bash -n completion.bash");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "");
}

TEST_F(Bash, OffersEveryCommandAndEveryOption) {
  EXPECT_EQ(offers({""}), names());
  EXPECT_THAT(offers({"desc"}), ElementsAre("describe"));
  for (const std::string& name : nonempty(names())) {
    const std::vector<std::string> offered = offers({name, "-"});
    const std::string help = run({name, "--help"}).out;
    int options = 0;
    for (const std::string& line : lines(help)) {
      const std::size_t at = line.find("--");
      if (!line.starts_with("  -") || at == std::string::npos || at > 6) continue;
      const std::string option = line.substr(at, line.find_first_of(" ,", at) - at);
      EXPECT_THAT(offered, Contains(option)) << name;
      ++options;
    }
    EXPECT_GT(options, 0) << name;
  }
}

TEST_F(Bash, OffersWhatAValueMayBe) {
  EXPECT_THAT(offers({"run", "--format", ""}),
              ElementsAre("table", "markdown", "latex", "csv", "tidy", "json"));
  EXPECT_THAT(offers({"run", "--format", "=", "j"}), ElementsAre("json"));
  EXPECT_THAT(offers({"run", "--format", "="}), IsSupersetOf({"csv", "json"}));
  EXPECT_THAT(offers({"run", "--budget", "--format", "c"}), ElementsAre("csv"));
  EXPECT_THAT(offers({"completion", ""}), ElementsAre("bash", "zsh", "fish"));
  EXPECT_THAT(offers({"list", "al"}), ElementsAre("algorithms"));
  EXPECT_THAT(offers({"manual", "desc"}), ElementsAre("describe"));
  EXPECT_THAT(offers({"run", "--seeds", ""}), IsEmpty());
}

TEST_F(Bash, OffersScenariosAndFiles) {
  file("18my rig.json", "{}");
  EXPECT_THAT(offers({"run", "--scenario", "18"}),
              IsSupersetOf({"18cam_6host_45fps", "18my rig.json"}));
  EXPECT_THAT(offers({"describe", "3cam"}), Contains("3cam_1host_30fps"));
  EXPECT_THAT(offers({"validate", "18"}), ElementsAre("18my rig.json"));
  std::filesystem::create_directory(folder() / "18results");
  EXPECT_THAT(offers({"run", "--output", "18"}), ElementsAre("18results"));
}

TEST_F(Bash, OffersThePipelinesOfTheScenario) {
  EXPECT_THAT(offers({"run", "--scenario", "3cam_1host_30fps", "--pipelines", "oracle_"}),
              ElementsAre("oracle_device_time"));
  EXPECT_THAT(offers({"3cam_1host_30fps", "--pipelines", "genlock,oracle_"}),
              ElementsAre("genlock,oracle_device_time"));
  EXPECT_THAT(offers({"trace", "--scenario", "3cam_1host_30fps", "--pipeline", "oracle_"}),
              ElementsAre("oracle_device_time"));
  EXPECT_THAT(offers({"run", "--pipelines", ""}), IsEmpty());
}

TEST_F(Bash, OffersFiguresParametersCommandsAndArchives) {
  EXPECT_THAT(offers({"figure", "frame"}), ElementsAre("frame_errors"));
  EXPECT_THAT(offers({"run", "--scenario", "3cam_1host_30fps", "--set", "/trigger/ra"}),
              IsSupersetOf({"/trigger/rate_hz=", "/trigger/rate_error_ppm="}));
  EXPECT_THAT(offers({"describe", "3cam_1host_30fps", "/trigger/rate_h"}),
              ElementsAre("/trigger/rate_hz="));
  EXPECT_THAT(offers({"help", "desc"}), ElementsAre("describe"));
  std::filesystem::create_directories(folder() / "results/monday");
  std::filesystem::create_directories(folder() / "resources");
  EXPECT_THAT(offers({"report", "res"}), testing::UnorderedElementsAre("results", "resources"));
  file("results/monday/results.json", "{}");
  EXPECT_THAT(offers({"report", "res"}), ElementsAre("results"));
  EXPECT_THAT(offers({"compare", "results/"}), ElementsAre("results/monday"));
  EXPECT_THAT(offers({"18cam_6host_45fps_l"}), Contains("18cam_6host_45fps_lan"));
}

TEST_F(Shell, TablesKeepTheTerminalsWidthInAPipeToAPager) {
  if (!has("script")) GTEST_SKIP() << "not run: no script(1)";
  const auto widest = [this](const std::string& command) {
    std::size_t width = 0;
    for (const std::string& line : lines(shell("script -qec '" + command + "' /dev/null").out)) {
      width = std::max(width, line.size());
    }
    return width;
  };
  const std::string described = SIMBENCH_PROGRAM " describe 3cam_1host_30fps /trigger";
  EXPECT_LE(widest("stty cols 90; " + described + " | cat"), 91U);
  EXPECT_GT(widest("stty cols 90; " + described + " 2> /dev/null | cat"), 91U);
}

TEST_F(Bash, CompletesTheDefaultCommand) {
  EXPECT_THAT(offers({"--"}), IsSupersetOf({"--version", "--scenario"}));
  EXPECT_THAT(offers({"--scenario", "3cam"}), Contains("3cam_1host_30fps"));
  EXPECT_THAT(offers({"--scenario", "3cam_1host_30fps", "--format", "m"}), ElementsAre("markdown"));
}

TEST_F(Shell, ZshTakesTheScript) {
  if (!has("zsh")) GTEST_SKIP() << "not run: no zsh";
  file("_simbench", run({"completion", "zsh"}).out);
  EXPECT_EQ(shell("zsh -n _simbench").out, "");
  const ShellResult result = shell(
      "zsh -f -c 'fpath=($PWD $fpath); autoload -U compinit; compinit -u -D;"
      " print -r -- $_comps[simbench]; _arguments() { :; }; _describe() { :; };"
      " words=(simbench \"\") CURRENT=2; _simbench; _simbench;"
      " print -rl -- $_simbench_run'");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("_simbench\n"));
  EXPECT_THAT(result.out, HasSubstr("--format=["));
  EXPECT_THAT(result.out, HasSubstr(":FORMAT:(table markdown latex csv tidy json)"));
}

TEST_F(Shell, FishCompletes) {
  if (!has("fish")) GTEST_SKIP() << "not run: no fish";
  file("simbench.fish", run({"completion", "fish"}).out);
  EXPECT_EQ(shell("fish -n simbench.fish").out, "");
  const auto offers = [this](const std::string& line) {
    std::vector<std::string> found =
        lines(shell("HOME=$PWD fish -c \"source simbench.fish; complete -C '" + line + "'\"").out);
    for (std::string& each : found) each = each.substr(0, each.find('\t'));
    return found;
  };
  EXPECT_THAT(offers("simbench "), IsSupersetOf(names()));
  EXPECT_THAT(offers("simbench run --format "),
              ElementsAre("csv", "json", "latex", "markdown", "table", "tidy"));
  EXPECT_THAT(offers("simbench --form"), Contains("--format"));
  EXPECT_THAT(offers("simbench completion z"), ElementsAre("zsh"));
  EXPECT_THAT(offers("simbench run --seeds "), IsEmpty());
  EXPECT_THAT(offers(SIMBENCH_PROGRAM " describe 3cam"), Contains("3cam_1host_30fps"));
  const std::string of_scenario = SIMBENCH_PROGRAM " run --scenario 3cam_1host_30fps --pipelines ";
  EXPECT_THAT(offers(SIMBENCH_PROGRAM " 3cam"), Contains("3cam_1host_30fps"));
  EXPECT_THAT(offers(of_scenario + "oracle_"), ElementsAre("oracle_device_time"));
  EXPECT_THAT(offers(of_scenario + "genlock,oracle_"), ElementsAre("genlock,oracle_device_time"));
  EXPECT_THAT(offers(SIMBENCH_PROGRAM " figure frame"), ElementsAre("frame_errors"));
  EXPECT_THAT(offers(SIMBENCH_PROGRAM " describe 3cam_1host_30fps /trigger/rate_h"),
              ElementsAre("/trigger/rate_hz="));
  EXPECT_THAT(offers("simbench help desc"), ElementsAre("describe"));
}

TEST_F(Shell, ManPagesAreWholeAndWithoutWarnings) {
  std::vector<std::string> all = names();
  all.insert(all.begin(), "");
  for (const std::string& name : nonempty(all)) {
    SCOPED_TRACE(name);
    const ProgramResult page = name.empty() ? run({"manual"}) : run({"manual", name});
    EXPECT_EQ(page.status, 0);
    EXPECT_THAT(page.out, testing::StartsWith(".TH "));
    for (const char* section : {".SH NAME", ".SH SYNOPSIS", ".SH OPTIONS", ".SH SEE ALSO"}) {
      EXPECT_THAT(page.out, HasSubstr(section));
    }
    file("page.1", page.out);
    if (!has("groff")) continue;
    EXPECT_EQ(shell("groff -man -Tutf8 -ww page.1 > page.txt").out, "");
    const ShellResult text = shell("groff -man -Tascii -P-c -P-b -P-u page.1");
    EXPECT_THAT(text.out, HasSubstr("OPTIONS"));
    EXPECT_THAT(text.out, Not(HasSubstr("\\")));
  }
  if (!has("groff")) GTEST_SKIP() << "not rendered: no groff";
}

TEST_F(Shell, UnknownShellsAndPagesAreRefused) {
  EXPECT_THAT(run({"completion", "csh"}).err, HasSubstr("found 'csh', allowed: bash, zsh, fish"));
  const ProgramResult page = run({"manual", "fly"});
  EXPECT_EQ(page.status, 2);
  EXPECT_THAT(page.err, HasSubstr("found 'fly', allowed: run, "));
}

}  // namespace
}  // namespace simbench
