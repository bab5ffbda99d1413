// What a session asks of single hosts, and of all at the same time.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstdlib>
#include <exception>
#include <map>
#include <memory>
#include <utility>

#include "hardware/conductor/rig_session.h"
#include "recording/version.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

constexpr Nanoseconds kGreetingLimit = std::chrono::seconds(3);
constexpr Nanoseconds kReadLimit = std::chrono::seconds(2);
// Opening and setting cameras takes its time on a real host.
constexpr Nanoseconds kCameraLimit = std::chrono::seconds(60);
constexpr Nanoseconds kFetchInterval = std::chrono::milliseconds(250);
constexpr Nanoseconds kLookInterval = std::chrono::milliseconds(50);

std::string conductor_name() {
  std::array<char, 256> machine{};
  gethostname(machine.data(), machine.size() - 1);
  const char* user = std::getenv("USER");
  return fmt::format("{}@{} (process {})", user != nullptr ? user : "someone", machine.data(),
                     getpid());
}

// Arguments of requests. (g++ 12 takes no braced lists of lists inside a coroutine.)
json session_terms(const std::string& session, const std::string& scenario,
                   const std::string& pipeline) {
  return {{"session", session},
          {"conductor", conductor_name()},
          {"scenario", scenario},
          {"pipeline", pipeline}};
}
json slave_role() { return {{"role", "slave"}, {"master", 0}}; }
json this_session(const std::string& session) { return {{"session", session}}; }
json place_in_journal(const std::string& session, std::uint64_t offset) {
  return {{"session", session}, {"offset", offset}};
}

// Nodes are trusted, but not to be of the same mind: what a reply lacks is an error of that host.
template <class T>
T member(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw ProtocolError(fmt::format("its reply has no '{}'", key));
  try {
    return found->get<T>();
  } catch (const json::exception&) {
    throw ProtocolError(fmt::format("its reply's '{}' is of another type", key));
  }
}

// "018322071234: unplugged; ..." of a reply's problems.
std::string problems_in(const json& reply) {
  std::vector<std::string> lines;
  for (const json& problem : member<json>(reply, "problems")) {
    lines.push_back(fmt::format("camera {}: {}", member<std::string>(problem, "camera"),
                                member<std::string>(problem, "text")));
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace

Task<void> RigSession::greet(std::size_t host) {
  const json hello = co_await hosts_[host].link.ask("hello", json::object(), kGreetingLimit);
  const auto name = member<std::string>(hello, "name");
  if (name != rig_.hosts[host].name) {
    throw RecordingFailed(fmt::format("{} ({}:{}): the node there is called {}",
                                      rig_.hosts[host].name, rig_.hosts[host].address,
                                      rig_.hosts[host].port, name));
  }
  const auto its_version = member<std::string>(hello, "version");
  if (its_version != version()) {
    note(fmt::format("{} runs simbench {}, this is {}", name, its_version, version()));
  }
  const json clock = member<json>(hello, "clock");
  hosts_[host].report.oscillator = {
      .monotonic_zero =
          MonotonicTime(Nanoseconds(member<std::int64_t>(clock, "monotonic_zero_ns"))),
      .steady_zero = SteadyTime(Nanoseconds(member<std::int64_t>(clock, "steady_zero_ns"))),
      .skew_ppm = member<double>(clock, "skew_ppm")};
}

Task<void> RigSession::begin(std::size_t host) {
  co_await hosts_[host].link.ask(
      "begin", session_terms(id_, scenario_.resolved_json, request_.pipeline), kConductorSilence);
  hosts_[host].begun = true;
  asio::co_spawn(context_, fetch(host), [this, host](const std::exception_ptr& failure) {
    if (!failure) return;
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      give_up(host, error.what());
    }
  });
}

Task<void> RigSession::prepare(std::size_t host) {
  const json reply = co_await hosts_[host].link.ask("prepare", json::object(), kCameraLimit);
  const std::string problems = problems_in(reply);
  if (!problems.empty()) {
    throw RecordingFailed(fmt::format("{}: {}", hosts_[host].report.name, problems));
  }
}

Task<void> RigSession::start(std::size_t host) {
  const json reply = co_await hosts_[host].link.ask("start", json::object(), kCameraLimit);
  const std::string problems = problems_in(reply);
  if (!problems.empty()) note(fmt::format("{}: {}", hosts_[host].report.name, problems));
}

Task<void> RigSession::stop(std::size_t host) {
  co_await hosts_[host].link.ask("stop", json::object(), kCameraLimit);
}

Task<void> RigSession::end(std::size_t host) {
  if (!hosts_[host].begun || hosts_[host].ended) co_return;
  co_await hosts_[host].link.ask("end", this_session(id_), kConductorSilence);
  hosts_[host].ended = true;
}

Task<void> RigSession::synchronise_slave(std::size_t host) {
  if (hosts_[host].ended) co_return;
  std::string problem;
  try {
    co_await hosts_[host].link.ask("synchronise", slave_role(), kConductorSilence);
  } catch (const NodeError& error) {
    problem = error.what();
  }
  if (!problem.empty()) give_up(host, problem);
}

// Follows a host's journal until it is closed and all of it is here.
Task<void> RigSession::fetch(std::size_t host) {
  HostState& state = hosts_[host];
  MonotonicTime heard = monotonic_now();
  while (!state.fetched) {
    std::optional<NodeError> failure;
    json chunk;
    try {
      chunk =
          co_await state.link.ask("read", place_in_journal(id_, state.journal.bytes()), kReadLimit);
    } catch (const NodeError& error) {
      failure = error;
    }
    if (!failure) {
      heard = monotonic_now();
      take_chunk(host, chunk);
      if (state.journal.bytes() < member<std::uint64_t>(chunk, "size")) continue;
    } else if (failure->kind() != NodeError::Kind::kLost ||
               monotonic_now() - heard > kConductorSilence) {
      throw NodeError(*failure);
    }
    if (!state.fetched) co_await pause(kFetchInterval);
  }
}

void RigSession::take_chunk(std::size_t host, const json& chunk) {
  HostState& state = hosts_[host];
  state.journal.append(member<std::string>(chunk, "text"));
  const bool complete = state.journal.bytes() >= member<std::uint64_t>(chunk, "size");
  if (!member<bool>(chunk, "closed") || !complete) return;
  state.fetched = true;
  if (ending_ || state.ended) return;
  state.ended = true;
  note(
      fmt::format("{}: its session ended before the capture did (was the node restarted?); "
                  "what it had recorded is here",
                  state.report.name));
}

Task<std::vector<std::string>> RigSession::on_all(Step step) {
  struct Gathering {
    explicit Gathering(asio::io_context& context) : news(context) {}
    asio::steady_timer news;
    std::size_t left = 0;
    std::map<std::size_t, std::string> problems;
  };
  const auto gathering = std::make_shared<Gathering>(context_);
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    if (hosts_[host].report.lost || (hosts_[host].ended && !ending_)) continue;
    ++gathering->left;
    asio::co_spawn(context_, (this->*step)(host),
                   [gathering, host](const std::exception_ptr& failure) {
                     --gathering->left;
                     gathering->news.cancel();
                     if (!failure) return;
                     try {
                       std::rethrow_exception(failure);
                     } catch (const std::exception& error) {
                       gathering->problems[host] = error.what();
                     }
                   });
  }
  while (gathering->left > 0) {
    gathering->news.expires_after(std::chrono::hours(1));
    boost::system::error_code ignored;
    co_await gathering->news.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }
  std::vector<std::string> problems(hosts_.size());
  for (const auto& [host, problem] : gathering->problems) problems[host] = problem;
  co_return problems;
}

