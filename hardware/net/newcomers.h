// Connections that have not proved the key yet: at most 256, for 2 s each. A further one makes the
// oldest of the address with most of them be refused, so a flood displaces its own connections.
// There is no limit for an address: a flood from the conductor's own would shut that out, which
// needs no more than a round trip of 256 connections' time to prove the key.
//
// One thread.
//
//   Newcomers newcomers(context, key, PeerName{2});
//   newcomers.greet(std::move(socket), [&](std::unique_ptr<SecureStream> stream) {
//     if (stream) admit(std::move(stream));
//   });
#pragma once

#include <boost/asio/cancellation_signal.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>

#include "hardware/clock/monotonic_time.h"
#include "hardware/net/secret_key.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

// A newcomer that has not proved the key after this time is refused.
inline constexpr Nanoseconds kHandshakeTime = std::chrono::seconds(2);

class Newcomers {
 public:
  // `stream` is null if the newcomer was refused.
  using Outcome = std::function<void(std::unique_ptr<SecureStream> stream)>;

  Newcomers(boost::asio::io_context& context, SecretKey key, PeerName me);

  // `outcome` is called once, now or later, and keeps this alive until then.
  void greet(boost::asio::ip::tcp::socket socket, Outcome outcome);
  void refuse_all();

 private:
  // The newcomers of each address.
  using Counts = std::map<boost::asio::ip::address, std::size_t>;
  struct Newcomer {
    boost::asio::ip::address from;
    boost::asio::cancellation_signal refuse;
    bool is_refused = false;
  };

  void refuse_one();
  void forget(const boost::asio::ip::address& from);

  boost::asio::io_context& context_;
  SecretKey key_;
  PeerName me_;
  std::list<Newcomer> waiting_;  // the oldest first
  std::list<Newcomer> refused_;  // and not gone yet
  Counts counts_;                // of those that wait
};

}  // namespace simbench::hardware
