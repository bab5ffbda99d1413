#include "sim/programs/packet_filter.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>

namespace simbench::sim {
namespace {

using Memory = std::array<std::uint32_t, BPF_MEMWORDS>;

constexpr auto kExtensions = static_cast<std::uint32_t>(SKF_AD_OFF);

bool is_known_extension(std::uint32_t place) {
  switch (place - kExtensions) {
    case SKF_AD_PROTOCOL:
    case SKF_AD_PKTTYPE:
    case SKF_AD_IFINDEX:
    case SKF_AD_MARK:
    case SKF_AD_QUEUE:
    case SKF_AD_HATYPE:
    case SKF_AD_RXHASH:
    case SKF_AD_CPU:
    case SKF_AD_ALU_XOR_X:
    case SKF_AD_VLAN_TAG:
    case SKF_AD_VLAN_TAG_PRESENT:
    case SKF_AD_VLAN_TPID:
      return true;
    default:
      return false;
  }
}

bool is_load(int code) {
  const bool has_size = BPF_SIZE(code) != (BPF_H | BPF_B);
  switch (BPF_MODE(code)) {
    case BPF_ABS:
    case BPF_IND:
      return has_size;
    case BPF_IMM:
    case BPF_MEM:
    case BPF_LEN:
      return BPF_SIZE(code) == BPF_W;
    default:
      return false;
  }
}

bool is_load_of_index(int code) {
  const int mode = BPF_MODE(code);
  if (mode == BPF_MSH) return BPF_SIZE(code) == BPF_B;
  return BPF_SIZE(code) == BPF_W && (mode == BPF_IMM || mode == BPF_MEM || mode == BPF_LEN);
}

bool is_computation(const sock_filter& each) {
  const int operation = BPF_OP(each.code);
  if (operation == BPF_NEG) return each.code == (BPF_ALU | BPF_NEG);
  if (operation > BPF_XOR) return false;
  if (BPF_SRC(each.code) == BPF_X) return true;
  const bool divides = operation == BPF_DIV || operation == BPF_MOD;
  const bool shifts = operation == BPF_LSH || operation == BPF_RSH;
  return !(divides && each.k == 0) && !(shifts && each.k >= 32);
}

bool is_jump(const sock_filter& each, std::size_t left) {
  switch (BPF_OP(each.code)) {
    case BPF_JA:
      return each.code == (BPF_JMP | BPF_JA) && each.k < left;
    case BPF_JEQ:
    case BPF_JGT:
    case BPF_JGE:
    case BPF_JSET:
      return each.jt < left && each.jf < left;
    default:
      return false;
  }
}

// `left`: how many instructions follow.
bool is_instruction(const sock_filter& each, std::size_t left) {
  if (each.code > 0xFF) return false;
  switch (BPF_CLASS(each.code)) {
    case BPF_LD:
      if (!is_load(each.code)) return false;
      if (BPF_MODE(each.code) == BPF_MEM) return each.k < BPF_MEMWORDS;
      return BPF_MODE(each.code) != BPF_ABS || each.k < kExtensions || is_known_extension(each.k);
    case BPF_LDX:
      return is_load_of_index(each.code) &&
             (BPF_MODE(each.code) != BPF_MEM || each.k < BPF_MEMWORDS);
    case BPF_ST:
      return each.code == BPF_ST && each.k < BPF_MEMWORDS;
    case BPF_STX:
      return each.code == BPF_STX && each.k < BPF_MEMWORDS;
    case BPF_ALU:
      return is_computation(each);
    case BPF_JMP:
      return is_jump(each, left);
    case BPF_RET:
      return each.code == (BPF_RET | BPF_K) || each.code == (BPF_RET | BPF_A);
    default:
      return each.code == (BPF_MISC | BPF_TAX) || each.code == (BPF_MISC | BPF_TXA);
  }
}

// Whether no instruction reads memory that no way to it has written (check_load_and_stores()).
bool writes_before_it_reads(std::span<const sock_filter> code) {
  constexpr unsigned kAll = 0xFFFF;
  std::vector<unsigned> may_have(code.size(), kAll);
  unsigned written = 0;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const sock_filter& each = code[i];
    written &= may_have[i];
    switch (each.code) {
      case BPF_ST:
      case BPF_STX:
        written |= 1U << each.k;
        break;
      case BPF_LD | BPF_MEM:
      case BPF_LDX | BPF_W | BPF_MEM:
        if ((written & (1U << each.k)) == 0) return false;
        break;
      default:
        if (BPF_CLASS(each.code) != BPF_JMP) break;
        if (BPF_OP(each.code) == BPF_JA) {
          may_have[i + 1 + each.k] &= written;
        } else {
          may_have[i + 1 + each.jt] &= written;
          may_have[i + 1 + each.jf] &= written;
        }
        written = kAll;
        break;
    }
  }
  return true;
}

// Big-endian.
std::optional<std::uint32_t> number_at(const SeenPacket& packet, std::size_t from,
                                       std::uint32_t offset, std::size_t size) {
  const std::size_t begin = from + offset;
  if (begin + size > packet.bytes.size()) return std::nullopt;
  std::uint32_t number = 0;
  for (const std::byte byte : packet.bytes.subspan(begin, size)) {
    number = number << 8 | std::to_integer<std::uint32_t>(byte);
  }
  return number;
}

std::size_t size_of(int code) {
  return BPF_SIZE(code) == BPF_W ? 4 : BPF_SIZE(code) == BPF_H ? 2 : 1;
}

std::optional<std::uint32_t> loaded(const SeenPacket& packet, std::uint32_t place,
                                    std::size_t size) {
  constexpr auto kNetwork = static_cast<std::uint32_t>(SKF_NET_OFF);
  constexpr auto kLink = static_cast<std::uint32_t>(SKF_LL_OFF);
  if (place >= kNetwork) return number_at(packet, packet.network_head, place - kNetwork, size);
  if (place >= kLink) return number_at(packet, packet.link_head, place - kLink, size);
  if (place > INT32_MAX) return std::nullopt;
  return number_at(packet, packet.begin, place, size);
}

std::uint32_t extension(const SeenPacket& packet, std::uint32_t place, std::uint32_t a,
                        std::uint32_t x) {
  switch (place - kExtensions) {
    case SKF_AD_PROTOCOL:
      return packet.protocol;
    case SKF_AD_PKTTYPE:
      return packet.kind;
    case SKF_AD_IFINDEX:
      return packet.interface;
    case SKF_AD_HATYPE:
      return packet.hardware;
    case SKF_AD_ALU_XOR_X:
      return a ^ x;
    default:
      return 0;  // no marks, queues, processors or virtual networks
  }
}

std::optional<std::uint32_t> computed(int operation, std::uint32_t a, std::uint32_t b) {
  switch (operation) {
    case BPF_ADD:
      return a + b;
    case BPF_SUB:
      return a - b;
    case BPF_MUL:
      return a * b;
    case BPF_DIV:
      return b == 0 ? std::nullopt : std::optional(a / b);
    case BPF_MOD:
      return b == 0 ? std::nullopt : std::optional(a % b);
    case BPF_OR:
      return a | b;
    case BPF_AND:
      return a & b;
    case BPF_XOR:
      return a ^ b;
    case BPF_LSH:
      return a << (b & 31U);
    case BPF_RSH:
      return a >> (b & 31U);
    default:
      return 0U - a;  // BPF_NEG
  }
}

bool holds(int operation, std::uint32_t a, std::uint32_t b) {
  switch (operation) {
    case BPF_JEQ:
      return a == b;
    case BPF_JGT:
      return a > b;
    case BPF_JGE:
      return a >= b;
    default:
      return (a & b) != 0;  // BPF_JSET
  }
}

// What an instruction that loads puts into its register; nothing where the packet has it not.
std::optional<std::uint32_t> load_of(const sock_filter& each, const SeenPacket& packet,
                                     const Memory& memory, std::uint32_t a, std::uint32_t x) {
  switch (BPF_MODE(each.code)) {
    case BPF_ABS:
      return each.k >= kExtensions ? extension(packet, each.k, a, x)
                                   : loaded(packet, each.k, size_of(each.code));
    case BPF_IND:
      return loaded(packet, x + each.k, size_of(each.code));
    case BPF_LEN:
      return static_cast<std::uint32_t>(packet.bytes.size() - packet.begin);
    case BPF_MEM:
      return memory[each.k];
    case BPF_MSH: {
      const std::optional<std::uint32_t> byte = loaded(packet, each.k, 1);
      return byte ? std::optional((*byte & 0xFU) * 4) : std::nullopt;
    }
    default:
      return each.k;  // BPF_IMM
  }
}

}  // namespace

