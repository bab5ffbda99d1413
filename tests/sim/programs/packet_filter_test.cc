// Classic BPF beside the kernel's: the same filters on the same packets.
#include "sim/programs/packet_filter.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace simbench::sim {
namespace {

using Code = std::vector<sock_filter>;

sock_filter statement(int code, std::uint32_t k) {
  return {.code = static_cast<std::uint16_t>(code), .jt = 0, .jf = 0, .k = k};
}
sock_filter jump(int code, std::uint32_t k, std::uint8_t jt, std::uint8_t jf) {
  return {.code = static_cast<std::uint16_t>(code), .jt = jt, .jf = jf, .k = k};
}

std::size_t passed(const Code& code, const std::string& bytes) {
  return PacketFilter(code).passed({.bytes = std::as_bytes(std::span(bytes))});
}

// A pair of local datagram sockets, one of which has the filter in the kernel.
class Kernel {
 public:
  Kernel() {
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends_.data()), 0);
  }
  ~Kernel() {
    for (const int end : ends_) close(end);
  }
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  // 0, or an errno.
  int attach(Code code) {
    const sock_fprog program{.len = static_cast<unsigned short>(code.size()),
                             .filter = code.data()};
    const int result = setsockopt(ends_[1], SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program);
    return result == 0 ? 0 : errno;
  }
  std::size_t passed(const std::string& bytes) {
    send(ends_[0], bytes.data(), bytes.size(), 0);
    std::array<char, 4096> room{};
    const ssize_t size = recv(ends_[1], room.data(), room.size(), 0);
    return size < 0 ? 0 : static_cast<std::size_t>(size);
  }

 private:
  std::array<int, 2> ends_{};
};

TEST(PacketFilter, LetsThroughWhatItsProgramSays) {
  const Code ptp = {statement(BPF_LD | BPF_H | BPF_ABS, 12),
                    jump(BPF_JMP | BPF_JEQ | BPF_K, 0x88F7, 0, 1), statement(BPF_RET | BPF_K, 20),
                    statement(BPF_RET | BPF_K, 0)};
  ASSERT_EQ(PacketFilter::check(ptp), 0);
  EXPECT_EQ(passed(ptp, std::string(12, 'x') + "\x88\xF7payload"), 20U) << "as much as it says";
  EXPECT_EQ(passed(ptp, std::string(12, 'x') + "\x88\xF7"), 14U) << "or there is";
  EXPECT_EQ(passed(ptp, std::string(12, 'x') + "\x88\xF6payload"), 0U);
  EXPECT_EQ(passed(ptp, "short"), 0U) << "a load beyond the packet drops it";
  EXPECT_EQ(passed({}, "anything"), 8U) << "without a filter all passes";
}

TEST(PacketFilter, KnowsTheHeadsBeforeItsBeginningAndThePacketsKind) {
  const std::string frame = std::string(14, 'e') + "network";
  const SeenPacket seen{.bytes = std::as_bytes(std::span(frame)),
                        .begin = 14,
                        .network_head = 14,
                        .protocol = 0x88F7,
                        .kind = 4,
                        .interface = 2};
  const auto loads = [&](int place, std::uint32_t expected) {
    const Code code = {statement(BPF_LD | BPF_B | BPF_ABS, static_cast<std::uint32_t>(place)),
                       jump(BPF_JMP | BPF_JEQ | BPF_K, expected, 0, 1),
                       statement(BPF_RET | BPF_K, 99), statement(BPF_RET | BPF_K, 0)};
    EXPECT_EQ(PacketFilter::check(code), 0) << place;
    return PacketFilter(code).passed(seen) == 7;
  };
  EXPECT_TRUE(loads(0, 'n'));
  EXPECT_TRUE(loads(SKF_NET_OFF + 1, 'e'));
  EXPECT_TRUE(loads(SKF_LL_OFF, 'e'));
  EXPECT_TRUE(loads(SKF_AD_OFF + SKF_AD_PROTOCOL, 0x88F7));
  EXPECT_TRUE(loads(SKF_AD_OFF + SKF_AD_PKTTYPE, 4));
  EXPECT_TRUE(loads(SKF_AD_OFF + SKF_AD_IFINDEX, 2));
  EXPECT_FALSE(loads(SKF_LL_OFF + 21, 0)) << "beyond its end";
}

// Programs of random instructions, most of which are right.
class RandomFilters {
 public:
  explicit RandomFilters(std::uint64_t seed) : random_(seed) {}