Task<void> RigSession::must_on_all(Step step, std::string doing) {
  std::vector<std::string> problems = co_await on_all(step);
  std::erase(problems, "");
  if (problems.empty()) co_return;
  throw RecordingFailed(fmt::format("{}: {}", doing, fmt::join(problems, "; ")));
}

Task<void> RigSession::may_on_all(Step step) {
  const std::vector<std::string> problems = co_await on_all(step);
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    if (!problems[host].empty()) give_up(host, problems[host]);
  }
}

Task<void> RigSession::wait(Nanoseconds limit, std::function<bool()> is_over) {
  const MonotonicTime deadline = monotonic_now() + limit;
  while (!is_over() && monotonic_now() < deadline) {
    if (settings_.cancelled && settings_.cancelled()) throw std::runtime_error("interrupted");
    co_await pause(std::min(kLookInterval, deadline - monotonic_now()));
  }
}

Task<void> RigSession::pause(Nanoseconds interval) {
  asio::steady_timer timer(context_, interval);
  boost::system::error_code ignored;
  co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
}

void RigSession::on_notice(std::size_t host, const Answer& notice) {
  if (notice.notice == "synchronised") {
    const auto error = notice.details.find("error");
    const bool failed = error != notice.details.end() && error->is_string();
    if (failed) {
      const std::string line =
          fmt::format("{}: {}", hosts_[host].report.name, error->get<std::string>());
      if (host == 0) sync_failure_ = line;
      if (host != 0) note(line);
    }
    if (host == 0) sync_ended_ = true;
  } else if (notice.notice == "note") {
    const auto text = notice.details.find("text");
    if (text != notice.details.end() && text->is_string()) tell(text->get<std::string>());
  }
}

void RigSession::give_up(std::size_t host, const std::string& why) {
  HostState& state = hosts_[host];
  if (state.report.lost) return;
  state.report.lost = true;
  state.ended = true;
  state.fetched = true;
  note(fmt::format("{} was lost: {}; {} frames of it are kept", state.report.name, why,
                   state.journal.frames()));
}

void RigSession::note(std::string line) {
  tell(line);
  notes_.push_back(std::move(line));
}

void RigSession::tell(const std::string& line) const {
  if (settings_.progress) settings_.progress(line);
}

}  // namespace simbench::hardware
