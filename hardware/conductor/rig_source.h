// A real rig as a backend: conducts its nodes through a capture and hands over what they recorded.
//
// One call of record() is one session on the rig:
//
//   1. every node is greeted and the session begun (session ids are fresh, so a lost one never
//   mixes)
//   2. cameras are opened and set; what they refuse is a note, or ends it if none is left
//   3. the scenario's host_sync of the pipeline runs, master and slaves, for real
//   4. the scenario's wait, then the capture in its sync mode: genlock: trigger off, cameras on,
//      trigger on; other triggered modes: trigger on, cameras on; free-running: cameras on
//   5. journals are fetched while it runs, the cameras stopped when the scenario's time is over,
//   the
//      rest fetched, and all of it told to the sink in order of arrival
//
// Failures (a node that is killed, a cable that is pulled, another conductor, another version) cost
// what they must: a host that is lost for kConductorSilence is given up for this session, with a
// note, and what was fetched from it is kept. With no host left, or without the master, record()
// throws RecordingFailed. Nothing waits without a limit.
//
// There is no truth: the sink gets frames without it. `progress` is told each step, a line each.
// Request: `pipeline` names the one to run; its host_sync object is only asked for its kind
// (warm_up(), initial_clocks()), the nodes make their own. An oracle's clocks (kMaster) cannot be
// had and fail.
//
//   RigSource source(rig, key, scenario, settings);
//   source.record({.seed = 1, .pipeline = "yoon2021_both", .host_sync = sync.get()}, sink);
#ifndef SIMBENCH_HARDWARE_CONDUCTOR_RIG_SOURCE_H_
#define SIMBENCH_HARDWARE_CONDUCTOR_RIG_SOURCE_H_

#include <functional>
#include <string>
#include <vector>

#include "hardware/clock/node_clock.h"
#include "hardware/net/secret_key.h"
#include "hardware/rig/rig.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

struct RigSourceSettings {
  std::function<void(const std::string& line)> progress;  // may be empty
  // For "manual" triggers: shows the text and returns when the user has done it; false: given up.
  std::function<bool(const std::string& text)> prompt;
  // Looked at every 50 ms; once true, cameras are stopped and record() throws. May be empty.
  std::function<bool()> cancelled;
  // Instead of a new session, fetches what the nodes' journals have of this one (record()'s step
  // 5), after a conductor was killed. Empty: a new session.
  std::string collect_session;
};

// What is known of a host after a session.
struct HostReport {
  std::string name;
  bool lost = false;
  NodeOscillator oscillator;  // of its steady clock against its kernel's monotonic clock
};

class RigSource final : public RecordingSource {
 public:
  // `scenario` outlives this. Throws scenarios::InputError if the rig does not fit the scenario.
  RigSource(Rig rig, SecretKey key, const scenarios::Scenario& scenario,
            RigSourceSettings settings);

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override;

  // Of the last session.
  const std::vector<HostReport>& hosts() const { return hosts_; }
  const std::string& session() const { return session_; }

 private:
  Rig rig_;
  SecretKey key_;
  const scenarios::Scenario& scenario_;
  RigSourceSettings settings_;
  std::vector<HostReport> hosts_;
  std::string session_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CONDUCTOR_RIG_SOURCE_H_
