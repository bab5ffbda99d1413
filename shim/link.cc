#include "shim/link.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "shim/begin.h"
#include "shim/own_clock.h"
#include "shim/paths.h"

namespace simbench::shim {
namespace {

constexpr int kFirstOfNewLinks = kClockPage + 1;

bool links[kMostDescriptors];
int first_link = -1;
Identity own_identity{};
bool others_watch = false;
// Where only the clock is the world's, threads share the link.
pthread_mutex_t shared_link = PTHREAD_MUTEX_INITIALIZER;

__thread int own_link __attribute__((tls_model("initial-exec"))) = -1;
__thread int thread_number __attribute__((tls_model("initial-exec"))) = 0;

// A page that a forked process finds empty: until it has taken the link that waits for it, it has
// its parent's.
struct ForkMark {
  bool is_known;
};
ForkMark* fork_mark = nullptr;
Newcomer next_process{};

// Without a world there is nothing to go on with.
[[noreturn]] void lose() {
  machine_call(SYS_exit_group, 125);
  __builtin_unreachable();
}

[[noreturn]] void lose(const char* why) {
  machine_call(SYS_write, STDERR_FILENO, why, strlen(why));
  lose();
}

ssize_t transfer(bool is_request, iovec* pieces, std::size_t count, int passed = -1) {
  msghdr message{};
  message.msg_iov = pieces;
  message.msg_iovlen = count;
  alignas(cmsghdr) unsigned char control[CMSG_SPACE(sizeof passed)] = {};
  if (passed >= 0) {
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr& head = *CMSG_FIRSTHDR(&message);
    head.cmsg_level = SOL_SOCKET;
    head.cmsg_type = SCM_RIGHTS;
    head.cmsg_len = CMSG_LEN(sizeof passed);
    memcpy(CMSG_DATA(&head), &passed, sizeof passed);
  }
  const long call = is_request ? SYS_sendmsg : SYS_recvmsg;
  ssize_t moved = 0;
  do {
    moved = machine_call(call, own_link, &message, is_request ? MSG_NOSIGNAL : 0);
  } while (moved < 0 && errno == EINTR);
  return moved;
}

void add_link(int link) {
  if (link < 0 || link >= kMostDescriptors) lose("simbench: no descriptor is left for a link\n");
  links[link] = true;
  own_link = link;
}

void drop_link(int link) {
  links[link] = false;
  machine_call(SYS_close, link);
}

void mark_process() {
  if (fork_mark == nullptr) {
    void* page =
        mmap(nullptr, sizeof(ForkMark), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED || madvise(page, sizeof(ForkMark), MADV_WIPEONFORK) != 0) lose();
    fork_mark = static_cast<ForkMark*>(page);
  }
  fork_mark->is_known = true;
}

// In a process that has been forked, before its first request.
void become_child() {
  mark_process();
  if (next_process.link < 0) lose("simbench: a process was made past fork()\n");
  for (int link = 0; link < kMostDescriptors; ++link) {
    if (links[link] && link != next_process.link) drop_link(link);
  }
  add_link(next_process.link);
  next_process = {};
  forget_parent();
  if (ask_for({.call = Call::kHello}, own_identity) < 0) lose();
  thread_number = own_identity.thread;
}

// No signal comes between a request and its reply.
class NoSignals {
 public:
  NoSignals() {
    const std::uint64_t all = ~std::uint64_t{0};
    machine_call(SYS_rt_sigprocmask, SIG_SETMASK, &all, &before_, sizeof all);
  }
  ~NoSignals() { machine_call(SYS_rt_sigprocmask, SIG_SETMASK, &before_, nullptr, sizeof before_); }
  // What is blocked otherwise.
  sigset_t before() const {
    sigset_t set{};
    memcpy(&set, &before_, sizeof before_);
    return set;
  }

