// Two ends of a connection over the loopback interface: SecureStreams, or one against plain bytes.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <memory>
#include <utility>

#include "hardware/net/secure_stream.h"
#include "tests/hardware/net/in_time.h"

namespace simbench::hardware {

// A key as a file has it.
SecretKey key_from_digit(char digit);

class Listener {
 public:
  explicit Listener(boost::asio::io_context& context)
      : context_(context), acceptor_(context, {boost::asio::ip::make_address("127.0.0.1"), 0}) {}

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  Task<std::unique_ptr<SecureStream>> accept(SecretKey key, PeerName me,
                                             MonotonicTime deadline = soon()) {
    auto socket = co_await acceptor_.async_accept(boost::asio::use_awaitable);
    co_return co_await SecureStream::accept(std::move(socket), key, me, deadline);
  }
  Task<std::unique_ptr<SecureStream>> connect(SecretKey key, PeerName me,
                                              MonotonicTime deadline = soon()) {
    return SecureStream::connect(context_, "127.0.0.1", port(), key, me, deadline);
  }
  // The other side as a plain socket.
  boost::asio::ip::tcp::socket plain_connect() {
    boost::asio::ip::tcp::socket socket(context_);
    socket.connect(acceptor_.local_endpoint());
    return socket;
  }
  boost::asio::ip::tcp::socket plain_accept() { return acceptor_.accept(); }

 private:
  boost::asio::io_context& context_;
  boost::asio::ip::tcp::acceptor acceptor_;
};

struct StreamPair {
  std::unique_ptr<SecureStream> connected;
  std::unique_ptr<SecureStream> accepted;
};

// Host 1 connected to host 0.
StreamPair stream_pair(boost::asio::io_context& context, SecretKey key = key_from_digit('7'));

}  // namespace simbench::hardware
