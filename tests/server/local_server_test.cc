#include "server/local_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace simbench::server {
namespace {

using boost::asio::ip::tcp;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A server that runs while it lives.
class Served {
 public:
  explicit Served(LocalServer::Handler handler, ServerOptions options = {})
      : server(options, std::move(handler)), thread_([this] { server.run(); }) {}
  ~Served() {
    server.stop();
    thread_.join();
  }

  std::string token_path() const {
    const std::string& address = server.address();
    return address.substr(address.find('/', 8));
  }

  LocalServer server;

 private:
  std::thread thread_;
};

class Client {
 public:
  explicit Client(const Served& served) : socket_(context_) {
    socket_.connect({boost::asio::ip::address_v4::loopback(), served.server.port()});
  }

  void send(const std::string& text) {
    boost::system::error_code ignored;  // the server may have closed meanwhile
    boost::asio::write(socket_, boost::asio::buffer(text), ignored);
  }
  // All until the server closes.
  std::string rest() {
    std::string text;
    boost::system::error_code end;
    boost::asio::read(socket_, boost::asio::dynamic_buffer(text), end);
    return text;
  }
  // Until that has come, or the end.
  std::string until(const std::string& what) {
    std::string text;
    std::array<char, 4096> piece{};
    boost::system::error_code end;
    while (text.find(what) == std::string::npos && !end) {
      text.append(piece.data(), socket_.read_some(boost::asio::buffer(piece), end));
    }
    return text;
  }
  void close() { socket_.close(); }

