#include "hardware/node/node_programs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <deque>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "hardware/net/notice.h"
#include "hardware/node/program_clock.h"
#include "processes/child.h"
#include "processes/lesser_user.h"
#include "processes/placeholders.h"
#include "processes/program_endings.h"
#include "processes/requests.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using processes::Child;
using scenarios::HostPrograms;

// Answers one program until it ends; returns how it did.
Task<processes::ProgramEnd> serve(Child& child, ProgramClock& clock) {
  if (child.link() < 0) co_return child.end_of();
  // The descriptor closes the number that it has.
  asio::posix::stream_descriptor link(co_await asio::this_coro::executor, dup(child.link()));
  std::string reason;
  while (reason.empty()) {
    co_await link.async_wait(asio::posix::stream_descriptor::wait_read, asio::use_awaitable);
    const std::optional<processes::ChildRequest> request = child.next();
    if (!request) break;
    try {
      const ProgramClock::Answer answer = clock.answer(*request);
      child.reply(answer.value, answer.error, answer.data);
    } catch (const processes::BadRequest& bad) {
      reason = bad.what();
    }
  }
  co_return child.end_of(reason);
}

SoftwareClock& software_clock(Host& host) {
  auto* found = dynamic_cast<SoftwareClock*>(&host.clock());
  if (found == nullptr) throw std::runtime_error("programs run around software clocks only");
  return *found;
}

class RunningNodePrograms {
 public:
  RunningNodePrograms(const asio::any_io_executor& executor, Host& host, std::size_t programs)
      : clock_(executor, software_clock(host)), time_is_up_(executor), endings_(host, programs) {}

  void start(Child::Settings child) {
    child.log_name = fmt::format("{}_{}.log", children_.size(), child.log_name);
    child.clock_page = clock_.page();
    children_.emplace_back(child);
  }

  // Until it is cancelled.
  Task<void> run(std::optional<Nanoseconds> duration) {
    begin_ = monotonic_now();
    std::vector<Task<void>> tasks;
    tasks.push_back(clock_.run());
    for (Child& child : children_) tasks.push_back(watch(child));
    if (duration) tasks.push_back(stop_after(*duration));
    co_await join_all(std::move(tasks));
  }

 private:
  Task<void> watch(Child& child) {
    processes::ProgramEnd end = co_await serve(child, clock_);
    if (has_ended_) co_return;
    endings_.add(std::move(end), {.at = monotonic_now() - begin_}, clock_.was_steered());
  }

  Task<void> stop_after(Nanoseconds duration) {
    time_is_up_.expires_at(for_timer(monotonic_now() + duration));
    co_await ended(time_is_up_);
    has_ended_ = true;
    for (Child& child : children_) child.ending();
  }

  ProgramClock clock_;
  asio::steady_timer time_is_up_;
  std::deque<Child> children_;
  processes::ProgramEndings endings_;
  MonotonicTime begin_{};
  bool has_ended_ = false;  // the time is up: what ends now is ended
};

}  // namespace

NodePrograms::NodePrograms(NodeProgramSettings settings) : settings_(std::move(settings)) {}

std::optional<Nanoseconds> NodePrograms::warm_up() const {
  return from_ms(1e3 * settings_.programs.run_before_capture_s);
}

std::string NodePrograms::make_folder(PeerId host) const {
  std::filesystem::path folder = settings_.log_folder.empty()
                                     ? std::filesystem::path(temporary_.path())
                                     : std::filesystem::absolute(settings_.log_folder);
  processes::let_pass(temporary_.path());
  folder /= fmt::format("host{}", host);
  return processes::make_folder(
      folder, settings_.programs,
      {.host = host, .interface = settings_.interface.c_str(), .files = folder.string()});
}

Task<void> NodePrograms::run(Host& host, std::vector<HostPrograms::Command> commands) {
  RunningNodePrograms programs(co_await asio::this_coro::executor, host, commands.size());
  const std::string folder = make_folder(host.id());
  const processes::HostPlaces places{
      .host = host.id(), .interface = settings_.interface.c_str(), .files = folder};
  std::vector<Child::Settings> children;
  for (const HostPrograms::Command& command : commands) {
    const auto path = settings_.paths.find(command.front());
    children.push_back({.command = processes::fill(command, places),
                        .program = path == settings_.paths.end() ? "" : path->second,
                        .environment = processes::fill(settings_.programs.environment, places),
                        .folder = folder,
                        .log_name = scenarios::program_name(command),
                        .shim = settings_.shim,
                        .readable = processes::fill(settings_.programs.readable, places),
                        .served = processes::Served::kClock});
  }
  processes::agree_on_user(children);
  for (Child::Settings& child : children) programs.start(std::move(child));
  std::optional<Nanoseconds> duration;
  if (!settings_.programs.run_during_capture) duration = warm_up();
  co_await programs.run(duration);
}

Task<void> NodePrograms::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  return run(host, settings_.programs.master);
}

Task<void> NodePrograms::run_slave(Host& host, PeerId /*master*/) {
  return run(host, settings_.programs.slave);
}

}  // namespace simbench::hardware
