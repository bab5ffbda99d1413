// The cost of sealing the nodes' messages, beside copying the same bytes and, over the loopback
// interface, beside unsealed datagrams; and the cost of refusing a forged datagram.
#include <benchmark/benchmark.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cstring>

#include "hardware/net/datagram.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::udp;

const KeyBytes kThere{1};
const KeyBytes kBack{2};

void copy_message(benchmark::State& state) {
  const Bytes message(static_cast<std::size_t>(state.range(0)), std::byte{7});
  Bytes copy(message.size());
  for (auto _ : state) {
    std::memcpy(copy.data(), message.data(), message.size());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(copy_message)->Arg(64)->Arg(1024);

void seal_and_open(benchmark::State& state) {
  const Bytes message(static_cast<std::size_t>(state.range(0)), std::byte{7});
  DatagramSession sender(1, kThere, kBack);
  DatagramSession receiver(0, kBack, kThere);
  Bytes opened;
  for (auto _ : state) {
    const Bytes datagram = sender.seal_next(message);
    if (receiver.open(*parse_datagram(datagram), datagram, opened) != DatagramVerdict::kAccepted) {
      state.SkipWithError("a datagram was refused");
    }
  }
}
BENCHMARK(seal_and_open)->Arg(64)->Arg(1024);

void refuse_forged(benchmark::State& state) {
  DatagramSession receiver(0, kBack, kThere);
  DatagramSession stranger(1, kBack, kThere);
  const Bytes forged = stranger.seal_next(Bytes(static_cast<std::size_t>(state.range(0))));
  Bytes opened;
  for (auto _ : state) {
    if (receiver.open(*parse_datagram(forged), forged, opened) != DatagramVerdict::kForged) {
      state.SkipWithError("a forged datagram was accepted");
    }
  }
}
BENCHMARK(refuse_forged)->Arg(64)->Arg(1024);

// A socket that sends to itself: both directions of a round trip are two of these.
struct Loop {
  Loop() : socket(context, udp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0)) {}
  std::size_t pass(const Bytes& datagram) {
    socket.send_to(boost::asio::buffer(datagram), socket.local_endpoint());
    return socket.receive(boost::asio::buffer(buffer));
  }
  boost::asio::io_context context;
  udp::socket socket;
  std::array<std::byte, 2048> buffer{};
};

void round_trip_plain(benchmark::State& state) {
  Loop loop;
  const Bytes message(static_cast<std::size_t>(state.range(0)), std::byte{7});
  for (auto _ : state) {
    loop.pass(message);
    loop.pass(message);
  }
}
BENCHMARK(round_trip_plain)->Arg(64)->Arg(1024);

void round_trip_sealed(benchmark::State& state) {
  Loop loop;
  DatagramSession here(0, kBack, kThere);
  DatagramSession there(1, kThere, kBack);
  const Bytes message(static_cast<std::size_t>(state.range(0)), std::byte{7});
  Bytes opened;
  const auto pass = [&](DatagramSession& from, DatagramSession& to) {
    const std::size_t size = loop.pass(from.seal_next(message));
    const auto datagram = std::span<const std::byte>(loop.buffer).first(size);
    return to.open(*parse_datagram(datagram), datagram, opened) == DatagramVerdict::kAccepted;
  };
  for (auto _ : state) {
    if (!pass(here, there) || !pass(there, here)) state.SkipWithError("a datagram was refused");
  }
}
BENCHMARK(round_trip_sealed)->Arg(64)->Arg(1024);

}  // namespace
}  // namespace simbench::hardware
