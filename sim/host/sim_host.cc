#include "sim/host/sim_host.h"

#include <algorithm>

#include "algorithms/ports/assert.h"
#include "sim/host/host_clocks.h"
#include "sim/host/pulse_lines.h"
#include "sim/host/sim_channel.h"
#include "sim/host/sim_frame_control.h"

namespace simbench::sim {
namespace {

// Beyond this a deadline is none: no run lasts so long, and instants further away may not exist.
constexpr std::chrono::hours kFarAhead(24 * 365 * 10);
// Longer sleeps look at the clock in between: nobody asks for noise that is days ahead.
constexpr std::chrono::hours kLongSleep(24);
// Noise is sampled as far as anyone asks: nobody asks further than this for a mere deadline.
constexpr std::chrono::seconds kFarOff(10);

constexpr std::size_t kFramesKept = 1024;

std::string host_name(PeerId id) { return "host" + std::to_string(id); }

ClockInterface interface_of(const HostWorld& world, PeerId id) {
  const scenarios::HostClockModel& clock = world.hosts.clock;
  RandomStream draw(world.run_seed, host_name(id) + ": tick phase");
  return ClockInterface(from_ms(clock.tick_ms), from_ms(draw.uniform(0, clock.tick_ms)),
                        from_ms(clock.resolution_ms));
}

}  // namespace

SimHost::SimHost(const HostWorld& world, PeerId id, SystemClock& system_clock, bool has_cameras)
    : world_(world),
      id_(id),
      system_clock_(system_clock),
      interface_(interface_of(world, id)),
      cpu_(world.context.engine()),
      clock_port_({world.context, system_clock, cpu_, world.hosts.clock}, interface_,
                  world.load.set_cost_factor(id), RandomStream(world.run_seed, name("set cost")),
                  host_name(id)),
      steady_port_(world.context.engine(), system_clock),
      algorithm_draws_(world.run_seed, name("algorithm")),
      has_cameras_(has_cameras),
      sleep_label_(name("sleep")),
      host_load_(world.hosts.load_burst, world.run_seed, id),
      stack_(world.hosts, world.run_seed, id),
      receiver_(world.hosts.pulse_lines, world.run_seed, id) {
  if (world.hosts.nic.hardware_stamps) nic_ = std::make_unique<NicClock>(*this);
  system_clock_.observe([this](const ClockAdjustment& adjustment) { on_adjustment(adjustment); });
}

SimHost::~SimHost() { system_clock_.observe(nullptr); }

HardwareClock* SimHost::hardware_clock() { return nic_.get(); }

PulseInput* SimHost::pulse_input(PulseLine line) { return pulse_line(line); }

SimPulseInput* SimHost::pulse_line(PulseLine line) {
  const bool is_pps = line == PulseLine::kPps;
  const scenarios::PulseLines& lines = world_.hosts.pulse_lines;
  if (!(is_pps ? lines.pps : lines.trigger)) return nullptr;
  std::unique_ptr<SimPulseInput>& input = is_pps ? pps_ : trigger_;
  if (input == nullptr) {
    input = is_pps ? std::make_unique<SimPulseInput>(*this, receiver_, "pps")
                   : std::make_unique<SimPulseInput>(*this, world_.trigger_line, "trigger");
  }
  return input.get();
}

RadioClock* SimHost::radio_clock() {
  const AccessPoint* const access_point = world_.access_point;
  if (access_point == nullptr || !access_point->has_radio(id_)) return nullptr;
  if (radio_ == nullptr) radio_ = std::make_unique<SimRadioClock>(*this, *access_point);
  return radio_.get();
}

void SimHost::trigger_started() {
  if (trigger_ != nullptr) trigger_->source_changed();
}

FrameFeed* SimHost::frame_feed() {
  if (!has_cameras_) return nullptr;
  if (frame_feed_ == nullptr) {
    world_.frames.catch_up();  // what was delivered before is not for it
    world_.frames.open();
    frame_feed_ = std::make_unique<SimFrameFeed>(*this);
  }
  return frame_feed_.get();
}

void SimHost::add_frame_control(std::uint32_t camera, const scenarios::Scenario& scenario) {
  controls_.push_back(std::make_unique<SimFrameControl>(*this, camera, scenario));
  control_ports_.push_back(controls_.back().get());
}

SimFrameControl* SimHost::frame_control(std::uint32_t camera) const {
  for (const auto& control : controls_) {
    if (control->camera() == camera) return control.get();
  }
  return nullptr;
}

bool SimHost::awaits_frame() const {
  if (frame_feed_ != nullptr && frame_feed_->is_awaited()) return true;
  return std::ranges::any_of(controls_, [](const auto& control) { return control->is_awaited(); });
}

std::optional<StoredFrequency> SimHost::stored_frequency() {
  return world_.drift_files.read(id_, true_now());
}

SimChannel& SimHost::datagram_channel(PeerId peer) {
  return static_cast<SimChannel&>(open_channel(peer, Transport::kDatagram));
}

SimMulticast& SimHost::multicast() {
  if (multicast_ == nullptr) multicast_ = std::make_unique<SimMulticast>(*this);
  return *multicast_;
}

MessageChannel& SimHost::open_channel(PeerId peer, Transport transport) {
  std::unique_ptr<SimChannel>& channel = channels_[{peer, transport}];
  if (channel == nullptr) channel = std::make_unique<SimChannel>(*this, peer, transport);
  return *channel;
}

Task<void> SimHost::sleep_for(Nanoseconds interval) {
  const SteadyTime deadline = steady_port_.now() + interval;
  Nanoseconds left = interval;
  while (left > kLongSleep) {
    co_await sim::sleep_until(world_.context, part_way(left), sleep_label_);
    left = deadline - steady_port_.now();
  }
  co_await sim::sleep_until(world_.context, system_clock_.when(deadline), sleep_label_);
}

Task<void> SimHost::sleep_until(HostTime at) {
  Sleeper sleeper(world_.context, sleep_label_);
  sleepers_.push_back(sleeper);
  for (;;) {
    const HostTime reads = system_clock_.read(true_now());
    const TrueTime wake = at > reads + kFarAhead    ? TrueTime::max()
                          : at > reads + kLongSleep ? part_way(at - reads)
                                                    : system_clock_.when(at, true_now());
    if (wake <= true_now()) break;
    co_await sleeper.adjusted.wait(wake);
  }
}

TrueTime SimHost::part_way(Nanoseconds left) const {
  return left > kFarAhead ? TrueTime::max() : true_now() + left / 2;
}

void SimHost::on_adjustment(const ClockAdjustment& adjustment) {
  world_.sink.on_event(adjustment);
  for (Sleeper& sleeper : sleepers_) sleeper.adjusted.notify();
}

void SimHost::report_exchange(const Exchange& exchange) {
  world_.sink.on_event(ExchangeEvent{id_, exchange});
}

void SimHost::report_pulse(const PulseStamp& pulse) {
  world_.sink.on_event(PulseSighting{id_, pulse.steady, pulse.gnss.value()});
}

void SimHost::report_outcome(const SyncOutcome& outcome) { world_.sink.on_event(outcome); }

void SimHost::report_program_failure(const ProgramFailure& failure) {
  world_.sink.on_event(failure);
}

void SimHost::report_delays(const SessionDelays& delays) { world_.sink.on_event(delays); }

void SimHost::report_alignment(const AlignmentReport& report) { world_.sink.on_event(report); }

std::optional<TrueTime> SimHost::next_look(SteadyTime deadline) const {
  const SteadyTime now = steady_port_.now();
  if (deadline > now + kFarAhead) return std::nullopt;
  const Nanoseconds left = deadline - now;
  if (left > kFarOff) return true_now() + left / 2;
  return system_clock_.when(deadline);
}

std::string SimHost::name(std::string_view what) const {
  return host_name(id_).append(": ").append(what);
}

SimFrameFeed::SimFrameFeed(SimHost& host)
    : host_(host), delivered_(host.world().context, host.name("next frame")) {}

Task<std::optional<FrameArrival>> SimFrameFeed::next(SteadyTime deadline) {
  SIMBENCH_ASSERT(!delivered_.waiting(), "one wait at a time on a frame feed");
  for (;;) {
    host_.world().frames.catch_up();
    if (!frames_.empty()) break;
    if (host_.is_past(deadline)) co_return std::nullopt;
    host_.world().frames.expect();
    co_await delivered_.wait(host_.next_look(deadline));
  }
  const FrameArrival frame = frames_.front();
  frames_.pop_front();
  co_return frame;
}

void SimFrameFeed::push(const FrameArrival& frame) {
  if (frames_.size() == kFramesKept) frames_.pop_front();
  frames_.push_back(frame);
  delivered_.notify();
}

}  // namespace simbench::sim
