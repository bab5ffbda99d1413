// Attacks by name, and what becomes of each (tests/processes/attack_case.h). Those that take their
// time are in attacks_slow_test.cc.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "processes/lesser_user.h"
#include "tests/processes/attack_case.h"

namespace simbench::processes {
namespace {

using namespace std::chrono_literals;
using testing::_;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Matcher;
using testing::Not;
using testing::StartsWith;

class AttackTest : public testing::TestWithParam<AttackCase> {};

TEST_P(AttackTest, IsRepelled) { expect_repelled(GetParam()); }

std::vector<AttackCase> attacks_on_files() {
  const auto at = [](const char* attempt) {
    return Attack{.program = "file_attacks", .words = {attempt}};
  };
  const auto past_shim = [](const char* attempt) {
    return Attack{.program = "file_attacks", .words = {attempt}, .passes_shim_by = true};
  };
  const auto exited = [](const std::string& rest) {
    return testing::Eq("simbench_file_attacks: exited with status 3" + rest);
  };
  return {
      {past_shim("write_outside"),
       lines({"new: EACCES", "old: EACCES", "append: EACCES", "unnamed: EACCES"})},
      {past_shim("truncate_outside"), lines({"truncate: EACCES"})},
      {past_shim("remove_outside"), lines({"unlink: EACCES", "rmdir: EACCES"})},
      {past_shim("make_outside"),
       lines({"mkdir: EACCES", "symlink: EACCES", "mkfifo: EACCES", "bind: EACCES"})},
      {past_shim("move_outside"), lines({"out: EACCES", "in: EACCES", "exchange: EACCES"})},
      {past_shim("hard_links"), Not(HasSubstr("succeeded"))},
      // Below /tmp, what it may not read is not there (shim/paths.h).
      {at("through_links"), lines({"link: succeeded", "write: ENOENT", "read: ENOENT",
                                   "folder: succeeded", "below: ENOENT"})},
      {at("swap_links"), lines({"0 of others"})},
      {at("up"), lines({"above: EACCES", "list above: EACCES", "from the root: EACCES",
                        "go there: succeeded", "and read: EACCES"})},
      {at("devices"), lines({"block device: EPERM", "character device: EPERM", "type: ENOTTY"})},
      // /tmp and /run are the host's own.
      {at("read_others"), lines({"in a shared folder: ENOENT", "the shared folder: ENOENT",
                                 "/tmp: succeeded", "/run: succeeded"})},
      // What the shim tells, of the host.
      {at("read_machine"),
       lines({"/proc/uptime: succeeded", "/proc/stat: succeeded",
              "/proc/sys/kernel/hostname: succeeded",
              "/sys/devices/system/clocksource/clocksource0/current_clocksource: succeeded",
              "parent's memory: ENOENT", "parent's environment: ENOENT",
              "parent's descriptors: ENOENT", "own map: succeeded", "own descriptors: succeeded"})},
      {at("write_program"), lines({"by name: EACCES", "by link: EACCES", "maps: EACCES"})},
      {at("handles"), HasSubstr("name_to_handle_at: EPERM\n"), ends_by_call("open_by_handle_at")},
      {at("attributes"),
       lines({"owner: succeeded", "mode: succeeded", "times: ENOENT", "attribute: EPERM"})},
      {at("sockets"), lines({"root's socket: ENOENT", "abstract socket: EPERM"})},
      {at("by_pipe"), lines({"pipe: succeeded", "vmsplice: succeeded", "splice: EBADF",
                             "sendfile: EBADF", "copy: EBADF"})},
      {at("log_pipe"), _, exited("")},
      {at("log_link"), _, exited("")},
      {at("log_folder"), _, exited("")},
      {at("log_gone"), _, exited(": last words")},
      {at("log_truncated"), _, exited("")},
      {at("log_hole"), _, StartsWith("simbench_file_attacks: exited with status 3")},
  };
}

std::vector<AttackCase> attacks_on_the_disk() {
  const auto at = [](const char* attempt) {
    return Attack{.program = "file_attacks",
                  .words = {attempt},
                  .patience = 20s,
                  .disk = {.bytes = std::uint64_t{96} << 20, .files = 1000}};
  };
  return {
      {at("many_files"), _, ends("made more than 1000 files")},
      {at("much_in_files"), _, ends("wrote more than 96 MiB into its folder")},
      {at("holes"), _, ends("wrote more than 96 MiB into its folder")},
      {at("reserved"), lines({"reserve: EOPNOTSUPP"})},
      {at("unnamed_files"), _, ends("wrote more than 96 MiB into its folder")},
      {at("deep_folders"), _,
       AnyOf(ends("made folders more than 64 deep"), ends("made more than"))},
      {at("closed_folders"), lines({})},
      {at("odd_names"), lines({})},
      {{.program = "escapes", .words = {"write"}}, _, ends("wrote more than 64 MiB into a file")},
  };
}

std::vector<AttackCase> attacks_on_processes() {
  const auto at = [](const char* attempt, std::chrono::milliseconds patience = 1s) {
    return Attack{.program = "process_attacks", .words = {attempt}, .patience = patience};
  };
  const auto refused = [](const std::string& call) { return ends_by_call(call); };
  return {
      {at("kill_others"), lines({"kill: ESRCH", "kill: ESRCH", "kill: ESRCH", "kill: ESRCH",
                                 "tgkill: ESRCH", "tkill: ESRCH", "rt_sigqueueinfo: ESRCH"})},
      {at("open_others"), lines({"pidfd_open: EPERM", "pidfd_send_signal: EPERM", "kcmp: EPERM",
                                 "process_madvise: EPERM", "move_pages: EPERM"})},
      {at("attach"), _, refused("ptrace")},
      {at("be_traced"), _, refused("ptrace")},
      {at("read_memory"), _, refused("process_vm_readv")},
      {at("write_memory"), _, refused("process_vm_writev")},
      {at("take_descriptor"), _, refused("pidfd_getfd")},
      {at("limits"), lines({"raise: EPERM", "raise: EPERM", "raise: EPERM", "raise: EPERM",
                            "raise: EPERM", "raise: EPERM", "raise: EPERM", "raise: EPERM",
                            "parent's: EPERM", "processor 120 s"})},
      {at("priorities"), lines({"real time: succeeded", "parent's: succeeded", "nice: succeeded",
                                "ioprio: succeeded", "mlock: succeeded", "policy 0, nice 0"})},
      {at("marks"), lines({"dumpable: succeeded", "death signal: succeeded", "subreaper: succeeded",
                           "seccomp: succeeded", "personality: EPERM", "dumpable 1, dies by 9"})},
      {at("own_rules"), lines({"rules", "read: EACCES"})},
      // What the world makes of these is the world's; here, that they end and leave nothing.
      {at("stop_itself"), lines({"stop: ESRCH"})},  // the world is asked
      {at("fork_bomb")},
      {at("vfork_bomb")},
      {at("fork_chain")},
      {at("daemonise")},
      {at("thread_bomb", 5s), Not(HasSubstr("each thread"))},
      {at("run_shell")},
      {at("run_in_child")},
      {at("run_set_uid"), Not(HasSubstr("succeeded"))},
      {at("run_by_descriptor"), Not(HasSubstr("succeeded"))},
      {at("run_itself")},
      {at("unmapped_memory"),
       lines({"memfd_create: ENOSYS", "memfd_secret: ENOSYS", "shmget: EPERM", "shmat: EPERM",
              "semget: EPERM", "msgget: EPERM", "mq_open: EPERM", "/dev/shm: succeeded"})},
      {at("deep_stack"), _, ends("was ended by signal SEGV")},
      {at("pipes", 5s), lines({"pipe: EMFILE"})},
      {at("sent_descriptors"), lines({"few"})},
      {at("crash_hard"), _, ends("was ended by signal SEGV")},
  };
}

std::vector<AttackCase> attacks_on_the_machine() {
  std::vector<AttackCase> all;
  const auto add = [&all](const char* call, const Matcher<std::string>& output,
                          const Matcher<std::string>& ending) {
    all.push_back({{.program = "machine_attacks", .words = {"call", call}}, output, ending});
  };
  for (const char* call :
       {"mount",       "umount2",       "pivot_root",    "open_tree", "move_mount",
        "fsopen",      "fspick",        "fsconfig",      "fsmount",   "mount_setattr",
        "setns",       "unshare",       "swapon",        "swapoff",   "quotactl",
        "quotactl_fd", "fanotify_init", "acct",          "reboot",    "kexec_load",
        "init_module", "finit_module",  "delete_module", "bpf",       "perf_event_open",
        "sethostname", "setdomainname"}) {
    add(call, "", ends_by_call(call));
  }
  for (const char* call :
       {"settimeofday", "clock_settime", "adjtimex", "clock_adjtime", "clock_nanosleep",
        "nanosleep", "timer_create", "timerfd_create", "setitimer"}) {
    add(call, _, _);  // of the world, whose clock is not the machine's
  }
  add("chroot", lines({"chroot: succeeded"}), _);
  for (const char* call : {"userfaultfd", "keyctl", "add_key", "request_key", "syslog", "vhangup",
                           "personality", "mq_unlink", "shmctl", "semctl", "semop", "semtimedop",
                           "msgctl", "msgsnd", "msgrcv", "migrate_pages", "process_mrelease"}) {
    add(call, lines({std::string(call) + ": EPERM"}), _);
  }
  for (const char* call : {"io_uring_setup", "io_setup", "clone3", "futex_waitv"}) {
    add(call, lines({std::string(call) + ": ENOSYS"}), _);
  }
  add("sync", lines({"sync: succeeded"}), _);
#ifdef __x86_64__
  for (const char* call : {"iopl", "ioperm", "modify_ldt", "kexec_file_load"}) {
    add(call, "", ends_by_call(call));
  }
#endif
  return all;
}

std::vector<AttackCase> attacks_by_other_ways() {
  std::vector<AttackCase> all;
  // Internet, internet 6, netlink, packet: if there are any, they are the world's.
  for (const char* family : {"2", "10", "16", "17"}) {
    all.push_back({{.program = "machine_attacks", .words = {"socket", family}}, _, _});
  }
  // Keys, CAN, Bluetooth, crypto, virtual machines, XDP.
  for (const char* family : {"15", "29", "31", "38", "40", "44"}) {
    all.push_back({{.program = "machine_attacks", .words = {"socket", family}},
                   Not(HasSubstr("succeeded")),
                   _});
  }
  const auto at = [](const char* attempt) {
    return Attack{.program = "machine_attacks", .words = {attempt}};
  };
  all.push_back({at("younger"), lines({"younger: ENOSYS"})});
#ifdef __x86_64__
  const auto killed = ends("made a system call that is not for programs of the simulated world");
  all.push_back({at("other_abi"), "", killed});
  all.push_back({at("old_abi"), "", AnyOf(killed, ends("was ended by signal SEGV"))});
  all.push_back(
      {at("old_page"), _, AnyOf(ends("exited with status 0"), ends("was ended by signal SEGV"))});
#endif
  return all;
}

INSTANTIATE_TEST_SUITE_P(Files, AttackTest, testing::ValuesIn(attacks_on_files()), attack_name);
INSTANTIATE_TEST_SUITE_P(Disk, AttackTest, testing::ValuesIn(attacks_on_the_disk()), attack_name);
INSTANTIATE_TEST_SUITE_P(Processes, AttackTest, testing::ValuesIn(attacks_on_processes()),
                         attack_name);
INSTANTIATE_TEST_SUITE_P(Machine, AttackTest, testing::ValuesIn(attacks_on_the_machine()),
                         attack_name);
INSTANTIATE_TEST_SUITE_P(OtherWays, AttackTest, testing::ValuesIn(attacks_by_other_ways()),
                         attack_name);

}  // namespace
}  // namespace simbench::processes
