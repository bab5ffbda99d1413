#include "algorithms/host_sync/ntp/ntp_service.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr double kNtpPollSpread = 1.0 / 16;
constexpr double kNtpSlewAhead = 1.25;  // poll intervals
// s; a longer round trip is of no use. This also keeps nonsense stamps out of the arithmetic.
constexpr double kMaxDelay = 16;
// s, round trip: a calibration beyond this met a clock that is still slewed.
constexpr double kMostCalibratedDelay = 0.05;
// A broadcast that comes sooner after the burst than an interval less this is dropped.
constexpr Nanoseconds kBroadcastFuzz = from_ms(3e3);

std::string text(double seconds) { return std::to_string(seconds) + " s"; }

// The discipline begins with the frequency of a drift file, if there is one.
NtpDisciplineSettings started(NtpDisciplineSettings settings,
                              const std::optional<StoredFrequency>& stored) {
  if (stored) settings.frequency = stored->ppb * 1e-9;
  return settings;
}

// The client on one slave. The host must outlive the client, and the client its coroutines.
class NtpClient {
 public:
  static constexpr int kBurst = 8;
  static constexpr Nanoseconds kBurstSpacing{2'000'000'000};
  static constexpr std::uint32_t kPatience = 8;  // polls without a reply, then the slave has failed

  // *is_synchronised once the clock was updated.
  NtpClient(Host& host, PeerId server, const NtpSettings& settings,
            std::shared_ptr<bool> is_synchronised);

  // Ends only by panic.
  Task<void> run();

 private:
  Task<void> run_unicast();
  Task<void> run_broadcast();
  Task<void> poll();
  // Measures the delay by the first broadcast, a burst and the next broadcast.
  Task<void> calibrate();
  // The next broadcast that does not come earlier than that; earlier ones are dropped.
  Task<std::optional<NtpBroadcast>> broadcast_from(SteadyTime earliest);
  Task<void> listen();

  // Makes up to `count` exchanges at burst spacing; ends early if the first has no reply. Returns
  // the sample to discipline the clock by, if any.
  Task<std::optional<NtpSample>> burst(int count);
  std::optional<NtpSample> add_sample(const NtpSample& sample);
  Task<NtpAction> discipline_by(std::optional<NtpSample> sample);
  Task<void> step(double offset_s);
  Task<void> correct_frequency();
  Task<void> correct_phase();

  double seconds(SteadyTime at) const { return to_seconds(at - start_); }
  SteadyTime now() const { return host_.steady_clock().now(); }
  void note_reply(bool replied);

  Host& host_;
  PeerId server_;
  NtpSettings settings_;
  NtpAssociation association_;
  NtpClockFilter filter_;
  NtpDiscipline discipline_;
  SteadyTime start_;
  double root_distance_s_ = 0;    // of the server
  double broadcast_delay_s_ = 0;  // one way
  double applied_frequency_ = 0;
  std::uint8_t reach_ = 0;  // one bit per poll, the last one lowest
  std::uint32_t polls_ = 0;
  bool is_slewing_ = false;
  bool panicked_ = false;
  std::shared_ptr<bool> is_synchronised_;
  OutcomeReport outcome_;
};

NtpClient::NtpClient(Host& host, PeerId server, const NtpSettings& settings,
                     std::shared_ptr<bool> is_synchronised)
    : host_(host),
      server_(server),
      settings_(settings),
      association_(host, server, settings.stamps),
      filter_(settings.discipline.precision_s),
      discipline_(started(settings.discipline,
                          settings.reads_drift_file ? host.stored_frequency() : std::nullopt)),
      start_(host.steady_clock().now()),
      broadcast_delay_s_(settings.broadcast_delay_s / 2),
      is_synchronised_(std::move(is_synchronised)),
      outcome_(host) {}

Task<void> NtpClient::run() {
  // The frequency is that of a drift file, or 0.
  if (discipline_.frequency() != 0) co_await correct_frequency();
  if (settings_.mode == NtpMode::kUnicast) {
    co_await run_unicast();
  } else {
    co_await run_broadcast();
  }
}

Task<void> NtpClient::run_unicast() {
  // Clients that start together do not stay together.
  co_await host_.sleep_for(from_seconds(host_.random_uniform() * to_seconds(kBurstSpacing)));
  while (!panicked_) {
    const SteadyTime begin = now();
    co_await poll();
    const double spread = 1 + host_.random_uniform() * kNtpPollSpread;
    const Nanoseconds interval = from_seconds(discipline_.poll_interval_s() * spread);
    const Nanoseconds passed = now() - begin;
    co_await host_.sleep_for(std::max(interval - passed, kBurstSpacing));
  }
}

Task<void> NtpClient::poll() {
  const bool is_reached = reach_ != 0;
  const std::optional<NtpSample> best =
      co_await burst(settings_.initial_burst && !is_reached ? kBurst : 1);
  co_await discipline_by(best);
  co_await correct_phase();
}

Task<void> NtpClient::run_broadcast() {
  if (settings_.mode == NtpMode::kBroadcastVolley) co_await calibrate();
  while (!panicked_) co_await listen();
}

Task<void> NtpClient::calibrate() {
  while (!panicked_) {
    const SteadyTime patience = now() + settings_.broadcast_interval * 2;
    const std::optional<NtpBroadcast> first = co_await association_.next_broadcast(patience);
    note_reply(first.has_value());
    if (!first) continue;
    const std::optional<NtpSample> volley = co_await burst(kBurst);
    const SteadyTime answered = now();
    if (!volley) continue;
    if (co_await discipline_by(volley) == NtpAction::kStep) continue;
    co_await correct_phase();
    const std::optional<NtpBroadcast> next =
        co_await broadcast_from(answered + settings_.broadcast_interval - kBroadcastFuzz);
    if (!next) continue;
    const double one_way_s = std::abs(volley->offset_s - next->offset_s());
    if (2 * one_way_s > kMostCalibratedDelay) continue;
    broadcast_delay_s_ = one_way_s;
    co_return;
  }
}

Task<std::optional<NtpBroadcast>> NtpClient::broadcast_from(SteadyTime earliest) {
  const SteadyTime deadline = earliest + settings_.broadcast_interval * 2;
  for (;;) {
    const std::optional<NtpBroadcast> next = co_await association_.next_broadcast(deadline);
    if (!next || next->received >= earliest) co_return next;
  }
}

Task<void> NtpClient::listen() {
  const SteadyTime deadline = now() + settings_.broadcast_interval * 2;
  const std::optional<NtpBroadcast> broadcast = co_await association_.next_broadcast(deadline);
  note_reply(broadcast.has_value());
  std::optional<NtpSample> best;
  if (broadcast) {
    best = add_sample({broadcast->offset_s() + broadcast_delay_s_, 2 * broadcast_delay_s_,
                       settings_.discipline.precision_s, seconds(broadcast->received)});
  }
  const NtpAction action = co_await discipline_by(best);
  if (action != NtpAction::kStep) co_await correct_phase();
}

Task<std::optional<NtpSample>> NtpClient::burst(int count) {
  std::optional<NtpSample> best;
  bool replied = false;
  for (int i = 0; i < count; ++i) {
    const SteadyTime begin = now();
    const std::optional<NtpMeasurement> reply = co_await association_.exchange(kBurstSpacing);
    if (!reply && !replied) break;
    replied = true;
    if (reply && std::abs(reply->delay_s()) < kMaxDelay) {
      root_distance_s_ = reply->root_delay_s / 2 + reply->root_dispersion_s;
      const double taking_s = std::max(to_seconds(reply->t4 - reply->t1), 0.0);
      const double dispersion_s =
          settings_.discipline.precision_s + NtpClockFilter::kDispersionGrowth * taking_s;
      const std::optional<NtpSample> used =
          add_sample({reply->offset_s(), reply->delay_s(), dispersion_s, seconds(reply->received)});
      if (used) best = used;
    }
    const Nanoseconds passed = now() - begin;
    if (i + 1 < count && passed < kBurstSpacing) co_await host_.sleep_for(kBurstSpacing - passed);
  }
  note_reply(replied);
  co_return best;
}

std::optional<NtpSample> NtpClient::add_sample(const NtpSample& sample) {
  return filter_.add(sample, discipline_.poll_interval_s(), discipline_.is_starting(sample.at_s));
}

Task<NtpAction> NtpClient::discipline_by(std::optional<NtpSample> sample) {
  if (!sample || filter_.distance_s() + root_distance_s_ > NtpClockFilter::kMaxDistance) {
    co_return NtpAction::kIgnore;
  }
  const NtpAction action = discipline_.update(sample->offset_s, seconds(now()));
  if (action == NtpAction::kPanic) {
    panicked_ = true;
    outcome_.failed(
        polls_, "the clock is off by " + text(sample->offset_s) + ", more than the panic limit " +
                    text(settings_.discipline.panic_s) + "; set it by hand or raise panic_s");
    co_return action;
  }
  if (action == NtpAction::kStep) co_await step(sample->offset_s);
  if (action == NtpAction::kSlew) {
    is_slewing_ = true;
    co_await host_.clock().slew(from_seconds(sample->offset_s), NtpDiscipline::kMaxFrequency * 1e9);
  }
  co_await correct_frequency();
  *is_synchronised_ = true;
  outcome_.synchronised(polls_);
  co_return action;
}

Task<void> NtpClient::step(double offset_s) {
  filter_.reset();
  reach_ = 0;
  is_slewing_ = false;
  co_await host_.clock().slew(Nanoseconds{0}, 1);
  const HostTime before = co_await host_.clock().now();
  co_await host_.clock().set(before + from_seconds(offset_s));
}

Task<void> NtpClient::correct_frequency() {
  const double frequency = discipline_.frequency();
  if (frequency == applied_frequency_) co_return;
  applied_frequency_ = frequency;
  co_await host_.clock().adjust_frequency(frequency * 1e9);
}

Task<void> NtpClient::correct_phase() {
  // While the frequency is measured, the first offset is still being added.
  if (discipline_.state() == NtpState::kFreq) co_return;
  const double at_s = seconds(now());
  // No more than is certainly due before the next poll: the cost of a slew's end grows with its
  // distance.
  const double rate = discipline_.phase_rate(at_s);
  const double due_s = std::abs(rate) * kNtpSlewAhead * discipline_.poll_interval_s();
  const double residual_s = discipline_.residual_s(at_s);
  const Nanoseconds part =
      from_seconds(std::copysign(std::min(due_s, std::abs(residual_s)), residual_s));
  if (part == Nanoseconds{0} && !is_slewing_) co_return;
  is_slewing_ = part != Nanoseconds{0};
  co_await host_.clock().slew(part, std::abs(rate) * 1e9);
}

void NtpClient::note_reply(bool replied) {
  ++polls_;
  reach_ = static_cast<std::uint8_t>((reach_ << 1) | (replied ? 1 : 0));
  if ((reach_ & 7U) == 0) filter_.add_missing(seconds(now()));
  if (reach_ == 0 && polls_ >= kPatience) {
    outcome_.failed(polls_, "no valid packet from time server " + std::to_string(server_) + " in " +
                                std::to_string(polls_) +
                                " polls; is it running, synchronised and reachable?");
  }
}

}  // namespace