 private:
  boost::asio::io_context context_;
  tcp::socket socket_;
};

std::string get(const Served& served, const std::string& target, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(served.server.port()) +
         "\r\n" + more + "\r\n";
}

std::string post(const Served& served, const std::string& path, const std::string& body) {
  return "POST " + served.token_path() + path +
         " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(served.server.port()) +
         "\r\nContent-Type: application/json\r\nConnection: close\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

std::string answered(const Served& served, const std::string& request) {
  Client client(served);
  client.send(request);
  return client.rest();
}

PageResponse echo(const PageRequest& request) {
  return {.body =
              request.method + " [" + request.path + "] [" + request.query + "] " + request.body};
}

TEST(LocalServerTest, AnswersWhoKnowsTheAddress) {
  const Served served(echo);
  EXPECT_THAT(
      answered(served, get(served, served.token_path() + "a/b?c=d", "Connection: close\r\n")),
      HasSubstr("GET [a/b] [c=d] "));
  EXPECT_THAT(answered(served, post(served, "look", "{}")), HasSubstr("POST [look] [] {}"));
  EXPECT_EQ(served.server.counts().answered, 2u);
}

TEST(LocalServerTest, EveryAnswerForbidsWhatAnotherPageCouldDoWithIt) {
  const Served served(echo);
  for (const std::string& target : {served.token_path(), std::string("/")}) {
    const std::string answer = answered(served, get(served, target, "Connection: close\r\n"));
    for (const char* const rule :
         {"Cache-Control: no-store", "X-Content-Type-Options: nosniff", "X-Frame-Options: DENY",
          "frame-ancestors 'none'", "default-src 'none'", "Referrer-Policy: no-referrer",
          "Cross-Origin-Resource-Policy: same-origin"}) {
      EXPECT_THAT(answer, HasSubstr(rule));
    }
    EXPECT_THAT(answer, Not(HasSubstr("Access-Control")));
  }
}

TEST(LocalServerTest, OneConnectionAnswersManyRequests) {
  const Served served(echo);
  Client client(served);
  for (int i = 0; i < 3; ++i) {
    client.send(get(served, served.token_path() + "page" + std::to_string(i)));
    EXPECT_THAT(client.until("] [] "), HasSubstr("[page" + std::to_string(i) + "]"));
  }
}

TEST(LocalServerTest, AHeadRequestHasNoBody) {
  const Served served(echo);
  std::string request = get(served, served.token_path(), "Connection: close\r\n");
  request.replace(0, 3, "HEAD");
  const std::string answer = answered(served, request);
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, Not(HasSubstr("HEAD [")));
}

// The handler is not asked, and the body is not even read.
TEST(LocalServerTest, RefusesBeforeTheBodyIsRead) {
  const Served served([](const PageRequest&) -> PageResponse {
    ADD_FAILURE() << "was asked";
    return {};
  });
  Client client(served);
  client.send(
      "POST /wrong/look HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(served.server.port()) +
      "\r\nContent-Type: application/json\r\nContent-Length: 100000\r\n\r\n");
  EXPECT_THAT(client.rest(), StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(served.server.counts().refused, 1u);
}

TEST(LocalServerTest, RefusesLargeBodiesAndHeads) {
  const Served served(echo, {.most_body_bytes = 1000});
  EXPECT_THAT(answered(served, post(served, "look", std::string(1001, ' '))),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(answered(served, post(served, "look", std::string(1000, ' '))),
              StartsWith("HTTP/1.1 200"));
  const std::string huge = "X-Huge: " + std::string(20000, 'x') + "\r\n";
  EXPECT_THAT(answered(served, get(served, served.token_path(), huge)), StartsWith("HTTP/1.1 400"));
}

TEST(LocalServerTest, NonsenseIsRefused) {
  const Served served(echo);
  for (const char* const text :
       {"nonsense\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "\x16\x03\x01\x02\r\n\r\n",
        "GET / HTTP/1.1\r\nBad Header\r\n\r\n"}) {
    EXPECT_THAT(answered(served, text), StartsWith("HTTP/1.1 4")) << text;
  }
}

TEST(LocalServerTest, AFailureOfTheHandlerIsAnAnswer) {
  const Served served(
      [](const PageRequest&) -> PageResponse { throw std::runtime_error("it broke"); });
  const std::string answer =
      answered(served, get(served, served.token_path(), "Connection: close\r\n"));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 500"));
  EXPECT_THAT(answer, HasSubstr("it broke"));
}

TEST(LocalServerTest, WhoSaysNothingIsClosed) {
  const Served served(echo, {.request_time = std::chrono::milliseconds(50)});
  Client client(served);
  client.send("GET /");
  EXPECT_EQ(client.rest(), "");
}

// Connections that never show the token displace each other, not the user's.
TEST(LocalServerTest, AFloodDisplacesItself) {
  const Served served(echo, {.most_connections = 8});
  Client user(served);
  user.send(get(served, served.token_path() + "first"));
  user.until("] [] ");
  std::vector<std::unique_ptr<Client>> flood;
  for (int i = 0; i < 50; ++i) {
    flood.push_back(std::make_unique<Client>(served));
    flood.back()->send("GET /");
  }
  Client late(served);
  late.send(get(served, served.token_path() + "late"));
  EXPECT_THAT(late.until("] [] "), HasSubstr("[late]"));
  user.send(get(served, served.token_path() + "second"));
  EXPECT_THAT(user.until("] [] "), HasSubstr("[second]"));
  EXPECT_GE(served.server.counts().displaced, 40u);
}

// Hands its stream to the test.
class Streamed {
 public:
  explicit Streamed(ServerOptions options = {})
      : served([this](const PageRequest&) { return response(); }, options) {}

  std::shared_ptr<PageStream> stream() {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return stream_ != nullptr; });
    return std::exchange(stream_, nullptr);
  }

 private:
  PageResponse response() {
    return {.type = "application/x-ndjson", .stream = [this](std::shared_ptr<PageStream> stream) {
              const std::lock_guard lock(mutex_);
              stream_ = std::move(stream);
              news_.notify_all();
            }};
  }

  std::mutex mutex_;
  std::condition_variable news_;
  std::shared_ptr<PageStream> stream_;

 public:
  Served served;  // the last: its thread uses the others
};

TEST(LocalServerTest, AStreamIsSentAsItComes) {
  Streamed streamed;
  Client client(streamed.served);
  client.send(post(streamed.served, "look", "{}"));
  const std::shared_ptr<PageStream> stream = streamed.stream();
  stream->send("first\n");
  EXPECT_THAT(client.until("first"), HasSubstr("Transfer-Encoding: chunked"));
  stream->send("second\n");
  EXPECT_THAT(client.until("second"), HasSubstr("second"));
  stream->end();
  EXPECT_THAT(client.rest(), HasSubstr("0\r\n\r\n"));
}

struct Closing {
  void watch(PageStream& stream) {
    stream.when_closed([this] {
      const std::lock_guard lock(mutex);
      closed = true;
      news.notify_all();
    });
  }
  void wait() {
    std::unique_lock lock(mutex);
    news.wait(lock, [this] { return closed; });
  }
  std::mutex mutex;
  std::condition_variable news;
  bool closed = false;
};

TEST(LocalServerTest, AReaderThatGoesClosesItsStream) {
  Streamed streamed;
  Closing closing;
  Client client(streamed.served);
  client.send(post(streamed.served, "look", "{}"));
  const std::shared_ptr<PageStream> stream = streamed.stream();
  closing.watch(*stream);
  EXPECT_FALSE(stream->is_closed());
  client.close();
  closing.wait();
  EXPECT_TRUE(stream->is_closed());
  stream->send("nobody reads this");  // and nothing happens
  EXPECT_EQ(stream->waiting_bytes(), 0u);
}

TEST(LocalServerTest, ASlowReaderIsClosed) {
  Streamed streamed({.most_waiting_bytes = 1'000'000});
  Closing closing;
  Client client(streamed.served);
  client.send(post(streamed.served, "look", "{}"));
  const std::shared_ptr<PageStream> stream = streamed.stream();
  closing.watch(*stream);
  // More than the sockets' own buffers hold: the reader takes nothing.
  for (int i = 0; i < 400 && !stream->is_closed(); ++i) stream->send(std::string(100'000, 'x'));
  closing.wait();
}

// What strangers may send, of which nothing reaches the handler.
std::vector<std::string> hostile_requests(const Served& served) {
  const std::string own = "Host: 127.0.0.1:" + std::to_string(served.server.port()) + "\r\n";
  const std::string path = served.token_path();
  return {"GET / HTTP/1.1\r\n" + own + "\r\n",
          "GET /../../etc/passwd HTTP/1.1\r\n" + own + "\r\n",
          "GET " + path + " HTTP/1.1\r\nHost: evil.example\r\n\r\n",
          "GET " + path + " HTTP/1.1\r\n" + own + "Origin: http://evil.example\r\n\r\n",
          "POST " + path + "look HTTP/1.1\r\n" + own +
              "Content-Type: text/plain\r\nContent-Length: 2\r\n\r\n{}",
          "DELETE " + path + " HTTP/1.1\r\n" + own + "\r\n",
          "POST / HTTP/1.1\r\n" + own + "Content-Length: 99999999999\r\n\r\n",
          "GET " + path.substr(0, path.size() - 2) + "x/ HTTP/1.1\r\n" + own + "\r\n",
          std::string(9000, 'A') + "\r\n\r\n",
          std::string("\0\0\0\0\r\n\r\n", 8)};
}

// While strangers knock as fast as they can, the user's stream goes on and nothing else is asked.
TEST(LocalServerTest, HostileRequestsChangeNothing) {
  Streamed streamed;
  Client user(streamed.served);
  user.send(post(streamed.served, "look", "{}"));
  const std::shared_ptr<PageStream> stream = streamed.stream();
  std::vector<std::thread> strangers;
  for (int i = 0; i < 4; ++i) {
    strangers.emplace_back([&streamed] {
      const std::vector<std::string> requests = hostile_requests(streamed.served);
      for (int round = 0; round < 50; ++round) {
        for (const std::string& request : requests) {
          EXPECT_THAT(answered(streamed.served, request), StartsWith("HTTP/1.1 4"));
        }
      }
    });
  }
  for (int i = 0; i < 20; ++i) {
    const std::string text = "line " + std::to_string(i) + "\n";
    stream->send(text);
    EXPECT_THAT(user.until(text), HasSubstr(text));
  }
  for (std::thread& stranger : strangers) stranger.join();
  EXPECT_EQ(streamed.served.server.counts().answered, 1u);
  EXPECT_EQ(streamed.served.server.counts().refused, 4u * 50u * 10u);
  EXPECT_FALSE(stream->is_closed());
}

TEST(LocalServerTest, StoppingClosesStreamsAndEndsRun) {
  Closing closing;
  {
    Streamed streamed;
    Client client(streamed.served);
    client.send(post(streamed.served, "look", "{}"));
    closing.watch(*streamed.stream());
  }
  closing.wait();
}

TEST(LocalServerTest, AnActionComesAfterItsTime) {
  std::atomic<bool> done = false;
  LocalServer server({}, echo);
  server.after(std::chrono::milliseconds(1), [&] {
    done = true;
    server.stop();
  });
  server.run();
  EXPECT_TRUE(done);
}

TEST(LocalServerTest, APortThatIsTakenIsAnError) {
  const Served served(echo);
  EXPECT_THROW(LocalServer({.port = served.server.port()}, echo), std::system_error);
}

}  // namespace
}  // namespace simbench::server
