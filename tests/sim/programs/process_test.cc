// What the world makes of requests that no honest program sends: it answers or ends the program
// with a note, whatever the bytes are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/timex.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/host_sync/join.h"
#include "scenarios/loader.h"
#include "shim/addresses.h"
#include "sim/programs/program.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using shim::Call;
using shim::Request;
using testing::HasSubstr;

// A request as it is sent: the struct, then its data.
using Packet = std::string;

template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

Packet packet(Request head, const std::string& data = "") {
  head.size = static_cast<std::uint32_t>(data.size());
  return raw(head) + data;
}

// A program that has sent all its requests before it reads a reply.
struct Heard {
  std::vector<shim::Reply> replies;
  std::string note;     // why it was ended; empty: it waits
  bool is_sane = true;  // each reply is as long as it says
};

class ProcessTest : public testing::Test {
 protected:
  Heard hear(const std::vector<Packet>& packets, double seconds = 10) {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
    for (const Packet& each : packets) {
      if (send(ends[1], each.data(), each.size(), MSG_DONTWAIT) < 0) break;  // the link is full
    }
    shutdown(ends[1], SHUT_WR);
    Heard heard;
    {
      static const scenarios::Scenario kStar =
          scenarios::load_scenario("6host_star", {{"/hosts/count", "3"},
                                                  {"/cameras/count", "3"},
                                                  {"/hosts/nic/hardware_stamps", "true"},
                                                  {"/hosts/pulse_lines/pps", "true"}});
      ServiceWorld world(kStar);
      world.spawn(run(world.host(1), ends[0], heard));
      world.run_until(seconds);
    }
    read_replies(ends[1], heard);
    close(ends[1]);
    return heard;
  }

 private:
  static Task<void> serve(Program& program, Heard& heard) {
    co_await program.serve();
    heard.note = program.ending();
  }
  static Task<void> run(SimHost& host, int link, Heard& heard) {
    HostNetwork network(host, 3);
    KernelClock kernel(host);
    CardClock card(host);
    PulseDevices pulses(host);
    HostProcesses processes;
    HostFiles files(host, "/no/folder");
    Program program({host, network, kernel, card, pulses, processes, files},
                    {.command = {"program"}, .link = link});
    std::vector<Task<void>> tasks;
    tasks.push_back(kernel.run());
    tasks.push_back(pulses.run());
    tasks.push_back(network.stamp_departures());
    tasks.push_back(network.answer_refused());
    tasks.push_back(serve(program, heard));
    co_await join_all(std::move(tasks));
  }