namespace {

Task<void> serve_ntpd_clients(Host& host, std::vector<PeerId> slaves, NtpSettings settings,
                              std::shared_ptr<const bool> is_synchronised) {
  std::vector<Task<void>> servers;
  servers.push_back(serve_ntp(host, slaves, {.is_synchronised = std::move(is_synchronised)}));
  if (settings.mode != NtpMode::kUnicast) {
    servers.push_back(broadcast_ntp(host, std::move(slaves), settings.broadcast_interval));
  }
  co_await join_all(std::move(servers));
}

Task<void> follow_ntpd_server(Host& host, PeerId master, NtpSettings settings,
                              std::shared_ptr<bool> is_synchronised) {
  if (settings.mode != NtpMode::kUnicast) {
    const double interval_s = to_seconds(settings.broadcast_interval);
    settings.discipline.poll_min = static_cast<int>(std::lround(std::log2(interval_s)));
    settings.discipline.poll_max = settings.discipline.poll_min;
  }
  NtpClient client(host, master, settings, std::move(is_synchronised));
  co_await client.run();
}

}  // namespace

Task<void> serve_ntpd(Host& host, std::vector<PeerId> slaves, NtpSettings settings) {
  return serve_ntpd_clients(host, std::move(slaves), std::move(settings), nullptr);
}

