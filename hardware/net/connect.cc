#include "hardware/net/connect.h"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hardware/net/notice.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {
namespace {

using Kind = StreamError::Kind;
using boost::asio::ip::tcp;
using boost::system::error_code;

// The state of an attempt, shared with its handlers, which may outlive it.
struct Attempt {
  explicit Attempt(const boost::asio::any_io_executor& executor)
      : resolver(executor), socket(executor), done(executor) {}
  tcp::resolver resolver;
  std::vector<tcp::endpoint> endpoints;
  tcp::socket socket;
  std::optional<error_code> result;
  Notice done;

  void finish(const error_code& error) {
    result = error;
    done.notify();
  }
};

using Shared = std::shared_ptr<Attempt>;

// Ends the attempt, also when the waiting coroutine is cancelled.
struct Ending {
  Shared attempt;
  ~Ending() {
    if (attempt->result) return;
    error_code ignored;
    attempt->resolver.cancel();
    attempt->socket.close(ignored);
  }
};

Task<error_code> finished_attempt(Shared attempt, MonotonicTime deadline) {
  const Ending ending{attempt};
  while (!attempt->result) {
    const bool in_time = co_await attempt->done.wait(deadline);
    if (!in_time && !attempt->result) co_return error_code(boost::asio::error::timed_out);
  }
  co_return *attempt->result;
}

std::string error_text(const error_code& error) {
  return error == boost::asio::error::timed_out ? "found no answer in time" : error.message();
}

[[noreturn]] void unreachable(const std::string& address, std::uint16_t port,
                              const error_code& error) {
  throw StreamError(
      Kind::kUnreachable,
      fmt::format("{}: no connection: {}", address_text(address, port), error_text(error)));
}

Task<std::vector<tcp::endpoint>> resolve(Shared attempt, std::string address, std::uint16_t port,
                                         MonotonicTime deadline) {
  error_code no_number;
  const auto number = boost::asio::ip::make_address(address, no_number);
  if (!no_number) co_return std::vector{tcp::endpoint(number, port)};
  attempt->resolver.async_resolve(
      address, std::to_string(port),
      [attempt](const error_code& error, const tcp::resolver::results_type& results) {
        for (const auto& entry : results) attempt->endpoints.push_back(entry.endpoint());
        attempt->finish(error);
      });
  const error_code error = co_await finished_attempt(attempt, deadline);
  if (error) unreachable(address, port, error);
  co_return attempt->endpoints;
}

}  // namespace

std::string address_text(const std::string& address, std::uint16_t port) {
  const bool ip6 = address.find(':') != std::string::npos;
  return ip6 ? fmt::format("[{}]:{}", address, port) : fmt::format("{}:{}", address, port);
}

Task<tcp::socket> connect_socket(boost::asio::any_io_executor executor, std::string address,
                                 std::uint16_t port, MonotonicTime deadline) {
  const auto names = std::make_shared<Attempt>(executor);
  const std::vector<tcp::endpoint> endpoints = co_await resolve(names, address, port, deadline);
  error_code error = boost::asio::error::host_not_found;
  for (const tcp::endpoint& endpoint : endpoints) {
    const auto attempt = std::make_shared<Attempt>(executor);
    attempt->socket.async_connect(endpoint,
                                  [attempt](const error_code& result) { attempt->finish(result); });
    error = co_await finished_attempt(attempt, deadline);
    if (!error) co_return std::move(attempt->socket);
  }
  unreachable(address, port, error);
}

boost::asio::ip::address resolved_now(const std::string& address) {
  error_code error;
  auto number = boost::asio::ip::make_address(address, error);
  if (!error) return number;
  boost::asio::io_context context;
  tcp::resolver resolver(context);
  const auto results = resolver.resolve(address, "", error);
  if (error || results.empty()) {
    throw StreamError(Kind::kUnreachable,
                      fmt::format("{}: found no such name: {}", address, error.message()));
  }
  return results.begin()->endpoint().address();
}

}  // namespace simbench::hardware
