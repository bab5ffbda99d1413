// A TCP link to a local port that a test can cut: every connection through it breaks, and new ones
// are refused until it is mended.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

// At -O1 g++ 12 puts one half of the pair that Asio allocates coroutines with in place, and then
// sees a mismatch with the other.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

namespace simbench::hardware {

class CuttableLink {
 public:
  explicit CuttableLink(std::uint16_t to_port);
  ~CuttableLink();
  CuttableLink(const CuttableLink&) = delete;
  CuttableLink& operator=(const CuttableLink&) = delete;

  std::uint16_t port() const { return port_; }
  // From any thread.
  void cut();
  void mend();

 private:
  using Socket = boost::asio::ip::tcp::socket;

  void listen();
  boost::asio::awaitable<void> accept();
  boost::asio::awaitable<void> connect(std::shared_ptr<Socket> from);
  static boost::asio::awaitable<void> forward(std::shared_ptr<Socket> from,
                                              std::shared_ptr<Socket> to);

  boost::asio::io_context context_;
  // While it is cut there is no other work.
  std::optional<boost::asio::executor_work_guard<boost::asio::io_context::executor_type>> alive_{
      boost::asio::make_work_guard(context_)};
  std::uint16_t to_port_;
  std::uint16_t port_ = 0;
  std::optional<boost::asio::ip::tcp::acceptor> acceptor_;
  std::vector<std::weak_ptr<Socket>> sockets_;
  std::thread thread_;
};

}  // namespace simbench::hardware
