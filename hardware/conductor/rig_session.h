// One session on a rig, step by step, as a coroutine. RigSource runs the context and rethrows the
// coroutine's exception. One thread.
#pragma once

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hardware/conductor/journals.h"
#include "hardware/conductor/node_link.h"
#include "hardware/conductor/rig_source.h"
#include "hardware/conductor/trigger_switch.h"
#include "hardware/net/secret_key.h"
#include "hardware/rig/rig.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

class RigSession {
 public:
  // All arguments outlive the session, which outlives its coroutines.
  RigSession(boost::asio::io_context& context, const Rig& rig, const SecretKey& key,
             const scenarios::Scenario& scenario, const RecordingRequest& request,
             const RigSourceSettings& settings);

  // Runs a new session from greeting to the last journal. Throws RecordingFailed, or
  // std::runtime_error ("interrupted"), after ending what was begun.
  Task<void> conduct();
  // Fetches the journals of an earlier session.
  Task<void> collect();

  const std::string& id() const { return id_; }
  const RigLayout& layout() const { return layout_; }
  const std::vector<std::string>& notes() const { return notes_; }
  std::vector<HostReport> reports() const {
    std::vector<HostReport> reports;
    for (const HostState& host : hosts_) reports.push_back(host.report);
    return reports;
  }
  std::vector<HostJournal> take_journals() {
    std::vector<HostJournal> journals;
    for (HostState& host : hosts_) journals.push_back(std::move(host.journal));
    return journals;
  }

 private:
  struct HostState {
    NodeLink link;
    HostReport report;
    HostJournal journal;
    bool begun = false;
    bool ended = false;    // its session is over; the journal may still come
    bool fetched = false;  // all of its journal is here, or given up
  };
  using Step = Task<void> (RigSession::*)(std::size_t host);

  Task<void> capture_from_start();
  Task<void> end_all();

  // The steps on one host.
  Task<void> greet(std::size_t host);
  Task<void> begin(std::size_t host);
  Task<void> prepare(std::size_t host);
  Task<void> start(std::size_t host);
  Task<void> stop(std::size_t host);
  Task<void> end(std::size_t host);
  Task<void> synchronise_slave(std::size_t host);
  Task<void> fetch(std::size_t host);
  void take_chunk(std::size_t host, const nlohmann::json& chunk);

  Task<void> synchronise();
  Task<void> capture();
  Task<void> leave_trigger_off();
  // Runs the step on all remaining hosts at the same time; returns their errors, by host.
  Task<std::vector<std::string>> on_all(Step step);
  // on_all(); throws RecordingFailed if any failed.
  Task<void> must_on_all(Step step, std::string doing);
  // on_all(); gives up hosts that failed.
  Task<void> may_on_all(Step step);
  // Waits until `is_over`, at most `limit`. Throws if the user has cancelled.
  Task<void> wait(Nanoseconds limit, std::function<bool()> is_over);

  void on_notice(std::size_t host, const NodeAnswer& notice);
  void give_up(std::size_t host, const std::string& why);
  void note(std::string line) {
    progress(line);
    notes_.push_back(std::move(line));
  }
  void progress(const std::string& line) const {
    if (settings_.progress) settings_.progress(line);
  }
  void note_missing_frames();
  bool all_covered() const;
  bool all_fetched() const {
    return std::all_of(hosts_.begin(), hosts_.end(),
                       [](const HostState& host) { return host.fetched || !host.begun; });
  }
  std::size_t hosts_left() const {
    return static_cast<std::size_t>(std::count_if(
        hosts_.begin(), hosts_.end(), [](const HostState& host) { return !host.ended; }));
  }

  boost::asio::io_context& context_;
  const Rig& rig_;
  const scenarios::Scenario& scenario_;
  const RecordingRequest& request_;
  const RigSourceSettings& settings_;
  TriggerSwitch trigger_;
  std::string id_;
  RigLayout layout_;
  StreamKind scored_;
  std::vector<HostState> hosts_;
  std::vector<std::string> notes_;
  bool sync_ended_ = false;  // the master's
  std::optional<std::string> sync_failure_;
  bool started_ = false;  // the cameras
  bool ending_ = false;
};

}  // namespace simbench::hardware
