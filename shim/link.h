// The shim's end of the conversation with the world, and the program's descriptors.
//
// The shim is preloaded into a program (LD_PRELOAD) that runs in a simulated world. It takes each
// libc call that concerns time, waiting, network or chance, and asks the world; everything else is
// the real call. Without a link in the environment all calls are the real ones.
//
// The world may say that it has the clock alone (Identity::only_clock), for a program on a real
// host: then sockets, waits, timers, files and chance are the machine's, and only the system clock
// is the world's, with the stamps that the kernel takes of datagrams (shim/own_clock.h). The
// program is root of its host and one process as ever. Waits until a time of the system clock are
// converted when they begin; timers that make signals cannot be set to one.
//
// It has no libraries but libc, makes no threads and takes no memory from the heap. Each thread of
// the program has a link of its own, and one runs at a time (shim/protocol.h): what the shim keeps
// in memory needs no locks, but may have changed after each request. While a thread asks, signals
// wait; their handlers run before ask() returns.
//
//   const TimerSetting wanted{.left = kSecond, .interval = 0};
//   TimerSetting before{};
//   Received reply{.data = &before, .capacity = sizeof before};
//   ask({.call = Call::kSetTimer, .fd = 7}, {&wanted, sizeof wanted}, {}, &reply);
#pragma once

#include <signal.h>
#include <time.h>

#include <cstddef>
#include <cstdint>

#include "shim/machine.h"
#include "shim/protocol.h"

// A function of the program's view of libc.
#define SIMBENCH_CALL extern "C" __attribute__((visibility("default")))

namespace simbench::shim {

inline constexpr std::int64_t kSecond = 1'000'000'000;  // ns

struct Sent {
  const void* data = nullptr;
  std::size_t size = 0;
};

struct Received {
  void* data = nullptr;
  std::size_t capacity = 0;
  std::size_t size = 0;  // out: how much came, which may be more than the capacity
};

// Whether there is a world, and whether all is the world's rather than the clock alone.
bool has_world();
bool is_simulated();
// Whether the descriptor is a way to it.
bool is_link(int fd);
const Identity& identity();
// The number of this thread, as gettid() has it.
int own_thread();
// Whether this thread can ask: not after end_thread().
bool has_link();

// Returns the reply's value, or -1 with errno. Two pieces of data are sent one after the other.
std::int64_t ask(const Request& request, Sent head = {}, Sent tail = {}, Received* reply = nullptr);

// The same, where the reply is one value.
template <class Value>
std::int64_t ask_for(const Request& request, Value& value, Sent head = {}) {
  Received reply{.data = &value, .capacity = sizeof value};
  return ask(request, head, {}, &reply);
}

// A thread or process that is to be: its number, and its end of its link.
struct Newcomer {
  int number = -1;
  int link = -1;
};
// `call` is kNewThread or kNewProcess. False with errno.
bool announce(Call call, Newcomer& newcomer);
// It has this number of the machine's, or 0: it could not be started. Waits until it is at its
// first request; closes the link, which is the newcomer's, unless that is a thread.
void tell_started(const Newcomer& newcomer, bool is_thread, int machine_number);
// In the new thread, and before its end.
void begin_thread(const Newcomer& newcomer);
void end_thread();
// The descriptor of this thread's link, and whether it goes on over exec().
int link_number();
void keep_link(bool over_exec);

// Whether another thread of the host waits for what this one may do to real descriptors.
bool is_watched();

// Makes the signals of the timers that have expired, which the world tells with a reply.
void make_signals();
// Counts the handlers that waiting signals will run once only these are blocked.
void count_handlers(const sigset_t& blocked);
void forget_signal_timers();
// How many signals have run a handler in this thread so far, and of these how many without
// SA_RESTART.
struct HandledSignals {
  std::uint64_t all = 0;
  std::uint64_t interrupting = 0;
};
HandledSignals handled_signals();
// Returns -1, with this errno.
int refuse(int error);

// Says what cannot be simulated, and ends the program.
[[noreturn]] void give_up(const char* what, const char* why = "");

// What libc would have done.
template <class Function>
Function real(Function /*type*/, const char* name) {
  extern void* find_real(const char*);
  return reinterpret_cast<Function>(find_real(name));
}
#define SIMBENCH_REAL(function) ::simbench::shim::real(&::function, #function)

// kLocal is real, and others of the host make it ready: Unix-domain sockets, pipes, eventfd().
enum class Kind : std::uint8_t {
  kReal,
  kSocket,
  kTimer,
  kEpoll,
  kChance,
  kNetlink,
  kLocal,
  kCard,
  kPulses,
  kStream,
  kOwnTimer
};

// Whether the world says when it is ready; of others, the kernel does. A set of epoll() has both.
constexpr bool is_of_the_world(Kind kind) {
  return kind == Kind::kSocket || kind == Kind::kStream || kind == Kind::kTimer ||
         kind == Kind::kEpoll || kind == Kind::kCard || kind == Kind::kPulses;
}

inline constexpr int kMostDescriptors = 1024;

Kind kind_of(int fd);
// Nothing for -1.
void set_kind(int fd, Kind kind);
// A descriptor that stands for something of the world, or -1 with errno. The kernel keeps it taken,
// with the flags of fcntl().
int open_descriptor(Kind kind, bool nonblocking, bool close_on_exec);
// One that the world would not have; errno stays.
void discard_descriptor(int fd);
// The world's number of what a descriptor stands for, which its copies share. Requests have
// descriptors, of which ask() makes numbers.
int number_of(int fd);
// Whether a descriptor still has the number.
bool is_open(int number);
bool is_blocking(int fd);
bool is_time(const timespec& time);
// Times beyond 292 years are never.
std::int64_t nanoseconds(const timespec& time);
timespec to_timespec(std::int64_t ns);

// Timers of the world, which the request names. They return -1 with errno; `before` may be null.
int set_world_timer(const Request& request, const itimerspec& setting, itimerspec* before);
int query_world_timer(const Request& request, itimerspec& setting);

// As wait_for_ready() for POLLIN (shim/waiting.h).
bool wait_for_input(int fd, std::int64_t timeout_ns);
// read() of a timer.
std::int64_t read_timer(int fd, void* data, std::size_t size);

}  // namespace simbench::shim
