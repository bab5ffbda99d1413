#include "processes/warden.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "processes/process_tree.h"
#include "tests/scratch_folder.h"

namespace simbench::processes {
namespace {

using namespace std::chrono_literals;

// A number that this process and its children share.
class SharedNumber {
 public:
  SharedNumber() {
    void* room = mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    number_ = new (room) std::atomic<int>(0);
  }
  ~SharedNumber() { munmap(number_, sizeof *number_); }
  SharedNumber(const SharedNumber&) = delete;
  SharedNumber& operator=(const SharedNumber&) = delete;
  std::atomic<int>& operator*() const { return *number_; }
  // Waits until it is set.
  int get() const {
    while (*number_ == 0) std::this_thread::sleep_for(1ms);
    return *number_;
  }

 private:
  std::atomic<int>* number_;
};

bool is_gone(pid_t process) {
  const std::string status = content("/proc/" + std::to_string(process) + "/status");
  return status.empty() || status.find("State:\tZ") != std::string::npos;
}

bool comes_to_be_gone(pid_t process) {
  for (int i = 0; i < 1000 && !is_gone(process); ++i) std::this_thread::sleep_for(10ms);
  return is_gone(process);
}

[[noreturn]] void stay() {
  for (;;) pause();
}

// Leaves its parent, group and session, and says who it is.
[[noreturn]] void go_to_background(const SharedNumber& number) {
  if (fork() > 0) _exit(0);
  setsid();
  if (fork() > 0) _exit(0);
  signal(SIGTERM, SIG_IGN);
  *number = getpid();
  stay();
}

TEST(Warden, TellsHowTheProgramEnded) {
  Warden exited([](pid_t) { _exit(7); });
  const std::optional<int> status = exited.status(10s);
  ASSERT_TRUE(status);
  EXPECT_TRUE(WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 7);
  EXPECT_EQ(exited.status(0ms), status) << "it is told again";
  Warden killed([](pid_t) { stay(); });
  EXPECT_EQ(killed.status(0ms), std::nullopt);
  kill(killed.program(), SIGUSR1);
  EXPECT_EQ(WTERMSIG(killed.status(10s).value_or(0)), SIGUSR1);
}

TEST(Warden, TheProgramKnowsItsParent) {
  const SharedNumber parent;
  Warden warden([&](pid_t given) {
    *parent = given == getppid() ? given : -1;
    stay();
  });
  EXPECT_EQ(parent.get(), warden.process());
  EXPECT_THAT(descendants(warden.process()), testing::ElementsAre(warden.program()));
}

TEST(Warden, WhatWentToTheBackgroundEndsToo) {
  const SharedNumber background;
  Warden warden([&](pid_t) { go_to_background(background); });
  ASSERT_TRUE(warden.status(10s)) << "the program itself has ended";
  const pid_t process = background.get();
  EXPECT_FALSE(is_gone(process));
  warden.end();
  EXPECT_TRUE(is_gone(process));
}

// Each ends when the next has begun.
TEST(Warden, AChainOfProcessesEnds) {
  const SharedNumber latest;
  Warden warden([&](pid_t) {
    for (;;) {
      if (fork() > 0) _exit(0);
      *latest = getpid();
    }
  });
  latest.get();
  const pid_t process = warden.process();
  warden.end();
  EXPECT_TRUE(is_gone(process));
  const pid_t last = *latest;
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(*latest, last) << "none goes on";
}

TEST(Warden, ATreeEnds) {
  const SharedNumber count;
  Warden warden([&](pid_t) {
    for (int depth = 0; depth < 7; ++depth) fork();
    ++*count;
    stay();
  });
  while (*count < 128) std::this_thread::sleep_for(1ms);
  const std::vector<pid_t> all = descendants(warden.process());
  EXPECT_EQ(all.size(), 128U);
  warden.end();
  for (const pid_t each : all) EXPECT_TRUE(is_gone(each));
}

TEST(Warden, NothingIsLeftOfWhoIsKilled) {
  const SharedNumber background;
  const SharedNumber orphaned;
  Warden([](pid_t) { stay(); }, [&] { *orphaned = 7; });
  EXPECT_EQ(*orphaned, 0) << "its parent has ended it";
  const pid_t owner = fork();
  ASSERT_GE(owner, 0);
  if (owner == 0) {
    const Warden warden([&](pid_t) { go_to_background(background); }, [&] { *orphaned = 8; });
    stay();
  }
  const pid_t process = background.get();
  EXPECT_FALSE(is_gone(process));
  kill(owner, SIGKILL);
  waitpid(owner, nullptr, 0);
  EXPECT_TRUE(comes_to_be_gone(process));
  EXPECT_EQ(orphaned.get(), 8);
}

TEST(Warden, IsMoved) {
  Warden first([](pid_t) { stay(); });
  const pid_t program = first.program();
  Warden second(std::move(first));
  EXPECT_EQ(second.program(), program);
  first = Warden();
  EXPECT_EQ(first.program(), -1);
  second = Warden();
  EXPECT_TRUE(is_gone(program));
}

}  // namespace
}  // namespace simbench::processes
