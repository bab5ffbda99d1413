#include "hardware/net/secure_stream.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "hardware/net/connect.h"
#include "hardware/net/secure_stream_state.h"
#include "hardware/net/wire_numbers.h"

namespace simbench::hardware {
namespace {

// Ends a stream whose handshake is not finished, also when that is cancelled.
template <class State>
class Guard {
 public:
  explicit Guard(std::shared_ptr<State> state) : state_(std::move(state)) {}
  ~Guard() {
    if (state_) state_->close();
  }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
  std::shared_ptr<State> release() { return std::move(state_); }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace

SecureStream::SecureStream(std::shared_ptr<State> state) : state_(std::move(state)) {}

SecureStream::~SecureStream() { state_->close(); }

Task<std::unique_ptr<SecureStream>> SecureStream::connect(boost::asio::io_context& context,
                                                          std::string address, std::uint16_t port,
                                                          SecretKey key, PeerName me,
                                                          MonotonicTime deadline) {
  auto socket = co_await connect_socket(context.get_executor(), address, port, deadline);
  auto state = std::make_shared<State>(std::move(socket), key, me, State::Side::kConnected);
  Guard<State> guard(state);
  state->start();
  co_await State::shake_hands(state, deadline);
  co_return std::unique_ptr<SecureStream>(new SecureStream(guard.release()));
}

Task<std::unique_ptr<SecureStream>> SecureStream::accept(boost::asio::ip::tcp::socket socket,
                                                         SecretKey key, PeerName me,
                                                         MonotonicTime deadline) {
  auto state = std::make_shared<State>(std::move(socket), key, me, State::Side::kAccepted);
  Guard<State> guard(state);
  state->start();
  co_await State::shake_hands(state, deadline);
  co_return std::unique_ptr<SecureStream>(new SecureStream(guard.release()));
}

PeerName SecureStream::peer() const { return state_->peer(); }

std::string SecureStream::peer_address() const { return state_->address(); }

KeyBytes SecureStream::derived_key(std::uint64_t purpose) const {
  std::array<std::byte, sizeof purpose> which{};
  put_number(which, purpose);
  return derive_key(state_->session_key(), "simbench derived key", which);
}

Task<MessageId> SecureStream::send(Bytes message) {
  return State::send(state_, std::move(message));
}

Task<StreamMessage> SecureStream::receive(MonotonicTime deadline) {
  return State::receive(state_, deadline);
}

Task<std::optional<MonotonicTime>> SecureStream::transmit_stamp(MessageId id,
                                                                MonotonicTime deadline) {
  return State::transmit_stamp(state_, id, deadline);
}

void SecureStream::close() { state_->close(); }

}  // namespace simbench::hardware
