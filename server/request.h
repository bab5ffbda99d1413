// A request to a local page, what answers it, and a text that goes on while its reader stays.
//
// A response with a body is sent whole. One with a `stream` is sent as its maker goes on: the head
// first, then what PageStream::send() is given. A stream whose reader has gone is closed; whoever
// works for it stops then.
//
//   PageResponse looked(const PageRequest& request) {
//     if (request.method != "POST") return {.status = 405, .body = "allowed: POST\n"};
//     return {.type = "application/x-ndjson",
//             .stream = [](std::shared_ptr<PageStream> reader) { reader->send("{}\n");
//             reader->end();
//             }};
//   }
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace simbench::server {

struct PageRequest {
  std::string method;   // "GET", "POST"
  std::string path;     // below the page: "" is the page itself, "look" is /TOKEN/look
  std::string query{};  // behind '?', as it came
  std::string body{};
};

// What a response goes on with. Thread-safe.
class PageStream {
 public:
  virtual ~PageStream() = default;
  // Nothing happens once it is closed. What a slow reader leaves waiting counts: beyond the
  // server's limit the stream is closed.
  virtual void send(std::string text) = 0;
  // No more follows.
  virtual void end() = 0;
  // The reader has gone, was too slow, or all has been sent.
  virtual bool is_closed() const = 0;
  // What was sent and has not left yet.
  virtual std::size_t waiting_bytes() const = 0;
  // Called once, when it is closed: at once if it is already. Must not block.
  virtual void when_closed(std::function<void()> action) = 0;
};

struct PageResponse {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body{};
  std::string file_name{};  // a browser saves it by this name; empty: it shows it
  // Called once, on the server's thread, when the head has been sent; then there is no body.
  std::function<void(std::shared_ptr<PageStream>)> stream{};
};

}  // namespace simbench::server
