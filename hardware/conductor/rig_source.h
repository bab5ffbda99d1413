// A real rig as a backend: conducts its nodes through a capture and hands over their recordings.
//
// One call of record() is one session on the rig:
//
//   1. greet every node and begin the session (session ids are fresh, so no two sessions mix)
//   2. open and set the cameras
//   3. run the pipeline's host_sync, master and slaves, for real
//   4. wait as the scenario says, then capture in its sync mode: genlock: trigger off, cameras on,
//      trigger on; other triggered modes: trigger on, cameras on; free-running: cameras on; the
//      nodes run the pipeline's capture_alignment, if it has one, while their cameras run
//   5. fetch the journals meanwhile; stop the cameras when the scenario's time is over, fetch the
//      rest, and hand all events to the sink in order of arrival
//
// Steps 1 and 2 need every host and every camera: a node that is not there or refuses, or a camera
// that does or cannot be steered, throws RecordingFailed. After that failures (a killed node, a
// pulled cable) stay local: a host without a reply for kConductorSilence is given up for this
// session, with a note, and its fetched frames are kept. Without any host at the end of the
// capture, or without the master during synchronisation, record() throws RecordingFailed. Every
// wait has a limit. Whatever happens, the sessions are ended and the trigger is left off; if that
// fails, it is a note.
//
// The sink gets frames without truth. `progress` gets a line for each step. The request's pipeline
// is the one to run; its objects only tell the kind (warm_up(), initial_clocks(), steering()),
// since the nodes make their own. An oracle's clocks (kMaster) and exposures (kIdeal) fail: no rig
// has them.
//
//   RigSource source(rig, key, scenario, settings);
//   source.record({.seed = 1, .pipeline = "yoon2021_both", .host_sync = sync.get()}, sink);
#pragma once

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
  // For "manual" triggers: shows the text and returns when the user is done; false: given up.
  std::function<bool(const std::string& text)> prompt;
  // Polled every 50 ms while host_sync runs, before the capture and in it, not while nodes carry
  // out a request; once true, the cameras are stopped and record() throws. May be empty.
  std::function<bool()> cancelled;
  // The session whose journals are fetched (step 5) after its conductor was killed. Empty: a new
  // session.
  std::string collect_session;
};

// A host after a session.
struct HostReport {
  std::string name;
  bool lost = false;          // its node could not be reached until the end
  NodeOscillator oscillator;  // of its steady clock against its kernel's monotonic clock
};

class RigSource final : public RecordingSource {
 public:
  // `scenario` outlives this. Throws scenarios::InputError if the rig does not fit the scenario.
  RigSource(Rig rig, SecretKey key, const scenarios::Scenario& scenario,
            RigSourceSettings settings);

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override;

  // The hosts and the name of the last session.
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
