#include "hardware/conductor/rig_session.h"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "algorithms/ports/host_sync.h"

namespace simbench::hardware {
namespace {

// Longer than any protocol of the bench needs that gets anywhere.
constexpr Nanoseconds kSyncLimit = std::chrono::minutes(10);
// Beyond the scenario's own time: delivery, starting up, and a trigger that begins a little later.
constexpr Nanoseconds kCaptureSlack = std::chrono::seconds(3);
constexpr Nanoseconds kEndLimit = std::chrono::seconds(10);

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

nlohmann::json master_role(std::size_t hosts) {
  nlohmann::json slaves = nlohmann::json::array();
  for (std::size_t host = 1; host < hosts; ++host) slaves.push_back(host);
  return {{"role", "master"}, {"slaves", std::move(slaves)}};
}

bool is_triggered(const scenarios::Scenario& scenario) {
  const std::string& mode = scenario.cameras.sync_mode;
  return mode == "genlock" || mode == "slave" || mode == "full_slave";
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
      scored_(scenario.evaluation.stream == "colour" ? StreamKind::kColour : StreamKind::kDepth) {
  hosts_.reserve(rig.hosts.size());
  for (std::size_t host = 0; host < rig.hosts.size(); ++host) {
    hosts_.push_back({NodeLink(context, rig.hosts[host], key,
                               [this, host](const Answer& notice) { on_notice(host, notice); }),
                      {.name = rig.hosts[host].name, .lost = false, .oscillator = {}},
                      {}});
  }
}

Task<void> RigSession::conduct() {
  if (request_.host_sync != nullptr &&
      request_.host_sync->initial_clocks() == InitialClocks::kMaster) {
    throw RecordingFailed("an oracle's clocks exist in the simulator only");
  }
  tell(fmt::format("session {}: {}", id_, request_.pipeline));
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
  if (failure) std::rethrow_exception(failure);
}

Task<void> RigSession::capture_from_start() {
  co_await must_on_all(&RigSession::greet, "greeting the nodes");
  co_await must_on_all(&RigSession::begin, "beginning a session");
  co_await must_on_all(&RigSession::prepare, "setting the cameras");
  co_await synchronise();
  tell(fmt::format("waiting {:.1f} s before the capture",
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
  tell(fmt::format("synchronising {} hosts", hosts_.size()));
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
  const bool genlock = scenario_.cameras.sync_mode == "genlock";
  const bool triggered = is_triggered(scenario_);
  tell(fmt::format("capturing {} frames after {:.1f} s", scenario_.timeline.frames,
                   scenario_.timeline.warm_up_ms / 1000));
  if (triggered) co_await trigger_.turn(!genlock);
  co_await may_on_all(&RigSession::start);
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

// Also after a failure: whatever was begun is ended, and what was recorded is fetched.
Task<void> RigSession::end_all() {
  ending_ = true;
  co_await may_on_all(&RigSession::end);
  const MonotonicTime deadline = monotonic_now() + kEndLimit;
  while (!all_fetched() && monotonic_now() < deadline) {
    co_await pause(std::chrono::milliseconds(20));
  }
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    HostState& state = hosts_[host];
    if (state.begun && !state.fetched && !state.report.lost) {
      give_up(host, "the end of its journal did not come");
    }
    if (state.journal.damaged() > 0) {
      note(fmt::format("{}: {} damaged lines of its journal were left out", state.report.name,
                       state.journal.damaged()));
    }
    // The node has told these already, when it wrote them.
    for (const std::string& line : state.journal.notes()) {
      notes_.push_back(fmt::format("{}: {}", state.report.name, line));
    }
  }
  note_missing_frames();
}

// Cameras that were on too short or not at all; single lost frames are in the scores.
void RigSession::note_missing_frames() {
  const bool any = std::any_of(hosts_.begin(), hosts_.end(),
                               [](const HostState& host) { return host.journal.frames() > 0; });
  if (!any) return;
  const std::int64_t wanted = layout_.first_pulse + layout_.pulses;
  std::uint32_t camera = 0;
  for (std::size_t host = 0; host < rig_.hosts.size(); ++host) {
    for (const RigCamera& which : rig_.hosts[host].cameras) {
      const std::int64_t covered = hosts_[host].journal.covered(camera++, scored_);
      if (covered >= wanted || hosts_[host].report.lost) continue;
      const std::string what =
          covered > 0 ? fmt::format("its frames cover {} of {} periods", covered, wanted)
                      : "no frame came; is its trigger connected, at a rate that its mode takes?";
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

bool RigSession::all_fetched() const {
  return std::all_of(hosts_.begin(), hosts_.end(),
                     [](const HostState& host) { return host.fetched || !host.begun; });
}

std::size_t RigSession::hosts_left() const {
  return static_cast<std::size_t>(std::count_if(hosts_.begin(), hosts_.end(),
                                                [](const HostState& host) { return !host.ended; }));
}

std::vector<HostReport> RigSession::reports() const {
  std::vector<HostReport> reports;
  for (const HostState& host : hosts_) reports.push_back(host.report);
  return reports;
}

std::vector<HostJournal> RigSession::take_journals() {
  std::vector<HostJournal> journals;
  for (HostState& host : hosts_) journals.push_back(std::move(host.journal));
  return journals;
}

}  // namespace simbench::hardware
