#include "processes/confinement.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "processes/child.h"
#include "processes/program_use.h"
#include "recording/distrusted_folder.h"
#include "tests/scratch_folder.h"

namespace simbench::processes {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class ConfinementTest : public testing::Test {
 protected:
  // Root's programs are nobody's, who is to get there.
  ConfinementTest() { chmod(folder_.path().c_str(), 0711); }

  Child::Settings settings(std::vector<std::string> words) const {
    words.insert(words.begin(), std::string(SIMBENCH_PROGRAMS) + "/simbench_escapes");
    return {.command = std::move(words),
            .environment = {},
            .folder = folder_.path().string(),
            .log_name = "program0.log",
            .shim = SIMBENCH_SHIM};
  }

  // A world that grants every request, and no data but an identity.
  std::string note_of(const Child::Settings& settings) const {
    Child child(settings);
    std::string reason;
    while (const std::optional<ChildRequest> request = child.next()) {
      if (request->head.call == shim::Call::kNote) {
        reason.assign(reinterpret_cast<const char*>(request->data.data()), request->data.size());
        break;
      }
      const shim::Identity identity{.process = 100, .address = 0};
      child.reply(0, 0, std::as_bytes(std::span(&identity, 1)));
    }
    return child.ending(reason);
  }
  std::string note_of(const std::string& attempt) const { return note_of(settings({attempt})); }
  // What it printed.
  std::string output_of(std::vector<std::string> words) const {
    note_of(settings(std::move(words)));
    return folder_.content("program0.log");
  }

  std::pair<unsigned, unsigned> owner_of(const std::string& file) const {
    struct stat status {};
    EXPECT_EQ(stat((folder_ / file).c_str(), &status), 0) << file;
    std::filesystem::remove(folder_ / file);
    return {status.st_uid, status.st_gid};
  }

