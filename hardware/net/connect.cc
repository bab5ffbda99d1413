#include "hardware/net/connect.h"

#include <fmt/format.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hardware/net/names.h"
#include "hardware/net/notice.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {
namespace {

using Kind = StreamError::Kind;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr Nanoseconds kNamePatience = std::chrono::seconds(60);  // of resolved_now()

// The state of an attempt, shared with its handlers, which may outlive it.
struct Attempt {
  explicit Attempt(const boost::asio::any_io_executor& executor)
      : socket(executor), done(executor) {}
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

}  // namespace

std::string address_text(const std::string& address, std::uint16_t port) {
  const bool ip6 = address.find(':') != std::string::npos;
  return ip6 ? fmt::format("[{}]:{}", address, port) : fmt::format("{}:{}", address, port);
}

Task<tcp::socket> connect_socket(boost::asio::any_io_executor executor, std::string address,
                                 std::uint16_t port, MonotonicTime deadline) {
  const auto addresses = co_await addresses_of(executor, address, deadline);
  error_code error = boost::asio::error::host_not_found;
  for (const auto& each : addresses) {
    const auto attempt = std::make_shared<Attempt>(executor);
    attempt->socket.async_connect(tcp::endpoint(each, port),
                                  [attempt](const error_code& result) { attempt->finish(result); });
    error = co_await finished_attempt(attempt, deadline);
    if (!error) co_return std::move(attempt->socket);
  }
  unreachable(address, port, error);
}

boost::asio::ip::address resolved_now(const std::string& address) {
  boost::asio::io_context context;
  boost::asio::ip::address first;
  std::exception_ptr error;
  boost::asio::co_spawn(
      context, addresses_of(context.get_executor(), address, monotonic_now() + kNamePatience),
      [&](const std::exception_ptr& thrown,
          const std::vector<boost::asio::ip::address>& addresses) {
        error = thrown;
        if (!thrown) first = addresses.front();
      });
  context.run();
  if (error) std::rethrow_exception(error);
  return first;
}

}  // namespace simbench::hardware
