#include "server/local_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <csignal>
#include <deque>
#include <exception>
#include <list>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "server/guard.h"

namespace simbench::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kResult = asio::as_tuple(asio::use_awaitable);
constexpr std::uint32_t kMostHeadBytes = 8 * 1024;

// Forbids what another page, a cache or a guess of the type could do with an answer.
void add_rules(http::fields& head) {
  head.set("Cache-Control", "no-store");
  head.set("Content-Security-Policy",
           "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src "
           "data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors "
           "'none'");
  head.set("Cross-Origin-Opener-Policy", "same-origin");
  head.set("Cross-Origin-Resource-Policy", "same-origin");
  head.set("Referrer-Policy", "no-referrer");
  head.set("X-Content-Type-Options", "nosniff");
  head.set("X-Frame-Options", "DENY");
}

// What is sent to one reader as it comes: fed from any thread, emptied on the server's.
class ReaderStream final : public PageStream, public std::enable_shared_from_this<ReaderStream> {
 public:
  // `server` is kept, since whoever feeds the stream may do so for longer than the server runs.
  ReaderStream(std::shared_ptr<void> server, const asio::any_io_executor& executor,
               std::size_t most_waiting)
      : server_(std::move(server)), most_waiting_(most_waiting), wake_(executor) {
    wake_.expires_at(asio::steady_timer::time_point::max());
  }

  void send(std::string text) override {
    if (text.empty()) return;
    {
      const std::lock_guard lock(mutex_);
      if (closed_ || ended_) return;
      waiting_ += text.size();
      if (waiting_ > most_waiting_) too_slow_ = true;
      pieces_.push_back(std::move(text));
    }
    wake();
  }

  void end() override {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    wake();
  }

  bool is_closed() const override {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

  std::size_t waiting_bytes() const override {
    const std::lock_guard lock(mutex_);
    return waiting_;
  }

  void when_closed(std::function<void()> action) override {
    {
      const std::lock_guard lock(mutex_);
      if (!closed_) {
        actions_.push_back(std::move(action));
        return;
      }
    }
    action();
  }

  // The rest is for the server's thread.
  struct Next {
    std::string text{};  // empty: nothing to send yet
    bool is_over = false;
    bool is_too_slow = false;
  };
  Next take() {
    const std::lock_guard lock(mutex_);
    Next next{.is_too_slow = too_slow_};
    if (!pieces_.empty()) {
      next.text = std::move(pieces_.front());
      pieces_.pop_front();
    } else {
      next.is_over = ended_;
    }
    return next;
  }
  void has_left(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    waiting_ -= bytes;
  }
  asio::awaitable<void> wait() { co_await wake_.async_wait(kResult); }
  void rearm() { wake_.expires_at(asio::steady_timer::time_point::max()); }
  bool has_news() const {
    const std::lock_guard lock(mutex_);
    return !pieces_.empty() || ended_ || closed_ || too_slow_;
  }
  void close() {
    std::vector<std::function<void()>> actions;
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
      pieces_.clear();
      waiting_ = 0;
      actions.swap(actions_);
    }
    wake_.cancel();
    for (const auto& action : actions) action();
  }

 private:
  void wake() {
    asio::post(wake_.get_executor(), [self = shared_from_this()] { self->wake_.cancel(); });
  }

  const std::shared_ptr<void> server_;
  const std::size_t most_waiting_;
  asio::steady_timer wake_;
  mutable std::mutex mutex_;  // guards what follows
  std::deque<std::string> pieces_;
  std::size_t waiting_ = 0;
  bool ended_ = false;
  bool too_slow_ = false;
  bool closed_ = false;
  std::vector<std::function<void()>> actions_;
};

struct Connection {
  explicit Connection(tcp::socket socket) : stream(std::move(socket)) {}
  void close() {
    error_code ignored;
    stream.socket().close(ignored);
  }

  beast::tcp_stream stream;
  bool is_trusted = false;  // has shown the token
};

// What is said of a request that could not be read; nothing of a connection that ended.
PageRefusal refusal_of(const error_code& failed) {
  const error_code end = http::make_error_code(http::error::end_of_stream);
  if (failed == http::make_error_code(http::error::body_limit)) {
    return {413, "the body is larger than any that is sent here"};
  }
  const bool is_end = failed.category() != end.category() || failed == end ||
                      failed == http::make_error_code(http::error::partial_message);
  if (is_end) return {};
  return {400, "no request of HTTP, or too long a head"};
}

RequestHead head_of(const http::request<http::string_body>& request) {
  const auto field = [&request](auto name) { return static_cast<std::string_view>(request[name]); };
  return {.method = static_cast<std::string_view>(request.method_string()),
          .target = static_cast<std::string_view>(request.target()),
          .host = field(http::field::host),
          .origin = field(http::field::origin),
          .fetch_site = field("Sec-Fetch-Site"),
          .content_type = field(http::field::content_type)};
}

}  // namespace

