// Attacks by and on processes: those of others, many of one's own, memory, descriptors, time, and
// staying alive. The second word is in the command line of all that it starts.
//
//   process_attacks ATTEMPT WORD
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "tests/programs/attempts.h"

namespace {

using attempts::Attempt;
using attempts::path;
using attempts::say;

constexpr int kLink = 200;

pid_t real_fork() { return static_cast<pid_t>(syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0)); }
[[noreturn]] void compute() {
  for (volatile unsigned int i = 0;;) i = i + 1;
}
// 80 to 160 ms, of products that wait for each other: no clock of the machine's is there to ask.
void compute_a_while() {
  std::uint64_t number = 1;
  for (int i = 0; i < 80'000'000; ++i) {
    number = number * 6364136223846793005U + 1;
    __asm__ volatile("" : "+r"(number));
  }
}

// Others.

void kill_others() {
  siginfo_t info{};
  for (const pid_t other : {getppid(), 1, -1, -getpgrp()}) {
    say("kill", syscall(SYS_kill, other, SIGKILL));
  }
  say("tgkill", syscall(SYS_tgkill, getppid(), getppid(), SIGKILL));
  say("tkill", syscall(SYS_tkill, getppid(), SIGKILL));
  say("rt_sigqueueinfo", syscall(SYS_rt_sigqueueinfo, getppid(), SIGKILL, &info));
}
void open_others() {
  say("pidfd_open", syscall(SYS_pidfd_open, getppid(), 0));
  say("pidfd_send_signal", syscall(SYS_pidfd_send_signal, 0, SIGKILL, nullptr, 0));
  say("kcmp", syscall(SYS_kcmp, getppid(), getpid(), 0, 0, 0));
  say("process_madvise", syscall(SYS_process_madvise, 0, nullptr, 0, 4, 0));
  say("move_pages", syscall(SYS_move_pages, getppid(), 0, nullptr, nullptr, nullptr, 0));
}
void attach() { say("ptrace", syscall(SYS_ptrace, 16, getppid(), 0, 0)); }
void be_traced() { say("ptrace", syscall(SYS_ptrace, 0, 0, 0, 0)); }
void read_memory() {
  iovec piece{};
  say("process_vm_readv", process_vm_readv(getppid(), &piece, 1, &piece, 1, 0));
}
void write_memory() {
  iovec piece{};
  say("process_vm_writev", process_vm_writev(getppid(), &piece, 1, &piece, 1, 0));
}
void take_descriptor() { say("pidfd_getfd", syscall(SYS_pidfd_getfd, 0, 0, 0)); }

// Limits and priorities.

void limits() {
  const rlimit none{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  for (const int resource : {RLIMIT_AS, RLIMIT_DATA, RLIMIT_FSIZE, RLIMIT_NOFILE, RLIMIT_CPU,
                             RLIMIT_CORE, RLIMIT_NPROC, RLIMIT_STACK}) {
    say("raise", syscall(SYS_prlimit64, 0, resource, &none, nullptr));
  }
  say("parent's", syscall(SYS_prlimit64, getppid(), RLIMIT_AS, &none, nullptr));
  rlimit now{};
  getrlimit(RLIMIT_CPU, &now);
  std::printf("processor %d s\n", static_cast<int>(now.rlim_cur));
}
void priorities() {
  const sched_param first{.sched_priority = 99};
  say("real time", syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, &first));
  say("parent's", syscall(SYS_setpriority, PRIO_PROCESS, getppid(), 19));
  say("nice", syscall(SYS_setpriority, PRIO_PROCESS, 0, -20));
  say("ioprio", syscall(SYS_ioprio_set, 1, 0, 1 << 13));
  say("mlock", syscall(SYS_mlockall, MCL_CURRENT | MCL_FUTURE));
  std::printf("policy %ld, nice %ld\n", syscall(SYS_sched_getscheduler, 0),
              20 - syscall(SYS_getpriority, PRIO_PROCESS, 0));
}
void marks() {
  say("dumpable", prctl(PR_SET_DUMPABLE, 0));
  say("death signal", prctl(PR_SET_PDEATHSIG, 0));
  say("subreaper", prctl(PR_SET_CHILD_SUBREAPER, 1));
  say("seccomp", syscall(SYS_seccomp, 0, 0, nullptr));
  say("personality", personality(0));
  int death = 0;
  prctl(PR_GET_PDEATHSIG, &death);
  std::printf("dumpable %d, dies by %d\n", prctl(PR_GET_DUMPABLE), death);
}
// Landlock on Landlock takes rights away and gives none.
void own_rules() {
  const long rules = syscall(SYS_landlock_create_ruleset, nullptr, 0, 1);
  std::printf("%s\n", rules > 0 ? "rules" : "none");
  say("read", open("/etc/shadow", O_RDONLY));
}