Task<void> follow_ntpd(Host& host, PeerId master, NtpSettings settings) {
  return follow_ntpd_server(host, master, std::move(settings), std::make_shared<bool>(false));
}

Task<void> relay_ntpd(Host& host, PeerId master, std::vector<PeerId> slaves, NtpSettings settings) {
  auto is_synchronised = std::make_shared<bool>(false);
  std::vector<Task<void>> sides;
  sides.push_back(follow_ntpd_server(host, master, settings, is_synchronised));
  sides.push_back(serve_ntpd_clients(host, std::move(slaves), settings, is_synchronised));
  co_await join_all(std::move(sides));
}

namespace {

const char* const kReferenceNtp =
    "reference implementation (docs/reference/host_sync.md section 2)";

// ntpd takes whole exponents only.
ParameterBinder& bind_poll(ParameterBinder& parameters, const std::string& name, int& poll,
                           const std::string& meaning) {
  double exponent = poll;
  parameters.number(name, exponent, 3, 17, meaning,
                    "ntpd's documentation, minpoll and maxpoll (confopt.html): from 3 to 17, by "
                    "default 6 and 10");
  if (exponent != std::floor(exponent)) {
    throw ParameterError(
        name, name + " is an exponent of 2 and must be whole, not " + std::to_string(exponent));
  }
  poll = static_cast<int>(exponent);
  return parameters;
}

}  // namespace

