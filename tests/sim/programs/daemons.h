// Debian's chronyd, ntpd and ptp4l, unmodified, in the simulated world: what their tests share.
//
//   class Mine : public Daemons {};
//   const std::vector<Course> slaves = run(chronyd("server {master}"), scenario, 10'000, 1e-3);
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/find_program.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {

using Command = scenarios::HostPrograms::Command;

inline constexpr const char* kChronydEnd =
    "\ncmdport 0\npidfile {files}/chronyd.pid\nbindcmdaddress /\n";

// How a slave's clock did, once it was within a bound for good.
struct Course {
  double settled_s = 0;  // when the last error beyond the bound was
  double max_s = 0;      // from then on
  double rms_s = 0;
};

class Daemons : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // The settings of a pipeline whose programs lie among the unpacked packages.
  ProgramSettings settings(std::vector<Command> master, std::vector<Command> slave,
                           std::map<std::string, std::string> files) {
    ProgramSettings all{.pipeline = "daemons",
                        .programs = {.master = std::move(master),
                                     .slave = std::move(slave),
                                     .files = std::move(files)},
                        .shim = SIMBENCH_SHIM,
                        .log_folder = folder_};
    for (const auto* role : {&all.programs.master, &all.programs.slave}) {
      for (const Command& command : *role) {
        const FoundProgram program = find_program(command.front(), SIMBENCH_PACKAGES);
        all.paths[command.front()] = program.words.front();
        if (!program.library_path.empty()) {
          all.programs.environment["LD_LIBRARY_PATH"] = program.library_path;
        }
      }
    }
    return all;
  }

  ProgramSettings chronyd(const std::string& client) {
    const auto command = [](const char* file) {
      return Command{"chronyd", "-d", "-f", std::string("{files}/") + file};
    };
    return settings({command("server.conf")}, {command("client.conf")},
                    {{"server.conf", std::string("local stratum 1\nallow") + kChronydEnd},
                     {"client.conf", client + kChronydEnd}});
  }

  // Reads the clocks once a second for so long; `bound_s` is what "settled" means.
  std::vector<Course> run(ProgramSettings programs, const scenarios::Scenario& scenario,
                          double duration_s, double bound_s) {
    programs.hosts = static_cast<std::size_t>(scenario.hosts.count);
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

  // What all programs of all hosts have printed.
  std::string logs() const {
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (entry.path().extension() == ".log") paths.push_back(entry.path().string());
    }
    std::ranges::sort(paths);
    std::ostringstream all;
    for (const std::string& path : paths) all << std::ifstream(path).rdbuf();
    return all.str();
  }

  std::string folder_ = testing::TempDir() + "/daemons" +
                        testing::UnitTest::GetInstance()->current_test_info()->name();

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
