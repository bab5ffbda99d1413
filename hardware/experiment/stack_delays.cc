#include "hardware/experiment/stack_delays.h"

#include <arpa/inet.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <boost/random/mersenne_twister.hpp>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "hardware/clock/monotonic_time.h"
#include "hardware/descriptor.h"
#include "hardware/experiment/network_sandbox.h"

namespace simbench::hardware {
namespace {

constexpr unsigned kMember = 0;
constexpr std::uint16_t kStackPort = 47123;
constexpr std::size_t kDatagramBytes = 48;
constexpr std::size_t kWarmUp = 100;  // messages that are not kept
constexpr int kPatienceMs = 2000;
constexpr std::uint64_t kSpacingSeed = 1;
constexpr auto kLeastSpacing = std::chrono::microseconds(5000);
constexpr std::uint64_t kSpacingRangeUs = 10'000;

// Instants of CLOCK_REALTIME.
struct Passed {
  HostTime called{};
  HostTime left{};
  HostTime arrived{};
  HostTime returned{};
};

[[noreturn]] void fail_step(const std::string& doing) {
  throw std::runtime_error("measuring the stack: " + doing + ": " + std::strerror(errno));
}

HostTime host_time(const timespec& at) {
  return HostTime(std::chrono::seconds(at.tv_sec) + Nanoseconds(at.tv_nsec));
}

sockaddr_in address_of(const std::string& dotted) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(kStackPort);
  inet_pton(AF_INET, dotted.c_str(), &address.sin_addr);
  return address;
}

void ask_for_stamps(int socket, unsigned which) {
  const unsigned flags = which | SOF_TIMESTAMPING_SOFTWARE;
  if (setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPING, &flags, sizeof flags) != 0) {
    fail_step("asking for the kernel's stamps");
  }
}

// The software stamp of the next datagram, or of the error queue's next entry.
HostTime stamp_of_next(int socket, int flags) {
  std::array<char, 256> data{};
  iovec piece{data.data(), data.size()};
  alignas(cmsghdr) std::array<char, 512> control{};
  msghdr header{};
  header.msg_iov = &piece;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  if (recvmsg(socket, &header, flags) < 0) fail_step("reading a stamp");
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPING) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
    return host_time(stamp);
  }
  throw std::runtime_error("measuring the stack: the kernel gave no stamp");
}

void wait_for(int socket, short events) {
  pollfd waits{socket, events, 0};
  const int ready = poll(&waits, 1, kPatienceMs);
  if (ready == 0) throw std::runtime_error("measuring the stack: a datagram was lost");
  if (ready < 0) fail_step("poll");
}

// The receiving thread, in a namespace of its own.
class StackReceiver {
 public:
  StackReceiver()
      : thread_([this, told = connected_->get_future()]() mutable { run(std::move(told)); }) {}
  ~StackReceiver() {
    stop_ = true;
    connected_.reset();  // a thread that still waits for it ends
    thread_.join();
  }
  StackReceiver(const StackReceiver&) = delete;
  StackReceiver& operator=(const StackReceiver&) = delete;

  // Returns when it can receive.
  void connect() {
    // The thread must have its namespace before the pair is made.
    NetworkSandbox::connect(kMember, member_.get_future().get());
    connected_->set_value();
    ready_.get_future().get();
  }