void NtpSettings::bind(ParameterBinder& parameters) {
  parameters.scaled("step_ms", discipline.step_s, 1e-3, 0, 1e6,
                    "offset above which the clock is stepped; 0: never; 0 or above 500: ntpd's "
                    "own loop instead of the kernel's",
                    kReferenceNtp);
  parameters.number("step_out_s", discipline.step_out_s, 300, 1e5,
                    "how long such an offset must last, and how long the frequency is measured",
                    "reference implementation, which takes no less than 300; RFC 5905: 900");
  parameters.number("panic_s", discipline.panic_s, 0, 1e9, "offset that ends the service; 0: none",
                    kReferenceNtp);
  bind_poll(parameters, "min_poll", discipline.poll_min, "shortest poll interval, log2 s");
  bind_poll(parameters, "max_poll", discipline.poll_max, "longest poll interval, log2 s")
      .not_below("min_poll");
  parameters.flag("iburst", initial_burst,
                  "a burst of eight exchanges while the server is not reached",
                  "usual configuration (iburst)");
  parameters.choice("stamps", stamps,
                    {{"application", NtpStamps::kApplication}, {"kernel", NtpStamps::kKernel}},
                    "t1 from before the send, or from the kernel where it stamps",
                    "ntpd stamps in the application");
  parameters.number("broadcast_interval_s", broadcast_interval, 8, 131072,
                    "between broadcasts (broadcast modes only)", "RFC 5905 section 9.2");
  parameters.scaled("broadcast_delay_ms", broadcast_delay_s, 1e-3, 0, 1e4,
                    "broadcastdelay, the assumed round trip, of which half is added "
                    "(ntp_broadcast_fixed only)",
                    "ntpd's documentation, broadcastdelay (miscopt.html), for what it means; "
                    "older documents of ntpd for 4 ms, 3 to 7 typical");
  parameters.number("service_hours", service_time, 0, 1e4,
                    "how long the service has run when the capture starts",
                    "assumption: most of the start-up transient is over");
}

namespace {

// Forms of one family share the scenario's parameters.
HostSyncEntry ntp(std::string name, std::string summary, const NtpSettings& settings,
                  std::string family = "ntp") {
  return with_settings<HostSyncEntry>({.name = std::move(name),
                                       .family = std::move(family),
                                       .summary = std::move(summary),
                                       .source = "RFC 5905; docs/reference/host_sync.md section 2"},
                                      settings, kMake<NtpService>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_ntp() {
  return {
      ntp("ntp", "ntpd as Linux runs it: clock filter, the kernel's PLL/FLL, adaptive poll", {}),
      ntp("ntp_first_run", "ntp on a host that has no drift file yet", {.reads_drift_file = false}),
      ntp("ntp_lan", "ntpd at its best on a LAN: ntp with polls of 8 and 16 s",
          {.discipline = {.poll_min = 3, .poll_max = 4}}, "ntp_lan"),
      ntp("ntp_daemon_loop", "ntpd with its own PLL/FLL, for a kernel without one (disable kernel)",
          {.discipline = {.loop = NtpLoop::kDaemon}}),
      ntp("ntp_broadcast_volley", "NTP broadcast, its delay calibrated by one volley of exchanges",
          {.mode = NtpMode::kBroadcastVolley, .service_time = from_ms(6 * 3600e3)}),
      ntp("ntp_broadcast_fixed", "NTP broadcast with half of an assumed round trip",
          {.mode = NtpMode::kBroadcastFixed, .service_time = from_ms(6 * 3600e3)}),
  };
}

}  // namespace simbench
