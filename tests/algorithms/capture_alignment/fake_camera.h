// Cameras that obey exactly, and hosts that have them, on the timeline of script_host.h.
//
// A FakeCamera's frames follow their lengths as its oscillator counts, without any noise; the
// middle of each exposure is half of the exposure before its readout, each frame is delivered a
// constant time after that. A control is latched when it is sent and counts `latency_frames` after
// the frame in progress. All is logged.
//
//   FakeRig rig(2);
//   FakeCamera& camera = rig.add(1, {.phase = from_ms(7)});
//   rig.run(*algorithm, from_ms(5000));
//   EXPECT_EQ(camera.middles().back() % from_ms(30), Nanoseconds(0));
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/parameters.h"
#include "algorithms/ports/capture_alignment.h"
#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {

struct FakeCameraScript {
  FrameControlLimits limits{.frame_length = from_ms(30),
                            .shortest = from_ms(20),
                            .longest = from_ms(100),
                            .granularity = from_us(1),
                            .exposure = from_ms(10),
                            .latency_frames = 2,
                            .allowed = {true, true, true, true}};
  Nanoseconds phase{};                        // when its first exposure has its middle
  double rate_ppm = 0;                        // by which its frames are longer
  Nanoseconds delay = from_ms(8);             // from the readout to the delivery
  bool stamps_steady = true;                  // sensor_steady is present
  int stretched_per_insert = 1;               // frames of the inserted length
  Nanoseconds stops_at = Nanoseconds::max();  // no frame from then on
  std::function<bool(std::size_t number)> is_lost = [](std::size_t) { return false; };
};

struct FakeControl {
  FrameControlKind kind{};
  Nanoseconds value{};
  Nanoseconds at{};  // when it was sent
};

class FakeCamera final : public FrameControl {
 public:
  FakeCamera(ScriptWorld& world, ScriptHost& host, std::uint32_t number, FakeCameraScript script);

  // Log: the true middles of the exposures, what was sent and not refused.
  const std::vector<Nanoseconds>& middles() const { return middles_; }
  const std::vector<FakeControl>& controls() const { return controls_; }

  std::uint32_t camera() const override { return number_; }
  const FrameControlLimits& limits() const override { return script_.limits; }
  Task<std::optional<FrameArrival>> next_frame(SteadyTime deadline) override;
  Task<FrameControlReply> start_at(HostTime at) override;

 private:
  Task<FrameControlReply> change(FrameControlKind kind, Nanoseconds length) override;
  void schedule(Nanoseconds middle);
  void expose();
  void deliver(Nanoseconds middle, std::uint32_t counter);
  Nanoseconds length_after(std::int64_t frame) const;
  FrameControlReply send(FrameControlKind kind, Nanoseconds value, Nanoseconds length);

  ScriptWorld& world_;
  ScriptHost& host_;
  std::uint32_t number_;
  FakeCameraScript script_;
  std::int64_t frame_ = -1;
  std::uint64_t schedule_ = 0;  // of the next frame; an older one does not count any more
  Nanoseconds steady_length_;
  std::map<std::int64_t, Nanoseconds> single_;
  std::map<std::int64_t, Nanoseconds> lengths_;
  std::deque<FrameArrival> delivered_;
  std::shared_ptr<boost::asio::steady_timer> waiting_;  // a wait for a frame, which cancelling ends
  std::vector<Nanoseconds> middles_;
  std::vector<FakeControl> controls_;
  std::size_t sent_ = 0;
};

// A scripted host with cameras; the channel of this stage is the script's.
class FakeHost final : public Host {
 public:
  explicit FakeHost(ScriptHost& script) : script_(script) {}

  void add(FakeCamera& camera) { controls_.push_back(&camera); }
  const std::vector<AlignmentReport>& reports() const { return reports_; }
  // The newest report of that camera; fails the test if there is none.
  AlignmentReport last_report(std::uint32_t camera) const;

  PeerId id() const override { return script_.id(); }
  HostClock& clock() override { return script_.clock(); }
  const SteadyClock& steady_clock() const override { return script_.steady_clock(); }
  std::span<FrameControl* const> frame_controls() override { return controls_; }
  MessageChannel& open_channel(PeerId peer, Transport transport) override {
    return script_.open_channel(peer, transport);
  }
  Task<void> sleep_for(Nanoseconds interval) override { return script_.sleep_for(interval); }
  Task<void> sleep_until(HostTime at) override { return script_.sleep_until(at); }
  double random_uniform() override { return script_.random_uniform(); }
  void report_exchange(const Exchange& exchange) override { script_.report_exchange(exchange); }
  void report_outcome(const SyncOutcome& outcome) override { script_.report_outcome(outcome); }
  void report_alignment(const AlignmentReport& report) override { reports_.push_back(report); }

 private:
  ScriptHost& script_;
  std::vector<FrameControl*> controls_;
  std::vector<AlignmentReport> reports_;
};

// Hosts, the first of them the master, and their cameras in order of addition.
class FakeRig {
 public:
  explicit FakeRig(PeerId hosts);

  ScriptWorld& world() { return world_; }
  FakeHost& host(PeerId id) { return *hosts_.at(id); }
  FakeCamera& add(PeerId host, FakeCameraScript script);
  // The algorithm on all hosts, for that long.
  void run(CaptureAlignment& algorithm, Nanoseconds end);

 private:
  ScriptWorld world_;
  std::vector<std::unique_ptr<FakeHost>> hosts_;
  std::vector<std::unique_ptr<FakeCamera>> cameras_;
};

// An algorithm of the registry, with these parameters over its defaults.
std::unique_ptr<CaptureAlignment> make_alignment(const std::string& name,
                                                 const ParameterValues& given = {});

}  // namespace simbench
