// Does what a seed says: a sequence of calls that open, copy and close descriptors, make them
// ready, and wait for them in each way that there is. Prints a line for each call: its result, its
// errno, and what it filled in. No line depends on the machine or on time, so that the same seed
// prints the same under Linux and in the simulated world.
//
//   sequences FIRST COUNT [stay]
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/select.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr int kFirst = 20;  // the descriptors of a sequence
constexpr int kCount = 16;

// What a descriptor stands for: the world has some, the kernel the others.
enum class What { kNothing, kSocket, kTimer, kEpoll, kPipe, kCounter, kPair, kSignals, kFile };

class Sequence {
 public:
  explicit Sequence(unsigned seed) : chance_(seed), is_simulated_set_(seed % 2 == 0) {}

  void run() {
    for (int i = 0; i < 40; ++i) step();
    for (int fd = kFirst; fd < kFirst + kCount; ++fd) close(fd);
  }

 private:
  int pick(int count) { return static_cast<int>(chance_() % static_cast<unsigned>(count)); }
  int any() { return kFirst + pick(kCount); }
  void say(const char* call, long result, const std::string& more = "") {
    std::printf("%s %ld%s%s %s\n", call, result, result < 0 ? " " : "",
                result < 0 ? strerrorname_np(errno) : "", more.c_str());
  }
  // To a number of its own, so that numbers are the same everywhere.
  int place(int fd, What what) {
    if (fd < 0) return -1;
    const int at = any();
    if (dup2(fd, at) < 0) return -1;
    close(fd);
    what_[static_cast<std::size_t>(at - kFirst)] = what;
    return at;
  }
  What what(int fd) const { return what_[static_cast<std::size_t>(fd - kFirst)]; }