  Code code() {
    Code code;
    const std::size_t size = 2 + below(14);
    while (code.size() + 1 < size) code.push_back(instruction(size - code.size() - 1));
    code.push_back(statement(BPF_RET | (one_in(2) ? BPF_A : BPF_K), small()));
    if (one_in(20)) code[below(code.size())].code = static_cast<std::uint16_t>(below(0x120));
    return code;
  }
  std::string packet() {
    std::string bytes(1 + below(40), '\0');
    for (char& byte : bytes) byte = static_cast<char>(one_in(2) ? below(8) : random_());
    return bytes;
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }
  std::uint32_t small() {
    return one_in(8) ? static_cast<std::uint32_t>(random_())
                     : static_cast<std::uint32_t>(below(48));
  }
  sock_filter instruction(std::size_t left) {
    constexpr int kLoads[] = {BPF_LD | BPF_W | BPF_ABS,
                              BPF_LD | BPF_H | BPF_ABS,
                              BPF_LD | BPF_B | BPF_ABS,
                              BPF_LD | BPF_B | BPF_IND,
                              BPF_LD | BPF_H | BPF_IND,
                              BPF_LD | BPF_W | BPF_LEN,
                              BPF_LD | BPF_IMM,
                              BPF_LD | BPF_MEM,
                              BPF_LDX | BPF_W | BPF_IMM,
                              BPF_LDX | BPF_W | BPF_LEN,
                              BPF_LDX | BPF_W | BPF_MEM,
                              BPF_LDX | BPF_B | BPF_MSH,
                              BPF_ST,
                              BPF_STX,
                              BPF_MISC | BPF_TAX,
                              BPF_MISC | BPF_TXA};
    constexpr int kOperations[] = {BPF_ADD, BPF_SUB, BPF_MUL, BPF_DIV, BPF_OR, BPF_AND,
                                   BPF_LSH, BPF_RSH, BPF_NEG, BPF_MOD, BPF_XOR};
    constexpr int kTests[] = {BPF_JEQ, BPF_JGT, BPF_JGE, BPF_JSET};
    const int source = one_in(2) ? BPF_X : BPF_K;
    switch (below(4)) {
      case 0: {
        const int operation = kOperations[below(std::size(kOperations))];
        return statement(BPF_ALU | operation | (operation == BPF_NEG ? 0 : source), small());
      }
      case 1:
        if (one_in(6)) return statement(BPF_JMP | BPF_JA, static_cast<std::uint32_t>(below(left)));
        return jump(BPF_JMP | kTests[below(4)] | source, small(),
                    static_cast<std::uint8_t>(below(left)), static_cast<std::uint8_t>(below(left)));
      default: {
        const int load = kLoads[below(std::size(kLoads))];
        const bool is_memory = load == BPF_ST || load == BPF_STX || BPF_MODE(load) == BPF_MEM;
        return statement(load, is_memory ? static_cast<std::uint32_t>(below(17)) : small());
      }
    }
  }

  std::mt19937_64 random_;
};

TEST(PacketFilter, DoesWhatTheKernelDoes) {
  constexpr std::uint64_t kFilters = 2000;
  std::size_t accepted = 0;
  std::size_t let_through = 0;
  for (std::uint64_t seed = 1; seed <= kFilters; ++seed) {
    RandomFilters random(seed);
    const Code code = random.code();
    Kernel kernel;
    const int expected = kernel.attach(code);
    ASSERT_EQ(PacketFilter::check(code), expected) << "seed " << seed;
    if (expected != 0) continue;
    ++accepted;
    for (int i = 0; i < 8; ++i) {
      const std::string packet = random.packet();
      const std::size_t passes = kernel.passed(packet);
      ASSERT_EQ(passed(code, packet), passes) << "seed " << seed << ", packet " << i;
      let_through += passes > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(accepted, kFilters / 4);
  EXPECT_LT(accepted, kFilters);
  EXPECT_GT(let_through, accepted);
}

TEST(PacketFilter, EveryInstructionIsAcceptedAsTheKernelDoes) {
  for (std::uint32_t code = 0; code < 0x200; ++code) {
    for (const std::uint32_t k : {0U, 1U, 15U, 16U, 31U, 32U, 0xFFFFF000U, 0xFFFFF004U}) {
      const Code all = {statement(BPF_ST, 0),          statement(BPF_ST, 1),
                        statement(BPF_ST, 15),         statement(static_cast<int>(code), k),
                        statement(BPF_RET | BPF_K, 1), statement(BPF_RET | BPF_K, 2)};
      Kernel kernel;
      EXPECT_EQ(PacketFilter::check(all), kernel.attach(all)) << code << " " << k;
    }
  }
  EXPECT_EQ(PacketFilter::check({}), EINVAL);
  EXPECT_EQ(PacketFilter::check(Code(BPF_MAXINSNS + 1, statement(BPF_RET | BPF_K, 1))), EINVAL);
  EXPECT_EQ(PacketFilter::check(Code(BPF_MAXINSNS, statement(BPF_RET | BPF_K, 1))), 0);
}

}  // namespace
}  // namespace simbench::sim
