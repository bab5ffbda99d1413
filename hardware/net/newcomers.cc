#include "hardware/net/newcomers.h"

#include <algorithm>
#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <iterator>
#include <utility>

namespace simbench::hardware {
namespace {

constexpr std::size_t kMostNewcomers = 64;
// The limits of one source.
constexpr double kConnectionsPerSecond = 100;
constexpr double kConnectionsAtOnce = 256;

}  // namespace

Newcomers::Newcomers(boost::asio::io_context& context, SecretKey key, PeerName me)
    : context_(context),
      key_(std::move(key)),
      me_(me),
      allowed_(kConnectionsPerSecond, kConnectionsAtOnce) {}

void Newcomers::greet(boost::asio::ip::tcp::socket socket, Outcome outcome) {
  boost::system::error_code gone;
  const auto from = socket.remote_endpoint(gone).address();
  if (gone || !allowed_.take(from, 0, monotonic_now())) return outcome(nullptr);
  if (waiting_.size() >= kMostNewcomers) refuse_one();
  waiting_.emplace_back();
  const auto newcomer = std::prev(waiting_.end());
  newcomer->from = from;
  boost::asio::co_spawn(
      context_,
      SecureStream::accept(std::move(socket), key_, me_, monotonic_now() + kHandshakeTime),
      boost::asio::bind_cancellation_slot(
          newcomer->refuse.slot(),
          [this, newcomer, outcome = std::move(outcome)](const std::exception_ptr& refused,
                                                         std::unique_ptr<SecureStream> stream) {
            waiting_.erase(newcomer);
            outcome(refused ? nullptr : std::move(stream));
          }));
}

void Newcomers::refuse_one() {
  const auto of_address = [this](const boost::asio::ip::address& from) {
    return std::ranges::count(waiting_, from, &Newcomer::from);
  };
  const auto most = std::ranges::max_element(
      waiting_, {}, [&of_address](const Newcomer& one) { return of_address(one.from); });
  most->refuse.emit(boost::asio::cancellation_type::terminal);
}

void Newcomers::refuse_all() {
  for (Newcomer& newcomer : waiting_) {
    newcomer.refuse.emit(boost::asio::cancellation_type::terminal);
  }
}

}  // namespace simbench::hardware
