#include "server/guard.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace simbench::server {
namespace {

constexpr const char* kTokenText =
    "the address lacks the token that simbench printed with it; open the whole address";

bool begins_with_json(std::string_view type) {
  constexpr std::string_view kJson = "application/json";
  if (!type.starts_with(kJson)) return false;
  return type.size() == kJson.size() || type[kJson.size()] == ';' || type[kJson.size()] == ' ';
}

}  // namespace

PageGuard::PageGuard(std::uint16_t port, std::string token)
    : port_(port), token_(std::move(token)) {}

std::string PageGuard::address() const {
  return fmt::format("http://127.0.0.1:{}/{}/", port_, token_);
}

bool PageGuard::knows_token(std::string_view target) const {
  const std::string whole = '/' + token_ + '/';
  if (target.size() < whole.size()) return false;
  unsigned differs = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    differs |= static_cast<unsigned char>(whole[i]) ^ static_cast<unsigned char>(target[i]);
  }
  return differs == 0;
}

bool PageGuard::is_own_host(std::string_view host) const {
  return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
}

PageRefusal PageGuard::judge(const RequestHead& head) const {
  if (!is_own_host(head.host)) {
    return {421, "this server is http://127.0.0.1 alone, by no other name"};
  }
  if (!knows_token(head.target)) return {403, kTokenText};
  if (!head.origin.empty()) {
    constexpr std::string_view kScheme = "http://";
    if (!head.origin.starts_with(kScheme) || !is_own_host(head.origin.substr(kScheme.size()))) {
      return {403, "requests of other pages are refused"};
    }
  }
  if (!head.fetch_site.empty() && head.fetch_site != "same-origin" && head.fetch_site != "none") {
    return {403, "requests of other pages are refused"};
  }
  if (head.method != "GET" && head.method != "HEAD" && head.method != "POST") {
    return {405, "allowed: GET, HEAD and POST"};
  }
  if (head.method == "POST" && !begins_with_json(head.content_type)) {
    return {415, "allowed for POST: application/json"};
  }
  return {};
}

Target PageGuard::below_token(std::string_view target) const {
  std::string_view rest = target.substr(token_.size() + 2);
  const std::size_t mark = rest.find('?');
  if (mark == std::string_view::npos) return {std::string(rest), ""};
  return {std::string(rest.substr(0, mark)), std::string(rest.substr(mark + 1))};
}

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::system_error(errno, std::generic_category(), "getrandom");
  }
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

std::string token_in(const std::string& path) {
  const int made = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (made >= 0) {
    std::string token = new_token();
    const ssize_t written = write(made, token.data(), token.size());
    close(made);
    if (written == static_cast<ssize_t>(token.size())) return token;
    throw std::runtime_error(path + ": the token cannot be written");
  }
  struct stat found = {};
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || fstat(file, &found) != 0) {
    if (file >= 0) close(file);
    throw std::runtime_error(
        fmt::format("{}: cannot be read: {}", path, std::generic_category().message(errno)));
  }
  std::string token(64, '\0');
  const ssize_t got = read(file, token.data(), token.size());
  close(file);
  token.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  while (token.ends_with('\n')) token.pop_back();
  if ((found.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw std::runtime_error(path + ": found a file that others may read, allowed: chmod 600");
  }
  if (token.size() != 32 || token.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw std::runtime_error(path + ": found no token, allowed: 32 hexadecimal digits, or no file");
  }
  return token;
}

}  // namespace simbench::server