  static void read_replies(int link, Heard& heard) {
    // That the world has closed its end without reading all comes before the replies.
    int error = 0;
    socklen_t error_size = sizeof error;
    getsockopt(link, SOL_SOCKET, SO_ERROR, &error, &error_size);
    std::string bytes(sizeof(shim::Reply) + 2 * shim::kMostData, '\0');
    for (ssize_t size = 0; (size = recv(link, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;) {
      shim::Reply reply{};
      std::memcpy(&reply, bytes.data(), sizeof reply);
      const auto whole = static_cast<std::size_t>(size);
      heard.is_sane = heard.is_sane && whole == sizeof reply + reply.size;
      heard.replies.push_back(reply);
    }
  }
};

TEST_F(ProcessTest, AnswersWhatIsAsked) {
  const Heard heard = hear({packet({.call = Call::kHello}),
                            packet({.call = Call::kReadClock, .a = CLOCK_MONOTONIC}),
                            packet({.call = Call::kRandom, .a = shim::kMostData})});
  ASSERT_EQ(heard.replies.size(), 3U);
  EXPECT_EQ(heard.replies[0].size, sizeof(shim::Identity));
  EXPECT_EQ(heard.replies[2].size, shim::kMostData);
  EXPECT_TRUE(heard.is_sane);
  EXPECT_EQ(heard.note, "program: has closed its link");
}

TEST_F(ProcessTest, WhatIsNoRequestEndsTheProgram) {
  const Packet hello = packet({.call = Call::kHello});
  const auto note = [&](const Packet& bad) {
    const Heard heard = hear({hello, bad, hello});
    EXPECT_EQ(heard.replies.size(), 1U) << "nothing is answered after it";
    return heard.note;
  };
  EXPECT_EQ(note("x"), "program: sent a request of a wrong size");
  EXPECT_EQ(note(hello + "more"), "program: sent a request of a wrong size");
  EXPECT_EQ(note(hello.substr(0, 31)), "program: sent a request of a wrong size");
  EXPECT_EQ(note(packet({.call = Call::kNote}, std::string(shim::kMostData + 1, 'x'))),
            "program: sent a request of a wrong size");
  EXPECT_EQ(note(packet({.call = static_cast<Call>(99)})),
            "program: asked what the world does not know");
  EXPECT_EQ(note(packet({.call = Call::kBind, .fd = 7}, raw(shim::Address{}))),
            "program: used a socket that it never opened");
  EXPECT_EQ(note(packet({.call = Call::kReadTimer, .fd = 7})),
            "program: used a timer that it never opened");
  EXPECT_EQ(note(packet({.call = Call::kFetchPulse, .fd = 7})),
            "program: used a device that it never opened");
  EXPECT_EQ(note(packet({.call = Call::kRandom, .a = -1})),
            "program: asked for too many random bytes");
  EXPECT_EQ(note(packet({.call = Call::kAdjustClock}, "short")), "program: too little data");
}

TEST_F(ProcessTest, ANoteIsOneLineOfBoundedLength) {
  const Heard heard = hear({packet(
      {.call = Call::kNote}, std::string("\x1b[2J\nsecond line ") + std::string(60'000, '\xFF'))});
  EXPECT_THAT(heard.note, HasSubstr("\\x1b[2J\\x0asecond line \\xff"));
  EXPECT_EQ(heard.note.find('\n'), std::string::npos);
  EXPECT_LT(heard.note.size(), 2000U);
}

// More replies than the link holds: the world does not wait for the program to read them.
TEST_F(ProcessTest, AProgramThatReadsNoRepliesHoldsNobodyUp) {
  const std::vector<Packet> greedy(200, packet({.call = Call::kRandom, .a = shim::kMostData}));
  EXPECT_EQ(hear(greedy).note, "program: has closed its link");
}

TEST_F(ProcessTest, ClocksAreNotSetWhereLinuxWouldNot) {
  for (const std::int64_t reading : {std::int64_t{-1}, INT64_MAX, INT64_MAX - 1}) {
    const Heard heard =
        hear({packet({.call = Call::kSetClock, .a = CLOCK_REALTIME, .b = reading})});
    ASSERT_EQ(heard.replies.size(), 1U);
    EXPECT_EQ(heard.replies[0].error, EINVAL) << reading;
  }
}

// The wait ends when the world does; a timer that nobody waits for does not keep the world busy.
TEST_F(ProcessTest, ATimerThatIsNotAwaitedWakesNobody) {
  const shim::TimerSetting often{.left = 1, .interval = 1};
  const shim::Interest not_in_it{.fd = 5, .events = POLLOUT, .ready = 0};
  const Heard heard = hear({packet({.call = Call::kOpenTimer, .fd = 5, .a = CLOCK_MONOTONIC}),
                            packet({.call = Call::kSetTimer, .fd = 5}, raw(often)),
                            packet({.call = Call::kWait}, raw(not_in_it))},
                           3600);
  EXPECT_EQ(heard.replies.size(), 2U);
  EXPECT_EQ(heard.note, "") << "it waits for ever";
}

// Requests that are right in part.
class Hostile {
 public:
  explicit Hostile(std::uint64_t seed) : random_(seed) {}

  std::vector<Packet> packets(std::size_t count) {
    constexpr std::int64_t kFamilies[] = {AF_INET, AF_INET6, AF_PACKET | 3 << 16};
    const std::int64_t family = kFamilies[below(3)];
    std::vector<Packet> result{
        packet({.call = Call::kOpenSocket, .fd = 3, .a = SOCK_DGRAM, .b = family}),
        packet({.call = Call::kOpenTimer, .fd = 4, .a = CLOCK_REALTIME}),
        packet({.call = Call::kOpenDevice, .fd = 5, .a = 0}),
        packet({.call = Call::kOpenDevice, .fd = 6, .a = 1}),
        packet({.call = Call::kBind, .fd = 3}, raw(shim::ipv4_address(0, 9)))};
    while (result.size() < count) result.push_back(damaged(request()));
    return result;
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }

  std::int64_t number() {
    constexpr std::int64_t kNumbers[] = {0,
                                         1,
                                         2,
                                         3,
                                         4,
                                         -1,
                                         9,
                                         1'000,
                                         65'536,
                                         1'000'000'000,
                                         INT64_MAX,
                                         INT64_MIN,
                                         INT32_MAX,
                                         INT32_MIN,
                                         INT64_MAX / 2,
                                         shim::kWorldBegin};
    const std::int64_t some = kNumbers[below(std::size(kNumbers))];
    return one_in(4) ? static_cast<std::int64_t>(random_()) : some;
  }
  template <class T>
  T small() {
    return static_cast<T>(number());
  }
  shim::Address address() {
    const shim::IpAddress hosts[] = {shim::mapped(0),
                                     shim::mapped(0x0A000001),
                                     shim::mapped(0x0A000002),
                                     shim::mapped(0x7F000001),
                                     shim::mapped(small<std::uint32_t>()),
                                     {},
                                     shim::kLoopback6,
                                     shim::unique_local(2),
                                     shim::link_local(0x0A000001),
                                     shim::mapped(0xE0000181),
                                     shim::packed({.card = {0x01, 0x80, 0xC2, 0, 0, 0x0E}})};
    const std::uint16_t ports[] = {0, 9, 123, small<std::uint16_t>()};
    const std::uint16_t families[] = {AF_INET, AF_INET6, AF_PACKET, small<std::uint16_t>()};
    return {.host = hosts[below(std::size(hosts))],
            .scope = static_cast<std::uint32_t>(below(4)),
            .port = ports[below(4)],
            .family = families[below(4)]};
  }
  std::string filter() {
    std::string code;
    for (std::size_t i = below(6); i > 0; --i) {
      code += raw(sock_filter{.code = static_cast<std::uint16_t>(below(0x100)),
                              .jt = 0,
                              .jf = 0,
                              .k = small<std::uint32_t>()});
    }
    return code + raw(sock_filter{.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = 9});
  }
  std::string interests() {
    std::string data;
    for (std::size_t i = below(one_in(20) ? 8192 : 4); i > 0; --i) {
      data += raw(shim::Interest{.fd = static_cast<std::int32_t>(3 + below(5)),
                                 .events = small<std::int16_t>(),
                                 .ready = 0});
    }
    return data;
  }
  std::string adjustment() {
    timex setting{};
    setting.modes = one_in(3) ? small<unsigned int>() : 1U << below(16);
    setting.offset = number();
    setting.freq = number();
    setting.status = small<int>();
    setting.constant = number();
    setting.tick = one_in(2) ? 10'000 : number();
    setting.time.tv_sec = number();
    setting.time.tv_usec = number();
    return raw(setting);
  }
  std::string pulse_parameters() {
    pps_kparams wanted{};
    wanted.mode = one_in(3) ? small<int>() : PPS_CAPTUREASSERT | PPS_OFFSETASSERT;
    wanted.assert_off_tu.sec = number();
    wanted.assert_off_tu.nsec = small<std::int32_t>();
    return raw(wanted);
  }
  std::string data_of(Call call) {
    switch (call) {
      case Call::kAdjustClock:
        return adjustment();
      case Call::kWait:
        return interests();
      case Call::kSetTimer:
      case Call::kSetSignalTimer:
        return raw(shim::TimerSetting{.left = number(), .interval = number()});
      case Call::kPulseParameters:
        return pulse_parameters();
      case Call::kBind:
      case Call::kConnect:
      case Call::kJoin:
        return raw(address());
      case Call::kFilterArrivals:
        return filter();
      case Call::kSend:
        return raw(shim::Departure{.to = address(), .source = address()}) +
               std::string(below(one_in(5) ? shim::kMostData : 100), 'x');
      default:
        return one_in(10) ? std::string(below(200), 'x') : "";
    }
  }
  Packet request() {
    // Those without threads and processes. Notes end the program, so there are few.
    constexpr auto kFirst = static_cast<std::size_t>(Call::kTakeExpirations) + 2;
    constexpr auto kDevices = static_cast<std::size_t>(Call::kOpenDevice);
    constexpr auto kEnd = static_cast<std::size_t>(Call::kLookAtFile) + 2;  // and one that is none
    Call call{};
    do {
      const std::size_t number = below(kFirst + kEnd - kDevices);
      call = static_cast<Call>(number < kFirst ? number : kDevices + number - kFirst);
    } while (call == Call::kNote && !one_in(20));
    const bool is_known = !one_in(30);
    const bool is_timer = call >= Call::kOpenTimer && call <= Call::kQueryTimer;
    const bool is_signal = call >= Call::kSetSignalTimer && call <= Call::kDropSignalTimer;
    const bool is_card = call >= Call::kPin && call <= Call::kTakeStamps;
    const bool is_line = call == Call::kPulseParameters || call == Call::kFetchPulse;
    const std::int32_t own = is_signal ? -1 : is_timer ? 4 : is_card ? 5 : is_line ? 6 : 3;
    const Request head{.call = call,
                       .fd = is_known ? own : small<std::int32_t>(),
                       .a = one_in(2) ? static_cast<std::int64_t>(below(4)) : number(),
                       .b = number()};
    return packet(head, data_of(call));
  }
  Packet damaged(Packet bytes) {
    if (!one_in(20)) return bytes;
    if (one_in(2)) bytes.resize(below(bytes.size() + 1));
    for (std::size_t i = below(4); i > 0 && !bytes.empty(); --i) {
      bytes[below(bytes.size())] = static_cast<char>(random_());
    }
    return bytes;
  }

  std::mt19937_64 random_;
};

TEST_F(ProcessTest, HostileRequestsAreAnsweredOrEndTheProgram) {
  constexpr std::uint64_t kPrograms = 300;
  constexpr std::size_t kRequests = 60;
  std::size_t answered = 0;
  std::size_t ended = 0;
  for (std::uint64_t seed = 1; seed <= kPrograms; ++seed) {
    const Heard heard = hear(Hostile(seed).packets(kRequests));
    EXPECT_TRUE(heard.is_sane) << "seed " << seed;
    EXPECT_LT(heard.note.size(), 2000U) << "seed " << seed;
    answered += heard.replies.size();
    ended += heard.note.empty() ? 0 : 1;
  }
  EXPECT_GT(answered, 5 * kPrograms) << "most of them are understood";
  EXPECT_GT(ended, kPrograms / 4);
}

}  // namespace
}  // namespace simbench::sim
