// A web server for the person at this machine: on its loopback interface, behind a token.
//
// Problem: a page that shows a rig, and changes what is computed, must be read and steered by its
// user alone. Loopback keeps other hosts out, but neither other users of the machine, who may
// connect to any port, nor other pages of the user's own browser, which send requests to it.
//
// Naive attempt: check that the peer is 127.0.0.1. Every page of the browser is there, and a page
// whose name is made to resolve to 127.0.0.1 (DNS rebinding) even reads the answers.
//
// What is done instead, for every request, before its body is read:
//  - the path begins with a token of 128 bits of the system's chance, made for each server, which
//    is compared in constant time: who was not told the address, is refused;
//  - the Host is this server's own address, so that a rebound name is refused;
//  - an Origin, where there is one, is this server's own; Sec-Fetch-Site, where there is one, is
//    same-origin or none; a POST is of application/json, which no form sends. There is no CORS:
//    no answer allows another origin anything;
//  - only GET, HEAD and POST; heads and bodies are limited in size and time.
//
// Every answer forbids the browser to keep it, to guess its type, to show it within another page
// and to load anything from elsewhere.
//
// Availability: at most most_connections at a time. A further one displaces the oldest that has not
// shown the token; if all have, it is refused itself. A reader that does not take what it asked for
// is closed after a time, and so is one that leaves too much waiting.
//
// One thread, the one in run(): the handler is called there and must not compute for long; streams
// may be fed from any thread. Errors: std::system_error if the port cannot be had.
//
//   LocalServer server({.port = 0}, [&](const PageRequest& request) { return page(request); });
//   print(server.address());
//   server.run();   // until stop(), which a signal handler's thread may call
//
// Sources: RFC 9110, RFC 9112; W3C Fetch Metadata; OWASP on DNS rebinding.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "server/request.h"

namespace simbench::server {

struct ServerOptions {
  std::uint16_t port = 0;  // 0: a free one
  std::string token{};     // as of token_in() (guard.h); empty: a new one
  std::size_t most_connections = 64;
  std::size_t most_body_bytes = 256 * 1024;
  std::size_t most_waiting_bytes = 16 * 1024 * 1024;  // of one stream
  std::chrono::milliseconds request_time{10'000};     // for a head and body to arrive
  std::chrono::milliseconds idle_time{60'000};        // between two requests
  std::chrono::milliseconds write_time{30'000};       // for a piece of an answer to be taken
  bool stops_on_signals = false;                      // Ctrl-C and SIGTERM are stop()
};

// What a server has met, for tests and for whoever wonders.
struct ServerCounts {
  std::uint64_t answered = 0;
  std::uint64_t refused = 0;    // requests
  std::uint64_t displaced = 0;  // connections, and those refused for lack of room
};

class LocalServer {
 public:
  using Handler = std::function<PageResponse(const PageRequest&)>;

  LocalServer(ServerOptions options, Handler handler);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  // "http://127.0.0.1:40123/6f1c.../", whose secret is for the user's eyes.
  const std::string& address() const;
  std::uint16_t port() const;

  // Serves until stop(). An exception of the handler is an answer of status 500 with its text.
  void run();
  // From any thread. Streams are closed.
  void stop();
  // Calls `action` on the server's thread after a time, once; nothing after stop().
  void after(std::chrono::milliseconds delay, std::function<void()> action);

  ServerCounts counts() const;

 private:
  class Core;
  std::shared_ptr<Core> core_;
};

}  // namespace simbench::server
