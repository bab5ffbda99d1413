// Nothing of the machine leaks into the world: programs that print what they can learn of it print
// the same in another folder, later, and in another environment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>

#include "tests/sim/programs/real_programs.h"

namespace simbench::sim {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

std::set<std::string> numbers_of_short_files(const std::string& said) {
  std::set<std::string> numbers;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("short ")) numbers.insert(line.substr(line.rfind(' ')));
  }
  return numbers;
}

class Leaks : public RealPrograms {
 protected:
  // The second run has another environment, umask and working folder than the first.
  void run_in_two_places(const ProgramSettings& programs, double duration_s) {
    const std::string before = std::filesystem::current_path();
    const ScratchFolder other;
    between_runs_ = [&other] {
      setenv("TMPDIR", other.path().c_str(), 1);
      setenv("TZ", "Asia/Tokyo", 1);
      setenv("LC_ALL", "C.UTF-8", 1);
      setenv("PYTHONHASHSEED", "7", 1);
      std::filesystem::current_path(other.path());
      umask(077);
    };
    run_twice(programs, two_hosts(), duration_s);
    umask(022);
    std::filesystem::current_path(before);
    for (const char* name : {"TMPDIR", "TZ", "LC_ALL", "PYTHONHASHSEED"}) unsetenv(name);
  }
};

TEST_F(Leaks, OfWhatTheMachineTellsByCalls) {
  const Command command{test_program("leaks")};
  run_in_two_places(settings({command}, {command}), 5);
  const std::string said = file(1, "0_simbench_leaks.log");
  EXPECT_THAT(said, EndsWith("done\n"));
  // Who sent a signal, and what was used.
  EXPECT_THAT(said, HasSubstr("\nsignal 10 0 102 0"));
  EXPECT_THAT(said, HasSubstr("\nsignal 17 1 102 0 0 0 3\n"));
  EXPECT_THAT(said, HasSubstr("\nsignal 10 -1 100 0 "));
  EXPECT_THAT(said, HasSubstr("\nsignalfd 12 100 0\n"));
  EXPECT_THAT(said, HasSubstr("\npeer 100 0 0\n"));
  EXPECT_THAT(said, HasSubstr("\ngetrusage 0 0 0 0 0 0"));
  EXPECT_THAT(said, HasSubstr("\nhost host1 /files /files\n"));
  EXPECT_EQ(numbers_of_short_files(said).size(), 180) << "each is a file of its own";
  // The machine's processors and its load.
  EXPECT_THAT(said, HasSubstr("\nprocessors 0 1 1 1 1 1\n"));
  EXPECT_THAT(said, HasSubstr("\ngetloadavg 3 0 0 0\n"));
  // Times that a program sets are its own; none is of this year.
  EXPECT_THAT(said, HasSubstr("of 4096, 7000000008, 7000000008, "));
  EXPECT_THAT(said, Not(HasSubstr(folder_)));
}

TEST_F(Leaks, OfWhatTheMachineTellsToPython) {
  SIMBENCH_SKIP_WITHOUT("python3");
  const Command command{"python3", test_script("leaks.py")};
  run_in_two_places(settings({command}, {command, {test_program("leaks")}}), 5);
  const std::string said = file(1, "0_python3.log");
  EXPECT_THAT(said, EndsWith("done\n"));
  EXPECT_THAT(said, HasSubstr("\nprocessors 1 {0} (0.0, 0.0, 0.0)\n"));
  EXPECT_THAT(said, HasSubstr("\ntemporary " P_tmpdir "/"));
}

TEST_F(Leaks, OfTheTimesOfFilesThatChronydReads) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::string drift = "/var/lib/chrony/chrony.drift";
  run_in_two_places(
      settings({{"chronyd", "-d", "-f", "{files}/server.conf"}},
               {{"chronyd", "-d", "-s", "-f", "{files}/client.conf"}},
               {{"server.conf", "local stratum 1\nallow\n"},
                {"client.conf", "server {master} iburst minpoll 0 maxpoll 2\ndriftfile " + drift +
                                    "\nlogdir /var/log/chrony\nlog measurements tracking\n"},
                {drift.substr(1), "5.0 1.0\n"}}),
      120);
  // The file is from the world's beginning, at which the clock is some 0.1 s off.
  EXPECT_THAT(logs(), Not(HasSubstr("System time set from driftfile")));
}

TEST_F(Leaks, OfTheExamples) {
  SIMBENCH_SKIP_WITHOUT("python3");
  const std::string script = std::string(SIMBENCH_SOURCE_DIR) + "/examples/cristian.py";
  run_in_two_places(
      settings({{"python3", script, "serve"}}, {{"python3", script, "follow", "{master}"}}), 60);
  EXPECT_THAT(file(1, "0_python3.log"), HasSubstr("round trip"));
}

TEST_F(Leaks, OfAPtpDaemon) {
  SIMBENCH_SKIP_WITHOUT("ptp4l");
  run_in_two_places(settings({{"ptp4l", "-S", "-m", "-i", "{interface}", "--priority1=1"}},
                             {{"ptp4l", "-S", "-m", "-s", "-i", "{interface}"}}),
                    60);
  EXPECT_THAT(logs(), HasSubstr("UNCALIBRATED to SLAVE on MASTER_CLOCK_SELECTED"));
}

}  // namespace
}  // namespace simbench::sim
