#include "algorithms/host_sync/ntp/ntp_client.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr double kPollSpread = 1.0 / 16;
constexpr double kSlewAhead = 1.25;  // poll intervals
// A longer round trip tells nothing; also keeps nonsense stamps out of the arithmetic.
constexpr double kMaxDelay = 16;

Nanoseconds from_seconds(double seconds) { return from_ms(seconds * 1e3); }

std::string text(double seconds) { return std::to_string(seconds) + " s"; }

}  // namespace

NtpClient::NtpClient(Host& host, PeerId server, const NtpSettings& settings)
    : host_(host),
      server_(server),
      settings_(settings),
      association_(host, server, settings.stamps),
      filter_(settings.discipline.precision_s),
      discipline_(settings.discipline),
      start_(host.steady_clock().now()),
      broadcast_delay_s_(settings.broadcast_delay_s) {}

Task<void> NtpClient::run() {
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
    const double spread = 1 + host_.random_uniform() * kPollSpread;
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
    if (!volley) continue;
    const NtpAction action = co_await discipline_by(volley);
    if (action == NtpAction::kSlew) {
      const double slew_s = std::abs(volley->offset_s) / NtpDiscipline::kMaxFrequency;
      co_await host_.sleep_for(from_seconds(slew_s));
    }
    if (action == NtpAction::kSlew || action == NtpAction::kStep) continue;
    const SteadyTime deadline = now() + settings_.broadcast_interval * 2;
    const std::optional<NtpBroadcast> next = co_await association_.next_broadcast(deadline);
    if (!next) continue;
    broadcast_delay_s_ = std::abs(volley->offset_s - next->offset_s());
    co_return;
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
  const NtpAction action = discipline_.update(sample->offset_s, sample->at_s);
  if (action == NtpAction::kPanic) {
    panicked_ = true;
    report(false, "the clock is off by " + text(sample->offset_s) + ", more than the panic limit " +
                      text(settings_.discipline.panic_s) + "; set it by hand or raise panic_s");
    co_return action;
  }
  if (action == NtpAction::kStep) co_await step(sample->offset_s);
  if (action == NtpAction::kSlew) {
    is_slewing_ = true;
    co_await host_.clock().slew(from_seconds(sample->offset_s), NtpDiscipline::kMaxFrequency * 1e9);
  }
  co_await correct_frequency();
  report(true, "");
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
  // No more than is due until the next poll has come for certain: what the end of a slew costs
  // grows with its distance.
  const double rate = discipline_.phase_rate(at_s);
  const double due_s = std::abs(rate) * kSlewAhead * discipline_.poll_interval_s();
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
    report(false, "no valid packet from time server " + std::to_string(server_) + " in " +
                      std::to_string(polls_) +
                      " polls; is it running, synchronised and reachable?");
  }
}

void NtpClient::report(bool synchronised, const std::string& message) {
  if (reported_) return;
  reported_ = true;
  SyncOutcome outcome;
  outcome.slave = host_.id();
  outcome.synchronised = synchronised;
  outcome.passes = polls_;
  if (!synchronised) outcome.message = "slave " + std::to_string(host_.id()) + ": " + message;
  host_.report_outcome(outcome);
}

}  // namespace simbench
