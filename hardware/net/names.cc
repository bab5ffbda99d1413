#include "hardware/net/names.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/readable_pipe.hpp>
#include <csignal>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "hardware/net/notice.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::address;
using boost::system::error_code;

constexpr std::size_t kMostText = 65536;  // of an answer

[[noreturn]] void not_found(const std::string& name, std::string_view why) {
  throw StreamError(StreamError::Kind::kUnreachable, fmt::format("{}: {}", name, why));
}

// A search, shared with its handler, which may outlive it.
struct Search {
  explicit Search(const boost::asio::any_io_executor& executor) : done(executor) {}
  std::optional<error_code> result;
  Notice done;

  void finish(const error_code& error) {
    result = error;
    done.notify();
  }
};

// False at the deadline.
Task<bool> search_ends(std::shared_ptr<Search> search, MonotonicTime deadline) {
  while (!search->result) {
    const bool in_time = co_await search->done.wait(deadline);
    if (!in_time && !search->result) co_return false;
  }
  co_return true;
}

// A run of `getent ahosts NAME`, ended with this object.
class Getent : public Search {
 public:
  Getent(const boost::asio::any_io_executor& executor, const std::string& name)
      : Search(executor), output_(executor) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) not_found(name, std::strerror(errno));
    const int error = start(name, ends[1]);
    close(ends[1]);
    output_.assign(ends[0]);
    if (error == ENOENT) {
      not_found(name, "found no program getent, which finds names; write its address");
    }
    if (error != 0) not_found(name, fmt::format("getent: {}", std::strerror(error)));
  }
  ~Getent() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Getent(const Getent&) = delete;
  Getent& operator=(const Getent&) = delete;

  static void read(const std::shared_ptr<Getent>& search) {
    boost::asio::async_read(
        search->output_, boost::asio::dynamic_buffer(search->text_, kMostText),
        [search](const error_code& error, std::size_t) { search->finish(error); });
  }
  void stop() {
    error_code ignored;
    output_.close(ignored);
  }
  const std::string& text() const { return text_; }

 private:
  // An errno.
  int start(const std::string& name, int output) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::string words[] = {"getent", "ahosts", name};
    char* const arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
    const int error = posix_spawnp(&process_, "getent", &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return error;
  }

  boost::asio::readable_pipe output_;
  pid_t process_ = -1;
  std::string text_;
};

// Ends the search, also when the waiting coroutine is cancelled.
struct GetentEnding {
  std::shared_ptr<Getent> search;
  ~GetentEnding() { search->stop(); }
};

#ifndef SIMBENCH_PORTABLE
using boost::asio::ip::tcp;

struct LibcSearch : Search {
  explicit LibcSearch(const boost::asio::any_io_executor& executor)
      : Search(executor), resolver(executor) {}
  tcp::resolver resolver;
  std::vector<address> addresses;
};

struct LibcEnding {
  std::shared_ptr<LibcSearch> search;
  ~LibcEnding() { search->resolver.cancel(); }
};

Task<std::vector<address>> addresses_by_libc(boost::asio::any_io_executor executor,
                                             std::string name, MonotonicTime deadline) {
  const auto search = std::make_shared<LibcSearch>(executor);
  const LibcEnding ending{search};
  search->resolver.async_resolve(
      name, "", [search](const error_code& error, const tcp::resolver::results_type& results) {
        for (const auto& entry : results) {
          const address found = entry.endpoint().address();
          if (std::ranges::count(search->addresses, found) == 0) search->addresses.push_back(found);
        }
        search->finish(error);
      });
  const bool in_time = co_await search_ends(search, deadline);
  if (!in_time) not_found(name, "found no answer in time");
  if (*search->result) not_found(name, "found no such name: " + search->result->message());
  co_return search->addresses;
}
#endif

}  // namespace

std::vector<address> addresses_in(std::string_view printed) {
  std::vector<address> addresses;
  while (!printed.empty()) {
    const std::string_view line = printed.substr(0, printed.find('\n'));
    printed.remove_prefix(std::min(printed.size(), line.size() + 1));
    error_code no_address;
    const std::string word(line.substr(0, line.find_first_of(" \t")));
    const address found = boost::asio::ip::make_address(word, no_address);
    if (!no_address && std::ranges::count(addresses, found) == 0) addresses.push_back(found);
  }
  return addresses;
}

Task<std::vector<address>> addresses_by_getent(boost::asio::any_io_executor executor,
                                               std::string name, MonotonicTime deadline) {
  constexpr const char* kNoName = "found no such name";
  if (name.empty() || name.front() == '-') not_found(name, kNoName);
  const auto search = std::make_shared<Getent>(executor, name);
  const GetentEnding ending{search};
  Getent::read(search);
  const bool in_time = co_await search_ends(search, deadline);
  if (!in_time) not_found(name, "found no answer in time");
  std::vector<address> addresses = addresses_in(search->text());
  if (addresses.empty()) not_found(name, kNoName);
  co_return addresses;
}

Task<std::vector<address>> addresses_of(boost::asio::any_io_executor executor, std::string name,
                                        MonotonicTime deadline) {
  error_code no_number;
  const address number = boost::asio::ip::make_address(name, no_number);
  if (!no_number) co_return std::vector{number};
#ifdef SIMBENCH_PORTABLE
  co_return co_await addresses_by_getent(executor, name, deadline);
#else
  co_return co_await addresses_by_libc(executor, name, deadline);
#endif
}

}  // namespace simbench::hardware
