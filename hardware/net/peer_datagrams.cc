// The datagrams of a PeerNetwork.
#include <netinet/in.h>
#include <sys/socket.h>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <cstring>

#include "hardware/net/peer_network_state.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::udp;
using boost::system::error_code;

// What is read before others get their turn.
constexpr int kDatagramsAtOnce = 64;

udp::endpoint endpoint_of(const sockaddr_storage& from) {
  udp::endpoint endpoint;
  const std::size_t size = from.ss_family == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
  endpoint.resize(size);
  std::memcpy(endpoint.data(), &from, size);
  return endpoint;
}

// "10.0.0.3" of "10.0.0.3:47110", "::1" of "[::1]:47110".
std::string without_port(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (!text.starts_with('[')) return text.substr(0, colon);
  return text.substr(1, colon - 2);
}

}  // namespace

// The address of the rig file where it is a number, else where the stream comes from; the port of
// the rig file, or the one that the host itself tells.
udp::endpoint PeerNetwork::State::destination(const Link& link, const SecureStream& stream) const {
  const PeerAddress& configured = settings_.peers[link.peer];
  error_code no_number;
  auto address = boost::asio::ip::make_address(configured.address, no_number);
  if (no_number) {
    address = boost::asio::ip::make_address(without_port(stream.peer_address()), no_number);
  }
  error_code ignored;
  if (address.is_v4() && datagrams_.local_endpoint(ignored).address().is_v6()) {
    address = boost::asio::ip::make_address_v6(boost::asio::ip::v4_mapped, address.to_v4());
  }
  return {address, configured.port};
}

Task<void> PeerNetwork::State::receive_datagrams(Self self) {
  while (!self->stopped_) {
    error_code error;
    co_await self->datagrams_.async_wait(
        udp::socket::wait_read, boost::asio::redirect_error(boost::asio::use_awaitable, error));
    if (error || self->stopped_) co_return;
    // The wait ends for transmit stamps as well, and would at once if they stayed.
    self->take_datagram_stamps();
    for (int i = 0; i < kDatagramsAtOnce && self->receive_datagram(); ++i) {
    }
  }
}

// False if there is none.
bool PeerNetwork::State::receive_datagram() {
  if (stopped_) return false;
  sockaddr_storage from{};
  const ReceivedPiece piece = receive_stamped(datagrams_.native_handle(), datagram_, &from);
  if (piece.error != 0) return false;
  ++statistics_.datagrams_received;
  if (piece.truncated) {
    ++statistics_.refused_malformed;
    return true;
  }
  judge_datagram(std::span<const std::byte>(datagram_).first(piece.bytes), endpoint_of(from),
                 piece.received);
  return true;
}

void PeerNetwork::State::judge_datagram(std::span<const std::byte> datagram,
                                        const udp::endpoint& from, MonotonicTime received) {
  const auto header = parse_datagram(datagram);
  if (!header || header->from >= links_.size() || !links_[header->from]) {
    ++statistics_.refused_malformed;
    return;
  }
  Link& link = *links_[header->from];
  if (!link.session) {
    ++statistics_.refused_forged;
    return;
  }
  if (link.proven_source != from && from != link.datagrams_to &&
      !strangers_allowed_.take(from.address(), from.port(), monotonic_now())) {
    ++statistics_.refused_rate;
    return;
  }
  Bytes message;
  switch (link.session->open(*header, datagram, message)) {
    case DatagramVerdict::kForged:
      ++statistics_.refused_forged;
      return;
    case DatagramVerdict::kReplayed:
      ++statistics_.refused_replayed;
      return;
    case DatagramVerdict::kAccepted:
      break;
  }
  link.proven_source = from;
  deliver(link, Transport::kDatagram, std::move(message), received);
}

MessageId PeerNetwork::State::send_datagram(PeerId peer, const Bytes& message) {
  if (message.size() > kMaxDatagramMessage) {
    throw StreamError(StreamError::Kind::kNotUnderstood,
                      "found a datagram to a host that is too long, allowed: 65479 bytes");
  }
  const MessageId id = next_datagram_++;
  Link& to = link(peer);
  if (stopped_ || !to.session || to.datagrams_to.port() == 0) return id;
  const Bytes datagram = to.session->seal_next(message);
  const MonotonicTime called = monotonic_now();
  const ssize_t sent = sendto(datagrams_.native_handle(), datagram.data(), datagram.size(),
                              MSG_DONTWAIT | MSG_NOSIGNAL, to.datagrams_to.data(),
                              static_cast<socklen_t>(to.datagrams_to.size()));
  if (sent < 0) {
    restart_datagram_numbers();
  } else {
    transmitted_.sent(id, next_number_++, called);
  }
  return id;
}

void PeerNetwork::State::restart_datagram_numbers() {
  take_datagram_stamps();
  restart_stamp_numbers(datagrams_.native_handle());
  transmitted_.forget_numbers();
  next_number_ = 0;
}

bool PeerNetwork::State::take_datagram_stamps() {
  bool some = false;
  while (const auto stamp = next_transmit_stamp(datagrams_.native_handle())) {
    transmitted_.stamped(stamp->number, stamp->at);
    some = true;
  }
  if (some) stamped_.notify();
  return some;
}

Task<std::optional<HostTime>> PeerNetwork::State::datagram_stamp(Self self, MessageId id,
                                                                 SteadyTime deadline) {
  while (!self->stopped_) {
    const TransmitLog::Entry* entry = self->transmitted_.find(id);
    if (entry == nullptr) co_return std::nullopt;
    if (entry->left) co_return self->clock_.system_at(*entry->left);
    // Without the kernel's stamp: not later than it left.
    if (!self->stamps_) co_return self->clock_.system_at(entry->called);
    if (self->take_datagram_stamps()) continue;
    const bool in_time = co_await self->stamped_.wait(self->deadline_of(deadline));
    if (!in_time) co_return std::nullopt;
  }
  co_return std::nullopt;
}

}  // namespace simbench::hardware
