#include "processes/control_group.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include "tests/scratch_folder.h"

namespace simbench::processes {
namespace {

namespace fs = std::filesystem;

constexpr ControlGroup::Limits kLimits{.memory = std::uint64_t{64} << 20, .processes = 20};

// A process in the group, which does this.
template <class Work>
pid_t process_in(const ControlGroup& group, Work work) {
  const pid_t process = fork();
  if (process != 0) return process;
  if (write(group.entrance(), "0", 1) != 1) _exit(9);
  work();
  _exit(0);
}

TEST(ControlGroup, HasTheProcessesThatEnterAndKillsThem) {
  pid_t process = 0;
  fs::path path;
  {
    const ControlGroup group(kLimits);
    if (group.entrance() < 0) GTEST_SKIP() << "no control group can be made here";
    path = group.path();
    EXPECT_TRUE(fs::exists(path));
    process = process_in(group, [] {
      for (;;) pause();
    });
    const std::string expected = std::to_string(process) + "\n";
    for (int i = 0; i < 1000 && content(path / "cgroup.procs") != expected; ++i) usleep(1000);
    EXPECT_EQ(content(path / "cgroup.procs"), expected);
    kill(process, SIGKILL);
    waitpid(process, nullptr, 0);
    EXPECT_FALSE(group.has_run_out()) << "it was not for the memory";
  }
  EXPECT_FALSE(fs::exists(path)) << "it is removed";
}

TEST(ControlGroup, WhatAKilledProcessLeftIsRemovedByTheNext) {
  fs::path left;
  {
    const ControlGroup group(kLimits);
    if (group.entrance() < 0) GTEST_SKIP() << "no control group can be made here";
    left = group.path().parent_path();
  }
  int ends[2] = {};
  ASSERT_EQ(pipe(ends), 0);
  const pid_t maker = fork();
  ASSERT_GE(maker, 0);
  if (maker == 0) {
    const ControlGroup group(kLimits);
    // Somebody who outlives the maker.
    const pid_t inner = process_in(group, [] {
      for (;;) pause();
    });
    while (content(group.path() / "cgroup.procs").empty()) usleep(1000);
    const bool told = write(ends[1], &inner, sizeof inner) == sizeof inner;
    kill(getpid(), told ? SIGKILL : SIGTERM);
  }
  pid_t inner = 0;
  ASSERT_EQ(read(ends[0], &inner, sizeof inner), static_cast<ssize_t>(sizeof inner));
  close(ends[0]);
  close(ends[1]);
  waitpid(maker, nullptr, 0);
  const std::string name = "simbench-" + std::to_string(maker) + "-";
  const auto count = [&] {
    int found = 0;
    for (const auto& entry : fs::directory_iterator(left)) {
      found += entry.path().filename().string().starts_with(name);
    }
    return found;
  };
  EXPECT_EQ(count(), 1);
  const ControlGroup next(kLimits);
  EXPECT_EQ(count(), 0);
  EXPECT_TRUE(!fs::exists("/proc/" + std::to_string(inner)) ||
              content("/proc/" + std::to_string(inner) + "/stat").find(") Z ") != std::string::npos)
      << "and who was in it ends";
}

TEST(ControlGroup, TheMemoryOfAllHasALimit) {
  const ControlGroup group(kLimits);
  if (!fs::exists(group.path() / "memory.max")) GTEST_SKIP() << "no controller of memory here";
  const auto use = [] {
    constexpr std::size_t kHalf = std::size_t{40} << 20;
    void* room = mmap(nullptr, kHalf, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
    std::memset(room, 1, kHalf);
    for (;;) pause();
  };
  const pid_t processes[] = {process_in(group, use), process_in(group, use)};
  for (int i = 0; i < 10'000 && !group.has_run_out(); ++i) usleep(1000);
  EXPECT_TRUE(group.has_run_out()) << "each alone is within it";
  for (const pid_t each : processes) {
    kill(each, SIGKILL);
    waitpid(each, nullptr, 0);
  }
}

TEST(ControlGroup, TheNumberOfAllHasALimit) {
  const ControlGroup group(kLimits);
  if (!fs::exists(group.path() / "pids.max")) GTEST_SKIP() << "no controller of processes here";
  const pid_t process = process_in(group, [] {
    int made = 0;
    for (int i = 0; i < 100; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        for (;;) pause();
      }
      made += child > 0;
    }
    _exit(made);
  });
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 19);
}

}  // namespace
}  // namespace simbench::processes
