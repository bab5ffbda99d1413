#include "hardware/net/datagram_socket.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstring>

namespace simbench::hardware {
namespace {

using boost::asio::ip::udp;
using boost::system::error_code;

// Large enough that a flood does not crowd out waiting datagrams.
constexpr int kBufferBytes = 1 << 20;

udp::endpoint endpoint_of(const sockaddr_storage& from) {
  udp::endpoint endpoint;
  const std::size_t size = from.ss_family == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
  endpoint.resize(size);
  std::memcpy(endpoint.data(), &from, size);
  return endpoint;
}

}  // namespace

DatagramSocket::DatagramSocket(boost::asio::io_context& context)
    : context_(context), socket_(context), stamped_(context.get_executor()) {}

void DatagramSocket::bind(const Endpoint& at, error_code& error) {
  socket_ = udp::socket(context_);
  socket_.open(at.protocol(), error);
  if (!error) socket_.bind(at, error);
  if (error) return;
  error_code ignored;
  socket_.native_non_blocking(true, ignored);
  socket_.set_option(boost::asio::socket_base::receive_buffer_size(kBufferBytes), ignored);
  stamps_ = request_kernel_stamps(socket_.native_handle());
}

void DatagramSocket::close() {
  closed_ = true;
  error_code ignored;
  socket_.close(ignored);
  stamped_.notify();
}

bool DatagramSocket::is_ip6() const {
  error_code ignored;
  return socket_.local_endpoint(ignored).address().is_v6();
}

Task<bool> DatagramSocket::readable() {
  error_code error;
  co_await socket_.async_wait(udp::socket::wait_read,
                              boost::asio::redirect_error(boost::asio::use_awaitable, error));
  if (error || closed_) co_return false;
  // Transmit stamps end the wait as well, and would end the next one at once.
  take_stamps();
  co_return true;
}

std::optional<DatagramSocket::Received> DatagramSocket::receive() {
  if (closed_) return std::nullopt;
  sockaddr_storage from{};
  const ReceivedPiece piece = receive_stamped(socket_.native_handle(), buffer_, &from);
  if (piece.error != 0) return std::nullopt;
  return Received{.bytes = std::span<const std::byte>(buffer_).first(piece.bytes),
                  .truncated = piece.truncated,
                  .from = endpoint_of(from),
                  .at = piece.received};
}

void DatagramSocket::send(MessageId id, const Bytes& datagram, const Endpoint& to) {
  const MonotonicTime called = monotonic_now();
  const ssize_t sent =
      sendto(socket_.native_handle(), datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
             to.data(), static_cast<socklen_t>(to.size()));
  if (sent < 0) {
    restart_numbers();
  } else {
    transmitted_.sent(id, next_number_++, called);
  }
}

void DatagramSocket::restart_numbers() {
  take_stamps();
  restart_stamp_numbers(socket_.native_handle());
  transmitted_.forget_numbers();
  next_number_ = 0;
}

bool DatagramSocket::take_stamps() {
  if (!take_transmit_stamps(socket_.native_handle(), transmitted_)) return false;
  stamped_.notify();
  return true;
}

Task<std::optional<MonotonicTime>> DatagramSocket::left(MessageId id, MonotonicTime deadline) {
  while (!closed_) {
    const TransmitLog::Entry* entry = transmitted_.find(id);
    if (entry == nullptr) co_return std::nullopt;
    if (entry->left) co_return *entry->left;
    // Without the kernel's stamp, the time of the call: not later than the message left.
    if (!stamps_) co_return entry->called;
    if (take_stamps()) continue;
    const bool in_time = co_await stamped_.wait(deadline);
    if (!in_time) co_return std::nullopt;
  }
  co_return std::nullopt;
}

}  // namespace simbench::hardware