  const ScratchFolder folder_;
};

// By libc or not: the world is asked, and the machine's clocks and networks are out of reach.
TEST_F(ConfinementTest, CallsThatPassLibcByAreServed) {
  for (const char* call : {"clock_settime", "settimeofday", "adjtimex", "clock_adjtime",
                           "clock_gettime", "nanosleep", "ppoll", "timerfd_create", "internet"}) {
    EXPECT_EQ(note_of(call), "simbench_escapes: exited with status 0: still there") << call;
  }
}

TEST_F(ConfinementTest, CallsThatChangeTheMachineAreNamed) {
  for (const char* call : {"ptrace", "mount", "sethostname"}) {
    EXPECT_THAT(note_of(call),
                testing::MatchesRegex(std::string("simbench_escapes: ") + call +
                                      "\\(.*\\) is not for programs of the simulated world"));
  }
}

// The kernel ends it where the shim cannot.
TEST_F(ConfinementTest, TheFilterHoldsWithoutTheShimsHelp) {
  EXPECT_EQ(note_of("catch"), "simbench_escapes: exited with status 0: still there");
  EXPECT_EQ(note_of("block"), "simbench_escapes: exited with status 0: still there");
  EXPECT_EQ(note_of("other_abi"),
            "simbench_escapes: made a system call that is not for programs of the simulated world");
}

bool has_landlock() {
  return syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0;
}

TEST_F(ConfinementTest, ItWritesInItsFolderOnly) {
  if (!has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
  EXPECT_EQ(output_of({"files", "/usr/outside.txt"}),
            "write outside: EACCES\n"
            "move outside: EACCES\n"
            "remove: EACCES\n"
            "device: EACCES\n"
            "read: succeeded\n"
            "null: succeeded\n"
            "own: succeeded\n"
            "folder: succeeded\n"
            "move: succeeded\n"
            "still there\n");
  EXPECT_FALSE(std::filesystem::exists("/usr/outside.txt"));
}

// Everybody may read and write it, so that nothing but the rules is in the way.
TEST_F(ConfinementTest, ItReadsWhatIsNamed) {
  if (!has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
  const ScratchFolder other;
  const std::string file = other.write("sub/file", "text");
  for (const std::string& path : {other.path().string(), other / "sub", file}) {
    chmod(path.c_str(), 0777);
  }
  const auto output = [&](std::vector<std::string> readable) {
    Child::Settings own = settings({"read", file});
    own.command.pop_back();  // a word that names a file may be read
    own.environment = {{"FILE", file}};
    own.readable = std::move(readable);
    note_of(own);
    return folder_.content("program0.log");
  };
  const std::string can_read = "read: succeeded\nwrite: EACCES\nstill there\n";
  // Below /tmp, what it may not read is not there.
  EXPECT_EQ(output({}), "read: ENOENT\nwrite: ENOENT\nstill there\n");
  EXPECT_EQ(output({file}), can_read);
  EXPECT_EQ(output({other / "sub"}), can_read);
  EXPECT_EQ(output({other.path().string()}), can_read);
  EXPECT_EQ(output({"/nowhere", other / "sub/missing"}),
            "read: ENOENT\nwrite: ENOENT\nstill there\n");
  note_of(settings({"read", file}));
  EXPECT_EQ(folder_.content("program0.log"), "read: succeeded\nwrite: EACCES\nstill there\n");
}

// Its program lies where nobody may go: it is root then, without root's rights.
TEST_F(ConfinementTest, RootsProgramsAreNobodys) {
  if (geteuid() != 0) GTEST_SKIP() << "for root";
  EXPECT_EQ(why_root(settings({"user"})), "");
  chmod(folder_.write("closed", "").c_str(), 0);
  const std::string powerless = "make: succeeded\nread what is closed: EACCES\nstill there\n";
  EXPECT_EQ(output_of({"user"}), powerless);
  EXPECT_EQ(owner_of("made"), std::pair(65534U, 65534U));
  const ScratchFolder closed;
  Child::Settings own = settings({"user"});
  own.program = closed / "program";
  std::filesystem::copy(own.command.front(), own.program);
  EXPECT_EQ(why_root(own),
            "simbench_escapes runs as root, without root's capabilities, and not as "
            "nobody: nobody may not enter or read " +
                closed.path().string());
  chown(folder_.path().c_str(), 0, 0);
  EXPECT_EQ(note_of(own), "simbench_escapes: exited with status 0: still there");
  EXPECT_EQ(folder_.content("program0.log"), powerless);
  EXPECT_EQ(owner_of("made"), std::pair(0U, 0U));
  // Programs that share a folder are of one user.
  std::vector<Child::Settings> both{settings({"user"}), own};
  agree_on_user(both);
  EXPECT_FALSE(both[0].as_nobody.value());
  EXPECT_FALSE(both[1].as_nobody.value());
  both.pop_back();
  agree_on_user(both);
  EXPECT_TRUE(both[0].as_nobody.value());
  EXPECT_EQ(owner_of("closed"), std::pair(65534U, 65534U));
}

TEST_F(ConfinementTest, ItHasNoNeighbours) {
  const int inherited = open("/dev/null", O_RDONLY);  // not marked to be closed
  EXPECT_EQ(output_of({"neighbours"}),
            "io_uring: ENOSYS\n"
            "shared memory: EPERM\n"
            "limit: EPERM\n"
            "link's name: EBADF\n"
            "still there\n");
  close(inherited);
}

TEST_F(ConfinementTest, ItIsRootOfItsHostAndOfNothingElse) {
  EXPECT_EQ(output_of({"rights"}),
            "setgroups: succeeded\n"
            "setgid: succeeded\n"
            "setuid: succeeded\n"
            "user 0, group 0\n"
            "keep: succeeded\n"
            "mlockall: succeeded\n"
            "real time: succeeded\n"
            "priority: succeeded\n"
            "limit: succeeded\n"
            "core files of 0 bytes\n"
            "owner: succeeded\n"
            "gain: succeeded\n"
            "_nobody_has_this_name is 0\n"
            "capset: succeeded\n"
            "capget: succeeded\n"
            "capabilities 0 0\n"
            "named: a message: No such file or directory\n"
            "still there\n");
}

TEST_F(ConfinementTest, ItsOwnSignalsWork) {
  EXPECT_EQ(output_of({"own_signals"}), "got it\nraise: succeeded\nstill there\n");
}

TEST_F(ConfinementTest, HowItEndedIsSaid) {
  EXPECT_EQ(note_of("crash"), "simbench_escapes: was ended by signal SEGV");
  EXPECT_EQ(note_of("killed"), "simbench_escapes: was ended by signal KILL");
  EXPECT_EQ(note_of("abort"), "simbench_escapes: was ended by signal ABRT: it cannot be");
  EXPECT_EQ(note_of("nothing of this name"),
            "simbench_escapes: exited with status 2: usage: escapes ATTEMPT [PATH]");
}

TEST_F(ConfinementTest, OutputMemoryAndPatienceHaveLimits) {
  EXPECT_THAT(note_of("write"),
              StartsWith("simbench_escapes: wrote more than 64 MiB into a file: xxxx"));
  EXPECT_THAT(output_of({"allocate"}), HasSubstr("no memory after"));
  Child::Settings patient = settings({"compute"});
  patient.patience = std::chrono::milliseconds(100);
  EXPECT_EQ(note_of(patient), "simbench_escapes: computed for 0.1 s without waiting");
}

// As those of a program's own children are.
TEST_F(ConfinementTest, ALinkThatIsThereHasTheLimitsOfItsProgram) {
  for (const char* name : {"one", "two", "three"}) folder_.write(name, "");
  const auto ending = [this](std::size_t most) {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
    Child child({.command = {"helper"},
                 .patience = std::chrono::milliseconds(200),
                 .link = ends[0],
                 .use = std::make_shared<ProgramUse>(
                     open_folder_in(AT_FDCWD, folder_.path().c_str()), getpid(),
                     FolderLimits{.files = most}, std::make_shared<RunUse>())});
    EXPECT_FALSE(child.next());
    close(ends[1]);
    return child.ending();
  };
  EXPECT_EQ(ending(2), "helper: made more than 2 files");
  EXPECT_EQ(ending(1000), "helper: computed for 0.2 s without waiting");
}

TEST_F(ConfinementTest, WhatCannotBeStartedSaysWhy) {
  Child::Settings missing = settings({});
  missing.command = {folder_ / "missing"};
  EXPECT_EQ(note_of(missing),
            "missing: cannot be run: " + (folder_ / "missing") + ": No such file or directory");
  missing.folder = folder_ / "no folder";
  EXPECT_EQ(note_of(missing), "missing: " + missing.folder +
                                  " cannot be made a program's only folder: No such file or "
                                  "directory");
  EXPECT_THROW(Confinement({.folder = missing.folder}), ConfinementError);
}

// As on a kernel that has none.
bool take_landlock_away() {
  sock_filter code[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_landlock_create_ruleset, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter{.len = std::size(code), .filter = code};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

TEST_F(ConfinementTest, WithoutLandlockRootRunsNoPrograms) {
  const pid_t world = fork();
  ASSERT_GE(world, 0);
  if (world == 0) {
    if (!take_landlock_away()) _exit(1);
    folder_.write("note.txt", note_of("rights"));
    _exit(0);
  }
  int status = 0;
  waitpid(world, &status, 0);
  ASSERT_EQ(status, 0);
  EXPECT_EQ(folder_.content("note.txt"),
            geteuid() == 0 ? "simbench_escapes: this kernel has no Landlock, without which root's "
                             "programs could write to all files: run simbench as another user"
                           : "simbench_escapes: exited with status 0: still there");
}

// A child of `parent` that is no zombie; 0: none.
pid_t child_of(pid_t parent) {
  if (parent == 0) return 0;
  const std::string id = std::to_string(parent);
  const std::string children = content("/proc/" + id + "/task/" + id + "/children");
  return children.empty() ? 0 : std::stoi(children);
}

bool lives(pid_t process) {
  const std::string status = content("/proc/" + std::to_string(process) + "/status");
  return !status.empty() && status.find("State:\tZ") == std::string::npos;
}

template <class Condition>
bool comes_true(Condition condition) {
  for (int i = 0; i < 1000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST_F(ConfinementTest, NoneIsLeftOfAWorldThatIsKilled) {
  const pid_t world = fork();
  ASSERT_GE(world, 0);
  if (world == 0) {
    note_of("compute");
    _exit(0);
  }
  pid_t program = 0;
  ASSERT_TRUE(comes_true([&] { return (program = child_of(child_of(world))) != 0; }));
  ASSERT_TRUE(comes_true([&] { return folder_.names().size() == 1; })) << "it runs";
  kill(world, SIGKILL);
  waitpid(world, nullptr, 0);
  EXPECT_TRUE(comes_true([&] { return !lives(program); }));
}

// Runs of a sweep are on threads that end before the process does.
TEST_F(ConfinementTest, ItLivesAsLongAsTheThreadThatStartedItAndNoLonger) {
  std::optional<Child> child;
  std::thread([&] { child.emplace(settings({"compute"})); }).join();
  std::string note = child->ending();
  EXPECT_THAT(note, testing::AnyOf(EndsWith("was ended by signal KILL"), EndsWith("was ended")));
}

}  // namespace
}  // namespace simbench::processes
