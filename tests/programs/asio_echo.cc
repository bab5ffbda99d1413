// Boost.Asio as capture servers use it: three threads run one context with coroutines over UDP and
// TCP, timers, and a resolver.
//
//   asio_echo serve | asio_echo ask HOST
#include <unistd.h>

#include <array>
#include <boost/asio.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

namespace {

namespace asio = boost::asio;
using asio::use_awaitable;
using asio::ip::tcp;
using asio::ip::udp;
using namespace asio::experimental::awaitable_operators;
using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

constexpr std::uint16_t kPort = 5601;
constexpr std::uint16_t kDeafPort = 5602;
constexpr int kQuestions = 200;

double ms_since(Steady::time_point begin) {
  return std::chrono::duration<double, std::milli>(Steady::now() - begin).count();
}

asio::awaitable<void> answer_datagrams() {
  udp::socket socket(co_await asio::this_coro::executor, {udp::v4(), kPort});
  for (;;) {
    std::array<char, 64> data{};
    udp::endpoint asker;
    const std::size_t size =
        co_await socket.async_receive_from(asio::buffer(data), asker, use_awaitable);
    co_await socket.async_send_to(asio::buffer(data, size), asker, use_awaitable);
  }
}

asio::awaitable<void> answer(tcp::socket socket) {
  std::array<char, 64> data{};
  for (;;) {
    const std::size_t size = co_await socket.async_read_some(asio::buffer(data), use_awaitable);
    co_await asio::async_write(socket, asio::buffer(data, size), use_awaitable);
  }
}

asio::awaitable<void> accept() {
  const auto executor = co_await asio::this_coro::executor;
  tcp::acceptor acceptor(executor, {tcp::v4(), kPort});
  for (;;) {
    asio::co_spawn(executor, answer(co_await acceptor.async_accept(use_awaitable)), asio::detached);
  }
}

// The mean round trip, ms.
asio::awaitable<double> ask_by_datagrams(udp::endpoint server) {
  const auto executor = co_await asio::this_coro::executor;
  udp::socket socket(executor, {udp::v4(), 0});
  asio::steady_timer next(executor, Steady::now());
  double sum_ms = 0;
  for (int i = 0; i < kQuestions; ++i) {
    next.expires_at(next.expiry() + 10ms);
    co_await next.async_wait(use_awaitable);
    const auto begin = Steady::now();
    co_await socket.async_send_to(asio::buffer("question", 8), server, use_awaitable);
    std::array<char, 64> data{};
    co_await socket.async_receive(asio::buffer(data), use_awaitable);
    sum_ms += ms_since(begin);
  }
  co_return sum_ms / kQuestions;
}

// How long it waits for an answer that never comes, ms.
asio::awaitable<double> wait_in_vain(udp::endpoint server) {
  const auto executor = co_await asio::this_coro::executor;
  udp::socket socket(executor, {udp::v4(), kDeafPort});
  server.port(kDeafPort);
  const auto begin = Steady::now();
  std::array<char, 64> data{};
  asio::steady_timer patience(executor, 250ms);
  const auto either = co_await (socket.async_receive(asio::buffer(data), use_awaitable) ||
                                patience.async_wait(use_awaitable));
  co_return either.index() == 1 ? ms_since(begin) : -1;
}

asio::awaitable<std::string> ask_by_stream(const char* host) {
  const auto executor = co_await asio::this_coro::executor;
  tcp::resolver resolver(executor);
  const auto found = co_await resolver.async_resolve(host, std::to_string(kPort), use_awaitable);
  tcp::socket socket(executor);
  co_await asio::async_connect(socket, found, use_awaitable);
  co_await asio::async_write(socket, asio::buffer("hello", 5), use_awaitable);
  std::array<char, 5> data{};
  co_await asio::async_read(socket, asio::buffer(data), use_awaitable);
  co_return std::string(data.data(), data.size());
}

asio::awaitable<void> ask(const char* host) {
  const auto executor = co_await asio::this_coro::executor;
  udp::resolver resolver(executor);
  const auto found =
      co_await resolver.async_resolve(udp::v4(), host, std::to_string(kPort), use_awaitable);
  const udp::endpoint server = *found.begin();
  const auto [mean_ms, vain_ms, said] =
      co_await (ask_by_datagrams(server) && wait_in_vain(server) && ask_by_stream(host));
  std::printf("%s: round trip %.3f ms, in vain %.2f ms\n", said.c_str(), mean_ms, vain_ms);
  std::fflush(stdout);
}

void on_end(const std::exception_ptr& failure) {
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

int main(int count, char** words) {
  asio::io_context context;
  if (count == 3 && std::strcmp(words[1], "ask") == 0) {
    asio::co_spawn(context, ask(words[2]), on_end);
  } else {
    asio::co_spawn(context, answer_datagrams(), on_end);
    asio::co_spawn(context, accept(), on_end);
  }
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back([&context] { context.run(); });
  for (std::thread& each : threads) each.join();
  for (;;) sleep(3600);
}