  void open_one() {
    switch (pick(8)) {
      case 0: {
        const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
        sockaddr_in own{};
        own.sin_family = AF_INET;
        own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        bind(fd, reinterpret_cast<sockaddr*>(&own), sizeof own);
        say("udp", place(fd, What::kSocket));
        return;
      }
      case 1:
        say("timerfd", place(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK), What::kTimer));
        return;
      case 2:
        say("epoll", place(epoll_create1(0), What::kEpoll));
        return;
      case 3: {
        int ends[2];
        if (pipe2(ends, O_NONBLOCK) < 0) return;
        say("pipe", place(ends[0], What::kPipe));
        say("pipe", place(ends[1], What::kPipe));
        return;
      }
      case 4:
        say("eventfd",
            place(eventfd(static_cast<unsigned>(pick(3)), EFD_NONBLOCK), What::kCounter));
        return;
      case 5: {
        int ends[2];
        const int type = pick(2) == 0 ? SOCK_STREAM : SOCK_SEQPACKET;
        if (socketpair(AF_UNIX, type | SOCK_NONBLOCK, 0, ends) < 0) return;
        say("socketpair", place(ends[0], What::kPair));
        say("socketpair", place(ends[1], What::kPair));
        return;
      }
      case 6: {
        sigset_t set{};
        sigemptyset(&set);
        sigaddset(&set, SIGUSR1);
        say("signalfd", place(signalfd(-1, &set, SFD_NONBLOCK), What::kSignals));
        return;
      }
      default:
        say("file", place(open("sequence.txt", O_RDWR | O_CREAT, 0600), What::kFile));
        return;
    }
  }

  void close_or_copy() {
    const int fd = any();
    if (pick(3) > 0) {
      say("close", close(fd), std::to_string(fd));
      what_[static_cast<std::size_t>(fd - kFirst)] = What::kNothing;
      return;
    }
    const int to = any();
    const int copy = dup2(fd, to);
    say("dup2", copy, std::to_string(fd) + " " + std::to_string(to));
    if (copy >= 0) what_[static_cast<std::size_t>(to - kFirst)] = what(fd);
  }

  // Makes something ready, or takes that away.
  void act() {
    const int fd = any();
    switch (what(fd)) {
      case What::kSocket: {
        // To a socket of the sequence, itself perhaps.
        const int to = any();
        sockaddr_in name{};
        socklen_t size = sizeof name;
        if (what(to) != What::kSocket ||
            getsockname(to, reinterpret_cast<sockaddr*>(&name), &size) < 0) {
          char bytes[64];
          say("recv", recv(fd, bytes, sizeof bytes, 0));
          return;
        }
        say("sendto", sendto(fd, "datagram", 8, 0, reinterpret_cast<sockaddr*>(&name), size));
        return;
      }
      case What::kTimer: {
        if (pick(2) == 0) {
          std::uint64_t times = 0;
          say("read timer", read(fd, &times, sizeof times));
          return;
        }
        itimerspec setting{};
        setting.it_value.tv_nsec = pick(3) == 0 ? 0 : 1;
        say("timerfd_settime", timerfd_settime(fd, 0, &setting, nullptr));
        const timespec moment{.tv_sec = 0, .tv_nsec = 2'000'000};
        nanosleep(&moment, nullptr);
        return;
      }
      case What::kCounter: {
        std::uint64_t value = 1;
        if (pick(2) == 0) {
          say("write counter", write(fd, &value, sizeof value));
        } else {
          const ssize_t got = read(fd, &value, sizeof value);
          say("read counter", got, got > 0 ? std::to_string(value) : "");
        }
        return;
      }
      case What::kSignals: {
        if (pick(2) == 0) {
          say("raise", raise(SIGUSR1));
          return;
        }
        signalfd_siginfo info{};
        const ssize_t got = read(fd, &info, sizeof info);
        say("read signal", got, got > 0 ? std::to_string(info.ssi_signo) : "");
        return;
      }
      default: {
        char bytes[100] = {};
        if (pick(2) == 0) {
          say("write", write(fd, bytes, 1 + static_cast<std::size_t>(pick(99))));
        } else {
          say("read", read(fd, bytes, 1 + static_cast<std::size_t>(pick(99))));
        }
      }
    }
  }

  void look_by_poll() {
    std::vector<pollfd> interests;
    for (int i = 0, count = pick(6); i < count; ++i) {
      const int events =
          (pick(2) == 0 ? POLLIN : 0) | (pick(3) == 0 ? POLLOUT : 0) | (pick(5) == 0 ? POLLPRI : 0);
      interests.push_back(
          {.fd = pick(9) == 0 ? -1 : any(), .events = static_cast<short>(events), .revents = 0});
    }
    int ready = 0;
    if (pick(2) == 0) {
      ready = poll(interests.data(), interests.size(), pick(2));
    } else {
      const timespec limit{.tv_sec = 0, .tv_nsec = pick(2) * 1'000'000};
      ready = ppoll(interests.data(), interests.size(), &limit, nullptr);
    }
    std::string found;
    for (const pollfd& each : interests) found += std::to_string(each.revents) + " ";
    say("poll", ready, found);
  }

  // In memory that ends where the bits end, so that a bit too many is seen.
  void look_by_select() {
    constexpr std::size_t kBytes = sizeof(fd_set);
    std::array<unsigned char, 3 * kBytes> memory{};
    memory.fill(0xA5);
    const int limit = pick(kFirst + kCount + 2);
    std::array<fd_set*, 3> sets{};
    for (std::size_t i = 0; i < sets.size(); ++i) {
      if (pick(4) == 0) continue;
      sets[i] = reinterpret_cast<fd_set*>(memory.data() + i * kBytes);
      for (int fd = 0; fd < limit; ++fd) {
        FD_CLR(fd, sets[i]);
        if (fd >= kFirst && pick(6) == 0) FD_SET(fd, sets[i]);
      }
    }
    timeval none{.tv_sec = 0, .tv_usec = pick(2) * 1000};
    const int ready = select(limit, sets[0], sets[1], sets[2], &none);
    std::uint64_t sum = 0;
    for (const unsigned char byte : memory) sum = sum * 31 + byte;
    say("select", ready, std::to_string(ready < 0 ? 0 : sum));
  }

  void control() {
    const int set = any();
    const int fd = any();
    // The order of the world's and the kernel's own in one set is not defined.
    const bool is_simulated = what(fd) == What::kSocket || what(fd) == What::kTimer;
    if (what(set) == What::kEpoll && what(fd) != What::kNothing && what(fd) != What::kEpoll &&
        is_simulated != is_simulated_set_) {
      return;
    }
    epoll_event event{};
    const auto perhaps = [this](int of, std::uint32_t flag) { return pick(of) == 0 ? flag : 0U; };
    event.events = perhaps(1 + pick(2), EPOLLIN) | perhaps(3, EPOLLOUT) | perhaps(3, EPOLLET) |
                   perhaps(5, EPOLLONESHOT);
    event.data.u64 = static_cast<std::uint64_t>(100 * set + fd);
    constexpr int kOperations[] = {EPOLL_CTL_ADD, EPOLL_CTL_ADD, EPOLL_CTL_MOD, EPOLL_CTL_DEL};
    const int operation = kOperations[pick(4)];
    say("epoll_ctl", epoll_ctl(set, operation, fd, &event),
        std::to_string(operation) + " " + std::to_string(set) + " " + std::to_string(fd));
  }

  void look_by_epoll() {
    const int set = any();
    std::array<epoll_event, 8> events{};
    const int most = pick(9);
    const int ready = epoll_wait(set, events.data(), most, pick(2));
    std::string found;
    for (int i = 0; i < ready; ++i) {
      const epoll_event& each = events[static_cast<std::size_t>(i)];
      found += std::to_string(each.data.u64) + ":" + std::to_string(each.events) + " ";
    }
    say("epoll_wait", ready, found);
  }

  void step() {
    switch (pick(12)) {
      case 0:
      case 1:
      case 2:
        return open_one();
      case 3:
        return close_or_copy();
      case 4:
      case 5:
        return act();
      case 6:
        return look_by_poll();
      case 7:
        return look_by_select();
      case 8:
      case 9:
        return control();
      default:
        return look_by_epoll();
    }
  }

  std::mt19937 chance_;
  bool is_simulated_set_;
  std::array<What, kCount> what_{};
};

}  // namespace

int main(int count, char** words) {
  if (count < 3) return 2;
  sigset_t blocked{};
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  signal(SIGPIPE, SIG_IGN);
  const int first = std::atoi(words[1]);
  for (int seed = first; seed < first + std::atoi(words[2]); ++seed) {
    std::printf("sequence %d\n", seed);
    Sequence(static_cast<unsigned>(seed)).run();
    const timespec none{};
    sigtimedwait(&blocked, nullptr, &none);
  }
  std::puts("done");
  std::fflush(stdout);
  if (count > 3) pause();  // as daemons do
  return 0;
}