 private:
  std::uint64_t before_ = 0;
};

// Returns the reply's error.
std::int32_t converse(Request& header, Sent head, Sent tail, int passed, Reply& answer,
                      Received& received) {
  iovec out[] = {{&header, sizeof header},
                 {const_cast<void*>(head.data), head.size},
                 {const_cast<void*>(tail.data), tail.size}};
  const NoSignals quiet;
  if (transfer(true, out, 3, passed) < 0) lose();
  iovec in[] = {{&answer, sizeof answer}, {received.data, received.capacity}};
  if (transfer(false, in, 2) < static_cast<ssize_t>(sizeof answer)) lose();
  received.size = answer.size;
  others_watch = (answer.error & kIsWatched) != 0;
  if ((answer.error & kHasSignals) != 0) count_handlers(quiet.before());
  return answer.error & ~(kIsWatched | kHasSignals);
}

std::int64_t ask_passing(const Request& request, Sent head, Sent tail, int passed,
                         Received* reply) {
  if (!fork_mark->is_known) become_child();
  const bool shares = own_identity.only_clock != 0;
  if (shares) {
    pthread_mutex_lock(&shared_link);
    own_link = first_link;
  }
  if (own_link < 0) lose("simbench: a thread was made past pthread_create()\n");
  Request header = request;
  if (header.fd >= 0) header.fd = number_of(header.fd);
  header.size = static_cast<std::uint32_t>(head.size + tail.size);
  Reply answer{};
  char nothing = 0;
  Received none{.data = &nothing};
  const int before = errno;
  std::int32_t error =
      converse(header, head, tail, passed, answer, reply != nullptr ? *reply : none);
  if (shares) pthread_mutex_unlock(&shared_link);
  errno = before;
  if ((error & kHasExpirations) != 0) make_signals();
  error &= ~kHasExpirations;
  return error == 0 ? answer.value : refuse(error);
}

const char* variable_in(const char* name, char* const* environment) {
  const std::size_t size = strlen(name);
  for (; *environment != nullptr; ++environment) {
    if (strncmp(*environment, name, size) == 0 && (*environment)[size] == '=') {
      return *environment + size + 1;
    }
  }
  return nullptr;
}

int digits_in(const char* text) {
  int number = 0;
  for (; *text >= '0' && *text <= '9'; ++text) number = 10 * number + (*text - '0');
  return number;
}

// Before the constructors of all libraries, libc's among them (-z initfirst): the environment is
// the argument's, and no other code has run.
__attribute__((constructor)) void join_world(int /*count*/, char** /*words*/, char** environment) {
  const char* number = variable_in(kLinkVariable, environment);
  if (number == nullptr) return;
  first_link = digits_in(number);
  add_link(first_link);
  machine_call(SYS_fcntl, first_link, F_SETFD, FD_CLOEXEC);
  mark_process();
  serve_refused_calls();
  take_folder(variable_in(kFolderVariable, environment));
  const char* kept = variable_in(kDescriptorsVariable, environment);
  std::int32_t numbers[kMostDescriptors];
  std::size_t count = 0;
  if (kept != nullptr) count = take_descriptors(kept, numbers);
  const Request hello{.call = Call::kHello, .a = kept != nullptr ? 1 : 0};
  if (ask_for(hello, own_identity, {numbers, count * sizeof numbers[0]}) < 0) lose();
  thread_number = own_identity.thread;
  if (own_identity.only_clock != 0) {
    open_own_clock();
  } else {
    hide_machine(environment);
    begin_files();
    watch_thread();
  }
}

}  // namespace

bool has_world() { return first_link >= 0; }

bool is_simulated() { return has_world() && own_identity.only_clock == 0; }

bool is_link(int fd) { return fd >= 0 && fd < kMostDescriptors && links[fd]; }

const Identity& identity() {
  if (has_world() && !fork_mark->is_known) become_child();
  return own_identity;
}

int own_thread() { return thread_number; }

bool has_link() { return own_link >= 0; }

bool is_watched() { return others_watch; }

std::int64_t ask(const Request& request, Sent head, Sent tail, Received* reply) {
  return ask_passing(request, head, tail, -1, reply);
}

bool announce(Call call, Newcomer& newcomer) {
  int ends[2] = {};
  if (machine_call(SYS_socketpair, AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) < 0) {
    return false;
  }
  newcomer.link =
      static_cast<int>(machine_call(SYS_fcntl, ends[1], F_DUPFD_CLOEXEC, kFirstOfNewLinks));
  machine_call(SYS_close, ends[1]);
  newcomer.number = static_cast<int>(ask_passing({.call = call}, {}, {}, ends[0], nullptr));
  const int error = errno;
  machine_call(SYS_close, ends[0]);
  if (newcomer.number >= 0 && newcomer.link >= 0) {
    links[newcomer.link] = true;
    if (call == Call::kNewProcess) next_process = newcomer;
    return true;
  }
  if (newcomer.link >= 0) machine_call(SYS_close, newcomer.link);
  errno = error;
  return false;
}

void tell_started(const Newcomer& newcomer, bool is_thread, int machine_number) {
  const int error = errno;
  next_process = {};
  if (!is_thread || machine_number == 0) drop_link(newcomer.link);
  ask({.call = Call::kStarted, .a = newcomer.number, .b = machine_number});
  errno = error;
}

void begin_thread(const Newcomer& newcomer) {
  add_link(newcomer.link);
  Identity own{};
  if (ask_for({.call = Call::kHello, .b = machine_call(SYS_gettid)}, own) < 0) lose();
  thread_number = own.thread;
}

void end_thread() {
  if (own_link < 0) return;
  Request last{.call = Call::kEndThread, .b = machine_call(SYS_gettid)};
  iovec out[] = {{&last, sizeof last}};
  const std::uint64_t most = ~(std::uint64_t{1} << (SIGSYS - 1));
  machine_call(SYS_rt_sigprocmask, SIG_SETMASK, &most, nullptr, sizeof most);
  links[own_link] = false;
  transfer(true, out, 1);
  machine_call(SYS_close, own_link);
  own_link = -1;
}

int link_number() { return own_link; }

void keep_link(bool over_exec) {
  machine_call(SYS_fcntl, own_link, F_SETFD, over_exec ? 0 : FD_CLOEXEC);
}

int refuse(int error) {
  errno = error;
  return -1;
}

void give_up(const char* what, const char* why) {
  // The world ends the program in place of a reply.
  ask({.call = Call::kNote}, {what, strlen(what)}, {why, strlen(why)});
  lose();
}

void* find_real(const char* name) {
  void* function = dlsym(RTLD_NEXT, name);
  if (function == nullptr) give_up(name);
  return function;
}

}  // namespace simbench::shim
