// One session on a rig, step by step, as a coroutine; see conductor/rig_source.h.
//
// Used by RigSource, which runs the context and throws what the coroutine threw. One thread.
#ifndef SIMBENCH_HARDWARE_CONDUCTOR_RIG_SESSION_H_
#define SIMBENCH_HARDWARE_CONDUCTOR_RIG_SESSION_H_

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hardware/conductor/journals.h"
#include "hardware/conductor/node_link.h"
#include "hardware/conductor/rig_source.h"
#include "hardware/conductor/trigger_switch.h"

namespace simbench::hardware {

class RigSession {
 public:
  // Everything referred to outlives the session, which outlives its coroutines.
  RigSession(boost::asio::io_context& context, const Rig& rig, const SecretKey& key,
             const scenarios::Scenario& scenario, const RecordingRequest& request,
             const RigSourceSettings& settings);

  // A new session from greeting to the last journal. Throws RecordingFailed, or std::runtime_error
  // ("interrupted"); what was begun is ended then too.
  Task<void> conduct();
  // Fetches the journals of an earlier one.
  Task<void> collect();

  const std::string& id() const { return id_; }
  const RigLayout& layout() const { return layout_; }
  const std::vector<std::string>& notes() const { return notes_; }
  std::vector<HostReport> reports() const;
  std::vector<HostJournal> take_journals();

 private:
  struct HostState {
    NodeLink link;
    HostReport report;
    HostJournal journal;
    bool begun = false;
    bool ended = false;    // its session is over, whoever ended it; the journal may still come
    bool fetched = false;  // all of its journal is here, or never will be
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
  // The same step on all hosts that are left, at the same time; what they threw, by host.
  Task<std::vector<std::string>> on_all(Step step);
  // on_all(), and RecordingFailed if any failed.
  Task<void> must_on_all(Step step, std::string doing);
  // on_all(); those that failed are given up.
  Task<void> may_on_all(Step step);
  // Until `is_over`, at most `limit`. Throws if the user has cancelled.
  Task<void> wait(Nanoseconds limit, std::function<bool()> is_over);
  Task<void> pause(Nanoseconds interval);

  void on_notice(std::size_t host, const Answer& notice);
  void give_up(std::size_t host, const std::string& why);
  void note(std::string line);
  void progress(const std::string& line) const;
  void note_missing_frames();
  bool all_covered() const;
  bool all_fetched() const;
  std::size_t hosts_left() const;

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
  bool ending_ = false;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CONDUCTOR_RIG_SESSION_H_