int PacketFilter::check(std::span<const sock_filter> code) {
  if (code.empty() || code.size() > BPF_MAXINSNS) return EINVAL;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (!is_instruction(code[i], code.size() - i - 1)) return EINVAL;
  }
  if (BPF_CLASS(code.back().code) != BPF_RET) return EINVAL;
  return writes_before_it_reads(code) ? 0 : EINVAL;
}

std::size_t PacketFilter::passed(const SeenPacket& packet) const {
  const std::size_t size = packet.bytes.size() - packet.begin;
  if (code_.empty()) return size;
  std::uint32_t a = 0;
  std::uint32_t x = 0;
  Memory memory{};
  for (std::size_t at = 0; at < code_.size(); ++at) {
    const sock_filter& each = code_[at];
    const std::uint32_t operand = BPF_SRC(each.code) == BPF_X ? x : each.k;
    std::optional<std::uint32_t> result = 0;
    switch (BPF_CLASS(each.code)) {
      case BPF_LD:
        result = load_of(each, packet, memory, a, x);
        a = result.value_or(0);
        break;
      case BPF_LDX:
        result = load_of(each, packet, memory, a, x);
        x = result.value_or(0);
        break;
      case BPF_ST:
        memory[each.k] = a;
        break;
      case BPF_STX:
        memory[each.k] = x;
        break;
      case BPF_ALU:
        result = computed(BPF_OP(each.code), a, operand);
        a = result.value_or(0);
        break;
      case BPF_JMP:
        if (BPF_OP(each.code) == BPF_JA) {
          at += each.k;
        } else {
          at += holds(BPF_OP(each.code), a, operand) ? each.jt : each.jf;
        }
        break;
      case BPF_RET:
        return std::min<std::size_t>(BPF_RVAL(each.code) == BPF_A ? a : each.k, size);
      default:
        (BPF_MISCOP(each.code) == BPF_TAX ? x : a) = BPF_MISCOP(each.code) == BPF_TAX ? a : x;
        break;
    }
    if (!result) return 0;
  }
  return 0;
}

}  // namespace simbench::sim
