#include "tests/hardware/conductor/cuttable_link.h"

#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
constexpr auto kNoThrow = asio::as_tuple(asio::use_awaitable);

}  // namespace

CuttableLink::CuttableLink(std::uint16_t to_port) : context_(1), to_port_(to_port) {
  listen();
  thread_ = std::thread([this] { context_.run(); });
}

CuttableLink::~CuttableLink() {
  cut();
  alive_.reset();
  thread_.join();
}

// On the same port again after a cut.
void CuttableLink::listen() {
  acceptor_.emplace(context_, asio::ip::tcp::endpoint(asio::ip::address_v4::loopback(), port_),
                    true);
  port_ = acceptor_->local_endpoint().port();
  asio::co_spawn(context_, accept(), asio::detached);
}

asio::awaitable<void> CuttableLink::accept() {
  for (;;) {
    auto [error, socket] = co_await acceptor_->async_accept(kNoThrow);
    if (error) co_return;
    auto from = std::make_shared<Socket>(std::move(socket));
    asio::co_spawn(context_, connect(from), asio::detached);
  }
}

asio::awaitable<void> CuttableLink::connect(std::shared_ptr<Socket> from) {
  auto to = std::make_shared<Socket>(context_);
  sockets_.push_back(from);
  sockets_.push_back(to);
  const asio::ip::tcp::endpoint end(asio::ip::address_v4::loopback(), to_port_);
  auto [error] = co_await to->async_connect(end, kNoThrow);
  if (error) co_return;
  asio::co_spawn(context_, forward(from, to), asio::detached);
  asio::co_spawn(context_, forward(to, from), asio::detached);
}

asio::awaitable<void> CuttableLink::forward(std::shared_ptr<Socket> from,
                                            std::shared_ptr<Socket> to) {
  std::array<char, 16384> block{};
  for (;;) {
    auto [error, size] = co_await from->async_read_some(asio::buffer(block), kNoThrow);
    if (error) break;
    auto [failed, written] = co_await asio::async_write(*to, asio::buffer(block, size), kNoThrow);
    if (failed) break;
  }
  boost::system::error_code ignored;
  from->close(ignored);
  to->close(ignored);
}

void CuttableLink::cut() {
  asio::post(context_, [this] {
    acceptor_.reset();
    for (const std::weak_ptr<Socket>& each : sockets_) {
      boost::system::error_code ignored;
      if (const auto socket = each.lock()) socket->close(ignored);
    }
    sockets_.clear();
  });
}

void CuttableLink::mend() {
  asio::post(context_, [this] { listen(); });
}

}  // namespace simbench::hardware