  // Waits for message `number`; sets when it arrived and when the call returned.
  void take(std::size_t number, Passed& message) {
    const MonotonicTime deadline = monotonic_now() + std::chrono::milliseconds(kPatienceMs);
    while (received_.load(std::memory_order_acquire) <= number) {
      if (monotonic_now() > deadline) {
        throw std::runtime_error("measuring the stack: a datagram was lost");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    message.arrived = arrived_;
    message.returned = returned_;
  }

 private:
  void run(std::future<void> told) {
    Descriptor socket;
    try {
      if (!NetworkSandbox::leave_hub()) fail_step("a namespace for the receiver");
      member_.set_value(gettid());
    } catch (...) {
      member_.set_exception(std::current_exception());
      return;
    }
    try {
      told.get();
      if (!NetworkSandbox::set_up_member(kMember)) fail_step("setting up the receiver");
      socket.reset(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
      const sockaddr_in own = address_of(NetworkSandbox::member_address(kMember));
      if (bind(socket.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
        fail_step("binding the receiver");
      }
      ask_for_stamps(socket.number(), SOF_TIMESTAMPING_RX_SOFTWARE);
      ready_.set_value();
    } catch (...) {
      ready_.set_exception(std::current_exception());
      return;
    }
    receive(socket.number());
  }

  void receive(int socket) {
    constexpr int kLookForStopMs = 50;
    while (!stop_) {
      pollfd waits{socket, POLLIN, 0};
      if (poll(&waits, 1, kLookForStopMs) <= 0) continue;
      const HostTime arrived = stamp_of_next(socket, MSG_DONTWAIT);
      returned_ = read_system_clock();
      arrived_ = arrived;
      received_.fetch_add(1, std::memory_order_release);
    }
  }

  std::promise<pid_t> member_;
  std::optional<std::promise<void>> connected_{std::in_place};
  std::promise<void> ready_;
  std::atomic<bool> stop_ = false;
  std::atomic<std::size_t> received_ = 0;
  HostTime arrived_{};
  HostTime returned_{};
  std::thread thread_;  // last: it uses the others
};

class BusyThreads {
 public:
  explicit BusyThreads(unsigned count) {
    threads_.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
      threads_.emplace_back([this] {
        while (!stop_.load(std::memory_order_relaxed)) {
        }
      });
    }
  }
  ~BusyThreads() {
    stop_ = true;
    for (std::thread& each : threads_) each.join();
  }
  BusyThreads(const BusyThreads&) = delete;
  BusyThreads& operator=(const BusyThreads&) = delete;

 private:
  std::atomic<bool> stop_ = false;
  std::vector<std::thread> threads_;
};

Descriptor connected_sender() {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in to = address_of(NetworkSandbox::member_address(kMember));
  if (::connect(socket.number(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    fail_step("connecting the sender");
  }
  ask_for_stamps(socket.number(), SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_OPT_TSONLY);
  return Descriptor(socket.release());
}

double microseconds_between(HostTime from, HostTime to) {
  if (to < from) {
    throw std::runtime_error(
        "measuring the stack: stamps go backwards; was the system clock set meanwhile?");
  }
  return std::chrono::duration<double, std::micro>(to - from).count();
}

}  // namespace

StackDelays measure_stack_delays(const StackDelaySettings& settings) {
  ask_for_exact_timers();
  StackReceiver receiver;
  receiver.connect();
  const Descriptor sender = connected_sender();
  const BusyThreads load(settings.busy_threads);
  const std::array<char, kDatagramBytes> datagram{};
  boost::random::mt19937_64 generator(kSpacingSeed);
  StackDelays delays;
  for (std::size_t i = 0; i < settings.messages + kWarmUp; ++i) {
    if (settings.cancelled && settings.cancelled()) break;
    std::this_thread::sleep_for(kLeastSpacing +
                                std::chrono::microseconds(generator() % kSpacingRangeUs));
    Passed message;
    message.called = read_system_clock();
    if (send(sender.number(), datagram.data(), datagram.size(), 0) < 0) fail_step("sending");
    wait_for(sender.number(), 0);  // an entry of the error queue is always told
    message.left = stamp_of_next(sender.number(), MSG_ERRQUEUE | MSG_DONTWAIT);
    receiver.take(i, message);
    if (i < kWarmUp) continue;
    delays.transmit_us.push_back(microseconds_between(message.called, message.left));
    delays.passage_us.push_back(microseconds_between(message.left, message.arrived));
    delays.wake_up_us.push_back(microseconds_between(message.arrived, message.returned));
  }
  return delays;
}

}  // namespace simbench::hardware
