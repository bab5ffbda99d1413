#include "hardware/conductor/rig_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "hardware/net/connect.h"
#include "hardware/net/notice.h"
#include "recording/counted.h"
#include "recording/version.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

// Longer than any successful protocol of the bench needs.
constexpr Nanoseconds kSyncLimit = std::chrono::minutes(10);
// Beyond the scenario's own time: delivery, start-up, a trigger that begins a little later.
constexpr Nanoseconds kCaptureSlack = std::chrono::seconds(3);
constexpr Nanoseconds kEndLimit = std::chrono::seconds(10);

// A node may be of another version: a member that its reply lacks is an error of that host.
template <class T>
T reply_member(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw ProtocolError(fmt::format("its reply has no '{}'", key));
  try {
    return found->get<T>();
  } catch (const nlohmann::json::exception&) {
    throw ProtocolError(fmt::format("its reply's '{}' has another type", key));
  }
}

// The problems of a reply on one line: "camera 018322071234: unplugged; ...".
std::string problems_in(const nlohmann::json& reply) {
  std::vector<std::string> lines;
  for (const nlohmann::json& problem : reply_member<nlohmann::json>(reply, "problems")) {
    lines.push_back(fmt::format("camera {}: {}", reply_member<std::string>(problem, "camera"),
                                reply_member<std::string>(problem, "text")));
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

std::string fresh_session_id() {
  std::string id;
  for (int i = 0; i < 16; ++i) id += "0123456789abcdef"[randombytes_uniform(16)];
  return id;
}

RigLayout layout_of(const scenarios::Scenario& scenario) {
  const double rate_hz = scenario.trigger.rate_hz;
  RigLayout layout{.hosts = static_cast<std::uint32_t>(scenario.hosts.count),
                   .cameras = {},
                   .frame_rate_hz = rate_hz,
                   .first_pulse = static_cast<std::int64_t>(
                       std::ceil(scenario.timeline.warm_up_ms * rate_hz / 1000)),
                   .pulses = scenario.timeline.frames};
  for (std::int64_t camera = 0; camera < scenario.cameras.count; ++camera) {
    layout.cameras.push_back({static_cast<std::uint32_t>(scenario.host_of(camera))});
  }
  return layout;
}

json master_role(std::size_t hosts) {
  json slaves = json::array();
  for (std::size_t host = 1; host < hosts; ++host) slaves.push_back(host);
  return {{"role", "master"}, {"slaves", std::move(slaves)}};
}

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
json slave_role() { return {{"role", "slave"}}; }
json this_session(const std::string& session) { return {{"session", session}}; }
json place_in_journal(const std::string& session, std::uint64_t offset) {
  return {{"session", session}, {"offset", offset}};
}

// Empty without a failure.
std::string message_of(const std::exception_ptr& failure) {
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

RigSession::RigSession(boost::asio::io_context& context, const Rig& rig, const SecretKey& key,
                       const scenarios::Scenario& scenario, const RecordingRequest& request,
                       const RigSourceSettings& settings)
    : context_(context),
      rig_(rig),
      scenario_(scenario),
      request_(request),
      settings_(settings),
      trigger_(context, rig.trigger, settings.prompt),
      id_(settings.collect_session.empty() ? fresh_session_id() : settings.collect_session),
      layout_(layout_of(scenario)),
      scored_(scenario.evaluation.stream) {
  hosts_.reserve(rig.hosts.size());
  for (std::size_t host = 0; host < rig.hosts.size(); ++host) {
    hosts_.push_back({NodeLink(context, rig.hosts[host], key,
                               [this, host](const NodeAnswer& notice) { on_notice(host, notice); }),
                      {.name = rig.hosts[host].name, .lost = false, .oscillator = {}},
                      {}});
  }
}

Task<void> RigSession::conduct() {
  if (request_.host_sync != nullptr &&
      request_.host_sync->initial_clocks() == InitialClocks::kMaster) {
    throw RecordingFailed("an oracle's clocks exist only in the simulator");
  }
  if (request_.capture_alignment != nullptr &&
      request_.capture_alignment->steering() == Steering::kIdeal) {
    throw RecordingFailed("an oracle's exposures exist only in the simulator");
  }
  progress(fmt::format("session {}: {}", id_, request_.pipeline));
  std::exception_ptr failure;
  try {
    co_await capture_from_start();
  } catch (const NodeError& error) {
    failure = std::make_exception_ptr(RecordingFailed(error.what()));
  } catch (const TriggerError& error) {
    failure = std::make_exception_ptr(RecordingFailed(error.what()));
  } catch (...) {
    failure = std::current_exception();
  }
  co_await end_all();
  co_await leave_trigger_off();
  if (failure) std::rethrow_exception(failure);
}

Task<void> RigSession::capture_from_start() {
  co_await must_on_all(&RigSession::greet, "greeting the nodes");
  co_await must_on_all(&RigSession::begin, "beginning a session");
  co_await must_on_all(&RigSession::prepare, "setting the cameras");
  co_await synchronise();
  progress(fmt::format("waiting {:.1f} s before the capture",
                       scenario_.timeline.wait_before_capture_ms / 1000));
  co_await wait(from_ms(scenario_.timeline.wait_before_capture_ms), [] { return false; });
  co_await capture();
}

Task<void> RigSession::collect() {
  co_await may_on_all(&RigSession::greet);
  ending_ = true;
  for (HostState& host : hosts_) host.ended = true;
  co_await may_on_all(&RigSession::fetch);
  const bool found = std::any_of(hosts_.begin(), hosts_.end(),
                                 [](const HostState& host) { return host.journal.bytes() > 0; });
  if (!found) {
    throw RecordingFailed(fmt::format("session {}: no node has a journal of it{}", id_,
                                      notes_.empty() ? "" : "; " + notes_.front()));
  }
}

Task<void> RigSession::synchronise() {
  if (request_.host_sync == nullptr) co_return;
  progress("synchronising " + counted(hosts_.size(), "host"));
  for (std::size_t host = 1; host < hosts_.size(); ++host) co_await synchronise_slave(host);
  co_await hosts_[0].link.ask("synchronise", master_role(hosts_.size()), kConductorSilence);
  const std::optional<Nanoseconds> service = request_.host_sync->warm_up();
  co_await wait(service.value_or(kSyncLimit), [this, service] {
    return sync_failure_.has_value() || hosts_[0].ended || (!service && sync_ended_);
  });
  if (sync_failure_) throw RecordingFailed("synchronisation failed: " + *sync_failure_);
  if (hosts_[0].ended) {
    throw RecordingFailed("the master was lost during synchronisation");
  }
  if (!service && !sync_ended_) {
    throw RecordingFailed(fmt::format("synchronisation had not ended after {:.0f} minutes",
                                      to_seconds(kSyncLimit) / 60));
  }
}

Task<void> RigSession::capture() {
  const bool genlock = scenario_.cameras.sync_mode == scenarios::SyncMode::kGenlock;
  const bool triggered = waits_for_trigger(scenario_.cameras.sync_mode);
  progress(fmt::format("capturing {} after {:.1f} s",
                       counted(static_cast<std::uint64_t>(scenario_.timeline.frames), "frame"),
                       scenario_.timeline.warm_up_ms / 1000));
  if (triggered) co_await trigger_.turn(!genlock);
  co_await may_on_all(&RigSession::start);
  started_ = true;
  if (genlock) co_await trigger_.turn(true);
  const double capture_s =
      (scenario_.timeline.warm_up_ms + scenario_.trigger.start_delay_ms) / 1000 +
      static_cast<double>(scenario_.timeline.frames) / layout_.frame_rate_hz;
  co_await wait(from_ms(capture_s * 1000) + kCaptureSlack,
                [this] { return all_covered() || hosts_left() == 0; });
  co_await may_on_all(&RigSession::stop);
  if (triggered) co_await trigger_.turn(false);
  if (hosts_left() == 0) throw RecordingFailed("no host was left at the end of the capture");
}

// After a failure the trigger may still be on. Who has pressed Ctrl-C is not prompted again.
Task<void> RigSession::leave_trigger_off() {
  if (!trigger_.is_on()) co_return;
  if (rig_.trigger->manual) {
    note("the trigger is still on: switch it off");
    co_return;
  }
  try {
    co_await trigger_.turn(false);
  } catch (const TriggerError& error) {
    note(error.what());
  }
}

// Ends what was begun and fetches what was recorded, also after a failure.
Task<void> RigSession::end_all() {
  ending_ = true;
  co_await may_on_all(&RigSession::end);
  const MonotonicTime deadline = monotonic_now() + kEndLimit;
  while (!all_fetched() && monotonic_now() < deadline) {
    co_await pause(context_.get_executor(), std::chrono::milliseconds(20));
  }
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    HostState& state = hosts_[host];
    if (state.begun && !state.fetched && !state.report.lost) {
      give_up(host, "the end of its journal did not come");
    }
    if (state.journal.damaged() > 0) {
      note(fmt::format("{}: {} of its journal left out", state.report.name,
                       counted(state.journal.damaged(), "damaged line")));
    }
    // The node has already reported these in notices.
    for (const std::string& line : state.journal.notes()) {
      notes_.push_back(fmt::format("{}: {}", state.report.name, line));
    }
  }
  note_missing_frames();
}

// Notes cameras that ran too short or not at all; single lost frames are in the scores.
void RigSession::note_missing_frames() {
  const bool any = std::any_of(hosts_.begin(), hosts_.end(),
                               [](const HostState& host) { return host.journal.frames() > 0; });
  if (!any && started_) {
    note("no frame arrived; is the trigger connected, at a rate that the mode allows?");
  }
  if (!any) return;
  const std::int64_t wanted = layout_.first_pulse + layout_.pulses;
  std::uint32_t camera = 0;
  for (std::size_t host = 0; host < rig_.hosts.size(); ++host) {
    for (const RigCamera& which : rig_.hosts[host].cameras) {
      const std::int64_t covered = hosts_[host].journal.covered(camera++, scored_);
      if (covered >= wanted || hosts_[host].report.lost) continue;
      const std::string what =
          covered > 0 ? fmt::format("its frames cover {} of {} periods", covered, wanted)
                      : "no frame came; is its trigger connected, at a rate that its mode allows?";
      note(fmt::format("{}: camera {}: {}", rig_.hosts[host].name, which.serial, what));
    }
  }
}

bool RigSession::all_covered() const {
  for (std::uint32_t camera = 0; camera < layout_.cameras.size(); ++camera) {
    const HostState& host = hosts_[layout_.cameras[camera].host];
    if (host.ended) continue;
    if (host.journal.covered(camera, scored_) < layout_.first_pulse + layout_.pulses) return false;
  }
  return true;
}

Task<void> RigSession::greet(std::size_t host) {
  const json hello = co_await hosts_[host].link.ask("hello", json::object(), kGreetingLimit);
  const auto name = reply_member<std::string>(hello, "name");
  if (name != rig_.hosts[host].name) {
    const RigHost& wanted = rig_.hosts[host];
    throw RecordingFailed(fmt::format("{} ({}): the node there is called {}", wanted.name,
                                      address_text(wanted.address, wanted.port), name));
  }
  const auto its_version = reply_member<std::string>(hello, "version");
  if (its_version != version()) {
    note(fmt::format("{} runs simbench {}, this is {}", name, its_version, version()));
  }
  const json clock = reply_member<json>(hello, "clock");
  hosts_[host].report.oscillator = {
      .monotonic_zero =
          MonotonicTime(Nanoseconds(reply_member<std::int64_t>(clock, "monotonic_zero_ns"))),
      .steady_zero = SteadyTime(Nanoseconds(reply_member<std::int64_t>(clock, "steady_zero_ns"))),
      .skew_ppm = reply_member<double>(clock, "skew_ppm")};
}

Task<void> RigSession::begin(std::size_t host) {
  co_await hosts_[host].link.ask(
      "begin", session_terms(id_, scenario_.resolved_json(), request_.pipeline), kConductorSilence);
  hosts_[host].begun = true;
  asio::co_spawn(context_, fetch(host), [this, host](const std::exception_ptr& failure) {
    if (failure) give_up(host, message_of(failure));
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

// Fetches a host's journal until it is closed and complete.
Task<void> RigSession::fetch(std::size_t host) {
  HostState& state = hosts_[host];
  MonotonicTime last_reply = monotonic_now();
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
      last_reply = monotonic_now();
      take_chunk(host, chunk);
      if (state.journal.bytes() < reply_member<std::uint64_t>(chunk, "size")) continue;
    } else if (failure->kind() != NodeError::Kind::kLost ||
               monotonic_now() - last_reply > kConductorSilence) {
      throw NodeError(*failure);
    }
    if (!state.fetched) co_await pause(context_.get_executor(), kFetchInterval);
  }
}

void RigSession::take_chunk(std::size_t host, const json& chunk) {
  HostState& state = hosts_[host];
  state.journal.append(reply_member<std::string>(chunk, "text"));
  const bool complete = state.journal.bytes() >= reply_member<std::uint64_t>(chunk, "size");
  if (!reply_member<bool>(chunk, "closed") || !complete) return;
  state.fetched = true;
  if (ending_ || state.ended) return;
  state.ended = true;
  note(
      fmt::format("{}: its session ended before the capture did (was the node restarted?); "
                  "its frames until then are kept",
                  state.report.name));
}

Task<std::vector<std::string>> RigSession::on_all(Step step) {
  struct Gathering {
    explicit Gathering(asio::io_context& context) : news(context.get_executor()) {}
    Notice news;
    std::size_t left = 0;
    std::vector<std::string> problems;
  };
  const auto gathering = std::make_shared<Gathering>(context_);
  gathering->problems.resize(hosts_.size());
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    if (hosts_[host].report.lost || (hosts_[host].ended && !ending_)) continue;
    ++gathering->left;
    asio::co_spawn(context_, (this->*step)(host),
                   [gathering, host](const std::exception_ptr& failure) {
                     --gathering->left;
                     gathering->news.notify();
                     gathering->problems[host] = message_of(failure);
                   });
  }
  while (gathering->left > 0) co_await gathering->news.wait(MonotonicTime::max());
  co_return std::move(gathering->problems);
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
    co_await pause(context_.get_executor(), std::min(kLookInterval, deadline - monotonic_now()));
  }
}

void RigSession::on_notice(std::size_t host, const NodeAnswer& notice) {
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
    if (text != notice.details.end() && text->is_string()) progress(text->get<std::string>());
  }
}

void RigSession::give_up(std::size_t host, const std::string& why) {
  HostState& state = hosts_[host];
  if (state.report.lost) return;
  state.report.lost = true;
  state.ended = true;
  state.fetched = true;
  note(fmt::format("{} was lost: {}; {} of it kept", state.report.name, why,
                   counted(state.journal.frames(), "frame")));
}

}  // namespace simbench::hardware