// Many.

void fork_bomb() {
  for (int i = 0; i < 5'000; ++i) real_fork();
  compute();
}
void vfork_bomb() {
  for (int i = 0; i < 100; ++i) {
    if (vfork() == 0) compute();  // NOLINT: it is an attack
  }
}
// Each generation ends when the next has begun.
void fork_chain() {
  for (;;) {
    if (real_fork() > 0) _exit(0);
  }
}
void daemonise() {
  if (real_fork() > 0) _exit(0);
  setsid();
  if (real_fork() > 0) _exit(0);
  signal(SIGTERM, SIG_IGN);
  close(kLink);
  compute();
}
void thread_bomb() {
  int ends[2] = {};
  pipe(ends);
  static int input = ends[0];
  const auto wait = [](void*) -> void* {
    char byte = 0;
    syscall(SYS_read, input, &byte, 1);
    return nullptr;
  };
  long count = 0;
  pthread_attr_t small{};
  pthread_attr_init(&small);
  pthread_attr_setstacksize(&small, 1 << 16);
  pthread_t thread{};
  while (count < 100'000 && pthread_create(&thread, &small, wait, nullptr) == 0) ++count;
  std::puts(count < 100'000 ? "some threads" : "each thread");
  std::fflush(stdout);
  _exit(0);
}

// Other programs.

char shell[] = "sh";
char option[] = "-c";
void run_shell() {
  std::string script = std::string("while :; do :; done # ") + path;
  char* const words[] = {shell, option, script.data(), nullptr};
  char* const none[] = {nullptr};
  say("execve", execve("/bin/sh", words, none));
}
void run_in_child() {
  if (real_fork() == 0) {
    setsid();
    run_shell();
  }
  _exit(0);
}
void run_set_uid() {
  char* const words[] = {shell, nullptr};
  say("execve", execve("/bin/su", words, environ));
}
void run_by_descriptor() {
  char* const words[] = {shell, nullptr};
  say("execveat", fexecve(open("/bin/sh", O_RDONLY), words, environ));
}
// The same program, without the library that serves it.
void run_itself() {
  std::array<char, 4096> name{};
  readlink("/proc/self/exe", name.data(), name.size() - 1);
  char attempt[] = "compute";
  std::string word = path;
  char* const words[] = {name.data(), attempt, word.data(), nullptr};
  char* const none[] = {nullptr};
  say("execve", execve(name.data(), words, none));
}

// Memory and descriptors.

void map_much(int flags) {
  constexpr std::size_t kBlock = std::size_t{64} << 20;
  for (int i = 0; i < 256; ++i) {
    void* block =
        mmap(nullptr, kBlock, PROT_READ | PROT_WRITE, flags | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
    if (block == MAP_FAILED) {
      say("mmap", -1);
      return;
    }
  }
}
void private_memory() { map_much(MAP_PRIVATE); }
void shared_memory() { map_much(MAP_SHARED); }
void unmapped_memory() {
  say("memfd_create", syscall(SYS_memfd_create, "x", 0));
  say("memfd_secret", syscall(SYS_memfd_secret, 0));
  say("shmget", syscall(SYS_shmget, IPC_PRIVATE, 1 << 20, 0600));
  say("shmat", syscall(SYS_shmat, 0, nullptr, 0));
  say("semget", syscall(SYS_semget, 1, 1, 0600));
  say("msgget", syscall(SYS_msgget, 1, 0600));
  say("mq_open", syscall(SYS_mq_open, "x", O_CREAT | O_RDWR, 0600, nullptr));
  say("/dev/shm", open("/dev/shm/x", O_CREAT | O_RDWR, 0600));
}
int deeper(int depth) {
  volatile char room[1 << 16];
  room[0] = static_cast<char>(depth);
  return depth < 1 << 20 ? deeper(depth + 1) + room[0] : 0;
}
void deep_stack() { std::printf("%d\n", deeper(0)); }
void pipes() {
  static char block[1 << 16];
  int ends[2] = {};
  while (pipe2(ends, O_NONBLOCK) == 0) {
    fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);
    while (write(ends[1], block, sizeof block) > 0) {
    }
  }
  say("pipe", -1);
}
void sent_descriptors() {
  int ends[2] = {};
  syscall(SYS_socketpair, AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends);
  int sent = open("own", O_RDWR | O_CREAT, 0600);
  char byte = 0;
  iovec piece{.iov_base = &byte, .iov_len = 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof sent)> control{};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* head = CMSG_FIRSTHDR(&message);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof sent);
  std::memcpy(CMSG_DATA(head), &sent, sizeof sent);
  int count = 0;
  while (count < 100'000 && syscall(SYS_sendmsg, ends[0], &message, 0) > 0) ++count;
  std::printf("%s\n", count < 5'000 ? "few" : "many");
}

// Time, and staying.

void wait_for_ever() {
  int ends[2] = {};
  pipe(ends);
  char byte = 0;
  syscall(SYS_read, ends[0], &byte, 1);
}
void stop_itself() { say("stop", syscall(SYS_kill, syscall(SYS_getpid), SIGSTOP)); }
void ignore_all() {
  for (int each = 1; each < NSIG; ++each) signal(each, SIG_IGN);
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  compute();
}
// In pieces, each of which is within the patience.
void compute_in_pieces() {
  timespec now{};
  for (;;) {
    compute_a_while();
    clock_gettime(CLOCK_REALTIME, &now);
  }
}
void use_processor() {
  const rlimit second{.rlim_cur = 1, .rlim_max = 2};
  setrlimit(RLIMIT_CPU, &second);
  compute();
}
void leave_world() {
  close(kLink);
  compute();
}
void new_session() {
  say("setsid", setsid());
  compute();
}
void crash_hard() {
  const rlimit more{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  setrlimit(RLIMIT_CORE, &more);
  raise(SIGSEGV);
}

constexpr Attempt kAttempts[] = {{"kill_others", kill_others},
                                 {"open_others", open_others},
                                 {"attach", attach},
                                 {"be_traced", be_traced},
                                 {"read_memory", read_memory},
                                 {"write_memory", write_memory},
                                 {"take_descriptor", take_descriptor},
                                 {"limits", limits},
                                 {"priorities", priorities},
                                 {"marks", marks},
                                 {"own_rules", own_rules},
                                 {"fork_bomb", fork_bomb},
                                 {"vfork_bomb", vfork_bomb},
                                 {"fork_chain", fork_chain},
                                 {"daemonise", daemonise},
                                 {"thread_bomb", thread_bomb},
                                 {"run_shell", run_shell},
                                 {"run_in_child", run_in_child},
                                 {"run_set_uid", run_set_uid},
                                 {"run_by_descriptor", run_by_descriptor},
                                 {"run_itself", run_itself},
                                 {"private_memory", private_memory},
                                 {"shared_memory", shared_memory},
                                 {"unmapped_memory", unmapped_memory},
                                 {"deep_stack", deep_stack},
                                 {"pipes", pipes},
                                 {"sent_descriptors", sent_descriptors},
                                 {"compute", compute},
                                 {"wait_for_ever", wait_for_ever},
                                 {"stop_itself", stop_itself},
                                 {"ignore_all", ignore_all},
                                 {"compute_in_pieces", compute_in_pieces},
                                 {"use_processor", use_processor},
                                 {"leave_world", leave_world},
                                 {"new_session", new_session},
                                 {"crash_hard", crash_hard}};

}  // namespace

int main(int count, char** words) { return attempts::make(kAttempts, count, words); }