class LocalServer::Core : public std::enable_shared_from_this<LocalServer::Core> {
 public:
  Core(const ServerOptions& options, Handler handler)
      : options_(options),
        handler_(std::move(handler)),
        acceptor_(context_, tcp::endpoint(asio::ip::address_v4::loopback(), options.port)),
        signals_(context_),
        guard_(acceptor_.local_endpoint().port(),
               options.token.empty() ? new_token() : options.token),
        address_(guard_.address()) {}

  const std::string& address() const { return address_; }
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  void run() {
    if (options_.stops_on_signals) {
      signals_.add(SIGINT);
      signals_.add(SIGTERM);
      signals_.async_wait([this](error_code failed, int) {
        if (!failed) stop_here();
      });
    }
    asio::co_spawn(context_, accept(), asio::detached);
    context_.run();
  }

  void stop() {
    asio::post(context_, [self = shared_from_this()] { self->stop_here(); });
  }

  void after(std::chrono::milliseconds delay, std::function<void()> action) {
    asio::post(context_, [self = shared_from_this(), delay, action = std::move(action)] {
      const auto timer = std::make_shared<asio::steady_timer>(self->context_, delay);
      self->timers_.push_back(timer);
      timer->async_wait([self, timer, action](error_code cancelled) {
        std::erase(self->timers_, timer);
        if (!cancelled) action();
      });
    });
  }

  ServerCounts counts() const {
    return {.answered = answered_, .refused = refused_, .displaced = displaced_};
  }

 private:
  using Connections = std::list<std::shared_ptr<Connection>>;

  void stop_here() {
    error_code ignored;
    acceptor_.close(ignored);
    signals_.cancel(ignored);
    for (const auto& connection : connections_) connection->close();
    for (const auto& stream : streams_) stream->close();
    for (const auto& timer : std::vector(timers_)) timer->cancel();
  }

  asio::awaitable<void> accept() {
    while (acceptor_.is_open()) {
      auto [failed, socket] = co_await acceptor_.async_accept(kResult);
      if (!acceptor_.is_open()) break;
      if (failed) {  // no descriptor is free: those there are go on
        asio::steady_timer pause(context_, std::chrono::milliseconds(50));
        co_await pause.async_wait(kResult);
        continue;
      }
      if (!has_room()) {
        ++displaced_;
        continue;
      }
      connections_.push_back(std::make_shared<Connection>(std::move(socket)));
      asio::co_spawn(context_, keep(std::prev(connections_.end())), asio::detached);
    }
  }

  // Makes room by closing the oldest that has not shown the token.
  bool has_room() {
    if (connections_.size() < options_.most_connections) return true;
    const auto oldest = std::ranges::find(connections_, false, [](const auto& each) {
      return each->is_trusted || !each->stream.socket().is_open();
    });
    if (oldest == connections_.end()) return false;
    ++displaced_;
    (*oldest)->close();
    return true;
  }

  asio::awaitable<void> keep(Connections::iterator place) {
    const std::shared_ptr<Connection> connection = *place;
    const std::shared_ptr<Core> self = shared_from_this();
    try {
      co_await serve(*connection);
    } catch (const std::exception&) {  // an end of the connection like any other
    }
    connection->close();
    connections_.erase(place);
  }

  asio::awaitable<void> serve(Connection& connection) {
    beast::flat_buffer buffer(kMostHeadBytes + options_.most_body_bytes);
    bool goes_on = true;
    for (bool is_first = true; goes_on; is_first = false) {
      http::request_parser<http::string_body> parser;
      parser.header_limit(kMostHeadBytes);
      parser.body_limit(options_.most_body_bytes);
      connection.stream.expires_after(is_first ? options_.request_time : options_.idle_time);
      const auto [failed, head_bytes] =
          co_await http::async_read_header(connection.stream, buffer, parser, kResult);
      if (failed) {
        const PageRefusal refusal = refusal_of(failed);
        co_await refuse(connection, refusal);
        co_return;
      }
      if (const PageRefusal refusal = guard_.judge(head_of(parser.get()))) {
        co_await refuse(connection, refusal);
        co_return;
      }
      connection.is_trusted = true;
      connection.stream.expires_after(options_.request_time);
      const auto [broken, body_bytes] =
          co_await http::async_read(connection.stream, buffer, parser, kResult);
      if (broken) {
        const PageRefusal refusal = refusal_of(broken);
        co_await refuse(connection, refusal);
        co_return;
      }
      goes_on = co_await answer(connection, parser.get());
    }
  }

