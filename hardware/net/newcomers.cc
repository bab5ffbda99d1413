#include "hardware/net/newcomers.h"

#include <algorithm>
#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <iterator>
#include <utility>

namespace simbench::hardware {
namespace {

constexpr std::size_t kMostNewcomers = 256;

}  // namespace

Newcomers::Newcomers(boost::asio::io_context& context, SecretKey key, PeerName me)
    : context_(context), key_(std::move(key)), me_(me) {}

void Newcomers::greet(boost::asio::ip::tcp::socket socket, Outcome outcome) {
  boost::system::error_code gone;
  const auto from = socket.remote_endpoint(gone).address();
  if (gone) return outcome(nullptr);
  if (waiting_.size() >= kMostNewcomers) refuse_one();
  waiting_.emplace_back();
  const auto newcomer = std::prev(waiting_.end());
  newcomer->from = from;
  ++counts_[from];
  boost::asio::co_spawn(
      context_,
      SecureStream::accept(std::move(socket), key_, me_, monotonic_now() + kHandshakeTime),
      boost::asio::bind_cancellation_slot(
          newcomer->refuse.slot(),
          [this, newcomer, outcome = std::move(outcome)](const std::exception_ptr& refused,
                                                         std::unique_ptr<SecureStream> stream) {
            if (!newcomer->is_refused) forget(newcomer->from);
            (newcomer->is_refused ? refused_ : waiting_).erase(newcomer);
            outcome(refused ? nullptr : std::move(stream));
          }));
}

void Newcomers::forget(const boost::asio::ip::address& from) {
  const auto count = counts_.find(from);
  if (--count->second == 0) counts_.erase(count);
}

void Newcomers::refuse_one() {
  const auto most = std::ranges::max_element(counts_, {}, &Counts::value_type::second);
  const auto oldest = std::ranges::find(waiting_, most->first, &Newcomer::from);
  forget(oldest->from);
  oldest->is_refused = true;
  refused_.splice(refused_.end(), waiting_, oldest);
  oldest->refuse.emit(boost::asio::cancellation_type::terminal);
}

void Newcomers::refuse_all() {
  for (Newcomer& newcomer : waiting_) {
    newcomer.refuse.emit(boost::asio::cancellation_type::terminal);
  }
}

}  // namespace simbench::hardware
