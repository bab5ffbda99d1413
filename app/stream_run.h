// Streams of other people's files as what an evaluation needs: a source, and a scenario that states
// the pipelines and how they are scored.
//
// The scenario is no world: files do not tell what a simulator needs. It has the cameras, hosts
// and the rate that the files show, the algorithms' own defaults, and no warm-up. Its resolved_json
// has the member "recording" (kRecordingMember), by which archives are known whose runs nobody can
// repeat.
//
// A pipeline is a device_time and a gathering, since host_sync had its effect on the clocks that
// stamped the arrivals: "hull_300+genlock"; "hull_300" alone has the gathering yoon2021. Without a
// choice it is each device_time that needs nothing but stamps.
//
//   const StreamRun run(app::recorded_streams({"a.bag", "b.bag"}), {"a.bag", "b.bag"}, {});
//   evaluation::choose_pipelines(run.scenario(), {});
//
// Errors: scenarios::InputError, "--pipelines ...", "--stream ...".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "evaluation/frames/gathered_sets.h"
#include "evaluation/frames/stream_source.h"
#include "recording/recorded_streams.h"
#include "scenarios/scenario.h"

namespace simbench::app {

struct StreamScoring {
  std::vector<std::string> pipelines{};
  std::string stream{};  // the scored kind; empty: the one that most cameras have
  // One trigger pulse started all cameras, so that GenLock order tells which frames belong
  // together. Else the gathered sets are scored, unverified.
  bool genlock = false;
};

class StreamRun {
 public:
  // `inputs`: the paths, for the scenario.
  StreamRun(RecordedStreams recorded, const std::vector<std::string>& inputs,
            const StreamScoring& scoring);

  const std::vector<RecordedStream>& streams() const { return recorded_.streams; }
  const std::string& kind() const { return kind_; }
  const scenarios::Scenario& scenario() const { return scenario_; }
  // Other kinds of stream, numbers that may be wrong: a line each.
  std::vector<std::string> notes() const;
  std::vector<std::string> warnings() const;
  // This outlives it.
  std::unique_ptr<evaluation::StreamSource> source() const;

 private:
  RecordedStreams recorded_;
  std::string kind_;
  bool genlock_;
  scenarios::Scenario scenario_;
};

// Every frame's global stamps, by stream, then by device_time. A kind
// without a frame period has none. Throws scenarios::InputError, "OPTION: found ...", for a
// device_time that needs more than stamps.
std::vector<evaluation::StampedStream> stamped_streams(const std::vector<RecordedStream>& streams,
                                                       const std::vector<std::string>& device_times,
                                                       const std::string& option);

// The device_time algorithms that need nothing but stamps.
std::vector<std::string> device_times_of_stamps();

}  // namespace simbench::app
