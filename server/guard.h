// Which requests a local server answers: the rules of local_server.h, on the heads of requests.
//
//   const PageGuard guard(8080, "6f1c...");
//   if (const PageRefusal refusal = guard.judge(head)) print(refusal.status, refusal.text);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace simbench::server {

// What of a head counts; "" for a field that is not there.
struct RequestHead {
  std::string_view method;
  std::string_view target;  // "/6f1c.../look?x=1"
  std::string_view host{};
  std::string_view origin{};
  std::string_view fetch_site{};  // Sec-Fetch-Site
  std::string_view content_type{};
};

struct PageRefusal {
  unsigned status = 0;  // 0: the request is answered
  std::string text{};
  explicit operator bool() const { return status != 0; }
};

// What is below the token.
struct Target {
  std::string path;
  std::string query;
};

class PageGuard {
 public:
  PageGuard(std::uint16_t port, std::string token);

  // "http://127.0.0.1:40123/6f1c.../"
  std::string address() const;
  // Whether the target begins with the token. Its time does not depend on what differs.
  bool knows_token(std::string_view target) const;
  PageRefusal judge(const RequestHead& head) const;
  // `target` knows the token.
  Target below_token(std::string_view target) const;

 private:
  bool is_own_host(std::string_view host) const;

  std::uint16_t port_;
  std::string token_;
};

// 128 bits of the system's chance as 32 hexadecimal digits. Throws std::system_error.
std::string new_token();

// The token that a file keeps, for an address that stays the same; without a file one is made,
// which its owner alone may read. Throws std::runtime_error, "FILE: found ..., allowed ...".
std::string token_in(const std::string& path);

}  // namespace simbench::server