  asio::awaitable<void> refuse(Connection& connection, PageRefusal refusal) {
    if (!refusal) co_return;
    ++refused_;
    http::response<http::string_body> response(http::int_to_status(refusal.status), 11);
    add_rules(response);
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.body() = refusal.text + "\n";
    response.keep_alive(false);
    response.prepare_payload();
    connection.stream.expires_after(options_.write_time);
    co_await http::async_write(connection.stream, response, kResult);
    error_code ignored;
    connection.stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  PageResponse handled(const http::request<http::string_body>& request) {
    const Target target = guard_.below_token(static_cast<std::string_view>(request.target()));
    try {
      return handler_(
          {.method = std::string(static_cast<std::string_view>(request.method_string())),
           .path = target.path,
           .query = target.query,
           .body = request.body()});
    } catch (const std::exception& failure) {
      return {.status = 500, .body = std::string(failure.what()) + "\n"};
    }
  }

  // Whether the connection goes on.
  asio::awaitable<bool> answer(Connection& connection,
                               const http::request<http::string_body>& request) {
    PageResponse made = handled(request);
    ++answered_;
    if (made.stream) {
      co_await feed(connection, made);
      co_return false;
    }
    http::response<http::string_body> response(http::int_to_status(made.status), 11);
    add_rules(response);
    response.set(http::field::content_type, made.type);
    if (!made.file_name.empty()) {
      response.set(http::field::content_disposition,
                   "attachment; filename=\"" + made.file_name + "\"");
    }
    response.keep_alive(request.keep_alive());
    response.body() = std::move(made.body);
    response.prepare_payload();
    if (request.method() == http::verb::head) response.body().clear();
    connection.stream.expires_after(options_.write_time);
    const auto [failed, bytes] = co_await http::async_write(connection.stream, response, kResult);
    co_return !failed && response.keep_alive();
  }

  // Sends a stream until its end or its reader's.
  asio::awaitable<void> feed(Connection& connection, const PageResponse& made) {
    http::response<http::empty_body> head(http::int_to_status(made.status), 11);
    add_rules(head);
    head.set(http::field::content_type, made.type);
    head.keep_alive(false);
    head.chunked(true);
    http::response_serializer<http::empty_body> serializer(head);
    connection.stream.expires_after(options_.write_time);
    const auto [failed, bytes] =
        co_await http::async_write_header(connection.stream, serializer, kResult);
    if (failed) co_return;
    const auto stream = std::make_shared<ReaderStream>(shared_from_this(), context_.get_executor(),
                                                       options_.most_waiting_bytes);
    streams_.push_back(stream);
    connection.stream.expires_never();
    asio::co_spawn(context_, notice_end(connection, stream), asio::detached);
    made.stream(stream);
    co_await send_pieces(connection, *stream);
    stream->close();
    connection.close();
    streams_.remove(stream);
  }

  // Reads what the reader sends, which is nothing, until it goes.
  asio::awaitable<void> notice_end(Connection& connection, std::shared_ptr<ReaderStream> stream) {
    const std::shared_ptr<Core> self = shared_from_this();
    const auto keeps =
        *std::ranges::find(connections_, &connection, [](const auto& each) { return each.get(); });
    std::array<char, 256> ignored{};
    for (;;) {
      const auto [gone, bytes] =
          co_await keeps->stream.socket().async_read_some(asio::buffer(ignored), kResult);
      if (gone) break;
    }
    stream->close();
  }

  asio::awaitable<void> send_pieces(Connection& connection, ReaderStream& stream) {
    for (;;) {
      if (stream.is_closed()) co_return;
      ReaderStream::Next next = stream.take();
      if (next.is_too_slow) co_return;
      if (next.is_over) break;
      if (next.text.empty()) {
        stream.rearm();
        if (!stream.has_news()) co_await stream.wait();
        continue;
      }
      connection.stream.expires_after(options_.write_time);
      const auto [failed, bytes] = co_await asio::async_write(
          connection.stream, http::make_chunk(asio::buffer(next.text)), kResult);
      connection.stream.expires_never();
      if (failed) co_return;
      stream.has_left(next.text.size());
    }
    connection.stream.expires_after(options_.write_time);
    co_await asio::async_write(connection.stream, http::make_chunk_last(), kResult);
  }

  const ServerOptions options_;
  const Handler handler_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  asio::signal_set signals_;
  const PageGuard guard_;
  const std::string address_;
  Connections connections_;  // the oldest first
  std::list<std::shared_ptr<ReaderStream>> streams_;
  std::vector<std::shared_ptr<asio::steady_timer>> timers_;
  std::atomic<std::uint64_t> answered_ = 0;
  std::atomic<std::uint64_t> refused_ = 0;
  std::atomic<std::uint64_t> displaced_ = 0;
};

LocalServer::LocalServer(ServerOptions options, Handler handler) {
  try {
    core_ = std::make_shared<Core>(options, std::move(handler));
  } catch (const boost::system::system_error& failure) {
    throw std::system_error(failure.code());
  }
}
LocalServer::~LocalServer() = default;
const std::string& LocalServer::address() const { return core_->address(); }
std::uint16_t LocalServer::port() const { return core_->port(); }
void LocalServer::run() { core_->run(); }
void LocalServer::stop() { core_->stop(); }
void LocalServer::after(std::chrono::milliseconds delay, std::function<void()> action) {
  core_->after(delay, std::move(action));
}
ServerCounts LocalServer::counts() const { return core_->counts(); }

}  // namespace simbench::server
