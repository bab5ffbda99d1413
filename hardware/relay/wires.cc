#include "hardware/relay/wires.h"

#include <fmt/format.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <cstring>

#include "hardware/descriptor.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/token_bucket.h"
#include "hardware/relay/relayed_stream.h"
#include "processes/placeholders.h"

namespace simbench::hardware {
namespace {

constexpr std::size_t kLargestFrame = 65536;
constexpr double kMaxFramesPerSecond = 20'000;

// Ethernet, then IPv4 or ARP.
constexpr std::size_t kEthernet = 14;
constexpr std::size_t kIpv4 = 20;
constexpr std::size_t kArp = 28;
constexpr std::size_t kUdp = 8;

unsigned byte_at(std::span<const std::byte> frame, std::size_t at) {
  return std::to_integer<unsigned>(frame[at]);
}

unsigned word_at(std::span<const std::byte> frame, std::size_t at) {
  return byte_at(frame, at) << 8U | byte_at(frame, at + 1);
}

std::uint32_t address_at(std::span<const std::byte> frame, std::size_t at) {
  return word_at(frame, at) << 16U | word_at(frame, at + 2);
}

bool is_for_several(std::uint32_t address) {
  return address >> 28U == 0xE || address == INADDR_BROADCAST ||
         address == (processes::kFirstAddress | ~processes::kNetmask);
}

// Nothing for what is no member's address.
std::optional<PeerId> member_of(std::uint32_t address, std::size_t members) {
  const std::uint32_t member = address - processes::kFirstAddress;
  if (member >= members) return std::nullopt;
  return member;
}

std::optional<CarriedFrame> look_at_arp(std::span<const std::byte> frame, std::size_t members) {
  constexpr std::size_t kTarget = kEthernet + 24;
  if (frame.size() < kEthernet + kArp) return std::nullopt;
  const std::optional<PeerId> to = member_of(address_at(frame, kTarget), members);
  if (!to) return std::nullopt;
  return CarriedFrame{.kind = CarriedFrame::Kind::kArp, .to = to};
}

std::optional<CarriedFrame> look_at_datagram(std::span<std::byte> frame, std::size_t members) {
  if (frame.size() < kEthernet + kIpv4 + kUdp) return std::nullopt;
  const std::size_t header = (byte_at(frame, kEthernet) & 15U) * 4;
  const std::size_t udp = kEthernet + header;
  const bool is_ipv4 = byte_at(frame, kEthernet) >> 4U == 4 && header >= kIpv4;
  const bool is_fragment = (word_at(frame, kEthernet + 6) & 0x3FFFU) != 0;
  const bool is_udp = byte_at(frame, kEthernet + 9) == IPPROTO_UDP;
  if (!is_ipv4 || is_fragment || !is_udp || frame.size() < udp + kUdp) return std::nullopt;
  frame[udp + 6] = frame[udp + 7] = std::byte{0};
  const std::uint32_t address = address_at(frame, kEthernet + 16);
  if (is_for_several(address)) return CarriedFrame{};
  const std::optional<PeerId> to = member_of(address, members);
  if (!to) return std::nullopt;
  return CarriedFrame{.to = to};
}

// A socket, the caller's to close, for all frames that come in over an interface.
int open_wire(const std::string& name) {
  const auto fail = [&name] {
    throw RelayError(fmt::format("wire '{}': {}", name, std::strerror(errno)));
  };
  Descriptor wire(::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!wire.good()) fail();
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  if (address.sll_ifindex == 0) fail();
  const int on = 1;
  if (setsockopt(wire.number(), SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) != 0) fail();
  request_receive_stamps(wire.number());
  if (bind(wire.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail();
  return wire.release();
}

}  // namespace

std::optional<CarriedFrame> look_at_frame(std::span<std::byte> frame, std::size_t members) {
  if (frame.size() < kEthernet) return std::nullopt;
  const unsigned type = word_at(frame, kEthernet - 2);
  if (type == ETH_P_ARP) return look_at_arp(frame, members);
  if (type == ETH_P_IP) return look_at_datagram(frame, members);
  return std::nullopt;
}

class Wires::State : public std::enable_shared_from_this<Wires::State> {
 public:
  State(boost::asio::io_context& context, DelayQueue& queue, const Settings& settings)
      : context_(context), queue_(queue) {
    for (const std::string& name : settings.wires) {
      wires_.emplace_back(context, open_wire(name));
    }
    buckets_.resize(wires_.size());
    for (PeerId from = 0; from < wires_.size(); ++from) {
      for (PeerId to = 0; to < wires_.size(); ++to) {
        laws_.emplace_back(settings.scenario->network, settings.seed, from, to);
      }
    }
  }

  void start() {
    for (PeerId from = 0; from < wires_.size(); ++from) {
      boost::asio::co_spawn(context_, receive(shared_from_this(), from), boost::asio::detached);
    }
  }

  void stop() {
    boost::system::error_code ignored;
    for (auto& wire : wires_) wire.close(ignored);
  }

  LawCounts counts() const {
    LawCounts all;
    for (const NetworkLaw& law : laws_) all += law.counts();
    return all;
  }
  std::uint64_t dropped() const { return dropped_; }

 private:
  static Task<void> receive(std::shared_ptr<State> self, PeerId from) {
    Bytes buffer(kLargestFrame);
    auto& wire = self->wires_[from];
    while (wire.is_open()) {
      const ReceivedPiece piece = receive_stamped(wire.native_handle(), buffer, nullptr);
      if (piece.error == 0) {
        if (!piece.truncated)
          self->carry(from, std::span(buffer).first(piece.bytes), piece.received);
        continue;
      }
      boost::system::error_code error;
      co_await wire.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                               boost::asio::redirect_error(boost::asio::use_awaitable, error));
    }
  }

  void carry(PeerId from, std::span<std::byte> frame, MonotonicTime received) {
    const std::optional<CarriedFrame> carried = look_at_frame(frame, wires_.size());
    if (!carried) return;
    if (!buckets_[from].take(monotonic_now(), kMaxFramesPerSecond, kMaxFramesPerSecond)) {
      ++dropped_;
      return;
    }
    for (PeerId to = 0; to < wires_.size(); ++to) {
      if (to == from || carried->to.value_or(to) != to) continue;
      if (carried->kind == CarriedFrame::Kind::kArp) {
        send(to, Bytes(frame.begin(), frame.end()));
        continue;
      }
      for (const MonotonicTime at : laws_[from * wires_.size() + to].datagram(received)) {
        Bytes copy(frame.begin(), frame.end());
        const bool taken = queue_.add(
            at, copy, [self = shared_from_this(), to](const Bytes& due) { self->send(to, due); });
        if (!taken) ++dropped_;
      }
    }
  }

  void send(PeerId to, const Bytes& frame) {
    // One that has no room is lost, as on any wire.
    if (wires_[to].is_open()) ::send(wires_[to].native_handle(), frame.data(), frame.size(), 0);
  }

  boost::asio::io_context& context_;
  DelayQueue& queue_;
  std::vector<boost::asio::posix::stream_descriptor> wires_;
  std::vector<TokenBucket> buckets_;
  std::vector<NetworkLaw> laws_;  // [from * wires + to]
  std::uint64_t dropped_ = 0;
};

Wires::Wires(boost::asio::io_context& context, DelayQueue& queue, const Settings& settings)
    : state_(std::make_shared<State>(context, queue, settings)) {
  state_->start();
}

Wires::~Wires() { stop(); }

void Wires::stop() { state_->stop(); }

LawCounts Wires::counts() const { return state_->counts(); }

std::uint64_t Wires::dropped() const { return state_->dropped(); }

}  // namespace simbench::hardware
