// A world of hosts that run real programs: those of unpacked packages, of the machine, of the
// tests.
//
//   class ClientsTest : public RealPrograms {};
//   TEST_F(ClientsTest, SetTheClock) {
//     SIMBENCH_SKIP_WITHOUT("chronyd");
//     const Course slave = run_twice(settings(master, slave, files), two_hosts(), 600, 1e-3);
//     EXPECT_LE(slave.max_s, 1e-3);
//   }
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/find_program.h"
#include "sim/programs/program_file.h"
#include "sim/programs/program_sync.h"
#include "tests/nonempty.h"
#include "tests/scratch_folder.h"
#include "tests/sim/host/service_world.h"
#include "tests/sim/programs/calls_on_hosts.h"

namespace simbench::sim {

using Command = scenarios::HostPrograms::Command;

// Why it is not there, or nothing.
inline std::string missing(const std::string& program) {
  try {
    find_program(program, SIMBENCH_PACKAGES);
    return "";
  } catch (const ProgramError& error) {
    return error.what();
  }
}

#define SIMBENCH_SKIP_WITHOUT(program) \
  if (const std::string why = ::simbench::sim::missing(program); !why.empty()) GTEST_SKIP() << why

// How a slave's clock did, once it was within a bound for good.
struct Course {
  double settled_s = 0;  // when the last error beyond the bound was
  double max_s = 0;      // from then on
  double rms_s = 0;
};

// What a run has left.
struct LeftFile {
  std::string content;
  std::int64_t modified_ns = 0;
  unsigned int mode = 0;
  bool operator==(const LeftFile&) const = default;
};
using LeftFiles = std::map<std::string, LeftFile>;

inline LeftFiles files_below(const std::string& folder) {
  LeftFiles files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    struct stat status {};
    lstat(entry.path().c_str(), &status);
    files[std::filesystem::relative(entry.path(), folder).string()] = {
        .content = S_ISREG(status.st_mode) ? content(entry.path()) : "",
        .modified_ns = status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec,
        .mode = status.st_mode};
  }
  return files;
}

inline void expect_same(const LeftFiles& left, const LeftFiles& again) {
  for (const auto& [name, file] : nonempty(left)) {
    const auto same = again.find(name);
    ASSERT_NE(same, again.end()) << name;
    EXPECT_EQ(same->second.content, file.content) << name;
    EXPECT_EQ(same->second.modified_ns, file.modified_ns) << name;
    EXPECT_EQ(same->second.mode, file.mode) << name;
  }
  EXPECT_EQ(again.size(), left.size());
}

class RealPrograms : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // The first word of a command is an absolute path, or the name of a program that is there.
  ProgramSettings settings(std::vector<Command> master, std::vector<Command> slave,
                           std::map<std::string, std::string> files = {},
                           std::map<std::string, std::string> environment = {}) const {
    ProgramSettings all{.pipeline = "programs",
                        .programs = {.master = std::move(master),
                                     .slave = std::move(slave),
                                     .files = std::move(files),
                                     .environment = std::move(environment)},
                        .shim = SIMBENCH_SHIM,
                        .log_folder = folder_};
    for (auto* role : {&all.programs.master, &all.programs.slave}) {
      for (Command& command : *role) {
        const FoundProgram program = find_program(command.front(), SIMBENCH_PACKAGES);
        if (program.words.size() == 1) {
          all.paths[command.front()] = program.words.front();
        } else {  // a script and its interpreter
          command.erase(command.begin());
          command.insert(command.begin(), program.words.begin(), program.words.end());
        }
        if (!program.library_path.empty()) {
          all.programs.environment["LD_LIBRARY_PATH"] = program.library_path;
        }
      }
    }
    return all;
  }

  static scenarios::Scenario two_hosts(std::vector<scenarios::Override> changes = {}) {
    changes.insert(changes.begin(), {{"/hosts/count", "2"}, {"/cameras/count", "2"}});
    return scenarios::load_scenario("6host_star", changes);
  }

  // Reads the clocks once a second for so long; `bound_s` is what "settled" means.
  std::vector<Course> run(ProgramSettings programs, const scenarios::Scenario& scenario,
                          double duration_s, double bound_s = 1) {
    programs.hosts = static_cast<std::size_t>(scenario.hosts.count);
    programs.log_folder = folder_;
    ProgramSync sync(std::move(programs));
    ServiceWorld world(scenario, 1);
    world.start(sync);
    std::vector<std::vector<double>> errors_s(static_cast<std::size_t>(scenario.hosts.count));
    world.watch(duration_s, 1, [&](double) {
      for (std::size_t host = 1; host < errors_s.size(); ++host) {
        errors_s[host].push_back(world.error_s(host));
      }
    });
    EXPECT_THAT(sync.notes(), testing::IsEmpty());
    std::vector<Course> courses;
    for (std::size_t host = 1; host < errors_s.size(); ++host) {
      courses.push_back(course_of(errors_s[host], bound_s));
    }
    return courses;
  }

  // The course of the first slave. Runs it again, in a folder of another name and length and later
  // by the machine's clock: all files must be the same.
  Course run_twice(const ProgramSettings& programs, const scenarios::Scenario& scenario,
                   double duration_s, double bound_s = 1) {
    const Course first = run(programs, scenario, duration_s, bound_s).at(0);
    const LeftFiles left = files_below(hosts_folder());
    std::filesystem::remove_all(folder_);
    folder_ += "_of_a_name_longer_than_those_of_sockets_may_be" + std::string(60, '_');
    between_runs_();
    const Course second = run(programs, scenario, duration_s, bound_s).at(0);
    EXPECT_EQ(first.rms_s, second.rms_s);
    expect_same(left, files_below(hosts_folder()));
    return first;
  }

  std::string hosts_folder() const { return folder_ + "/programs/seed1"; }
  // What all programs of all hosts have printed.
  std::string logs() const {
    std::string all;
    for (const auto& [name, file] : files_below(folder_)) {
      if (name.ends_with(".log")) all += file.content;
    }
    return all;
  }
  // A file of a host's, or what its first program has printed.
  std::string file(std::size_t host, const std::string& name) const {
    return content(hosts_folder() + "/host" + std::to_string(host) + "/" + name);
  }

  std::function<void()> between_runs_ = [] {};
  std::string folder_ =
      testing::TempDir() + "/real" + testing::UnitTest::GetInstance()->current_test_info()->name();

 private:
  static Course course_of(const std::vector<double>& errors_s, double bound_s) {
    Course course;
    std::size_t begin = 0;
    for (std::size_t at = 0; at < errors_s.size(); ++at) {
      if (std::abs(errors_s[at]) > bound_s) begin = at + 1;
    }
    course.settled_s = static_cast<double>(begin);
    double sum = 0;
    for (std::size_t at = begin; at < errors_s.size(); ++at) {
      course.max_s = std::max(course.max_s, std::abs(errors_s[at]));
      sum += errors_s[at] * errors_s[at];
    }
    course.rms_s =
        std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, errors_s.size() - begin)));
    return course;
  }
};

}  // namespace simbench::sim
