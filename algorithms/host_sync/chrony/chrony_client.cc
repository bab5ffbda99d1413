#include "algorithms/host_sync/chrony/chrony_client.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace simbench {
namespace {

constexpr double kPollSpread = 0.02;
constexpr double kSlewAhead = 1.25;      // poll intervals
constexpr double kMaxClockError = 1e-6;  // the default of maxclockerror, 1 ppm

Nanoseconds from_seconds(double seconds) { return from_ms(seconds * 1e3); }

}  // namespace

double UnfinishedSlew::left_s(double at_s) const {
  const double done_s = rate * std::clamp(at_s - start_s, 0.0, duration_s);
  return std::copysign(std::max(std::abs(offset_s) - done_s, 0.0), offset_s);
}

ChronyClient::ChronyClient(Host& host, PeerId server, const ChronySettings& settings)
    : host_(host),
      server_(server),
      settings_(settings),
      association_(host, server, settings.stamps),
      stats_(settings.stats),
      reference_(settings.reference),
      poll_(settings.poll_min, settings.poll_max, settings.poll_target),
      start_(host.steady_clock().now()) {}

Task<void> ChronyClient::run() {
  // Clients that start together do not stay together.
  co_await host_.sleep_for(from_seconds(host_.random_uniform() * to_seconds(kBurstSpacing)));
  while (true) {
    const SteadyTime begin = host_.steady_clock().now();
    co_await poll();
    const double spread = 1 + host_.random_uniform() * kPollSpread;
    const bool in_burst = settings_.initial_burst && replies_ > 0 && good_samples_ < kBurst;
    const Nanoseconds interval =
        in_burst ? kBurstSpacing : from_seconds(poll_.interval_s() * spread);
    const Nanoseconds passed = host_.steady_clock().now() - begin;
    if (passed < interval) co_await host_.sleep_for(interval - passed);
  }
}

Task<void> ChronyClient::poll() {
  const std::optional<NtpMeasurement> reply = co_await association_.exchange(kMaxDelay);
  ++polls_;
  const bool is_used = reply && use(*reply);
  if (!is_used) {
    co_await slew(slew_.left_s(now_s()), slew_.rate);
    if (replies_ == 0 && polls_ >= kPatience) report(false);
    co_return;
  }
  co_await correct();
  report(true);
}

bool ChronyClient::use(const NtpMeasurement& measurement) {
  ++replies_;
  const ChronySample sample = sample_of(measurement);
  const double error_s = std::abs(sample.offset_s - stats_.predict_s(sample.at_s));
  const bool was_known = stats_.estimate().has_value();
  if (!stats_.is_good(sample)) return false;
  ++good_samples_;
  stats_.add(sample);
  if (was_known && good_samples_ > kBurst) {
    poll_.update(stats_.samples(), error_s, sample.delay_s / 2 + sample.dispersion_s);
  }
  return stats_.estimate().has_value();
}

Task<void> ChronyClient::correct() {
  const double now = now_s();
  const double left_s = slew_.left_s(now);
  const ChronyCorrection correction = reference_.update(*stats_.estimate(), now, left_s);
  stats_.correct(now, correction.offset_s, correction.frequency);
  if (correction.frequency != 0) {
    co_await host_.clock().adjust_frequency(reference_.frequency() * 1e9);
  }
  co_await slew(left_s + correction.offset_s, correction.slew_rate);
}

Task<void> ChronyClient::slew(double offset_s, double rate) {
  // No more at a time than is due until the next poll has come for certain: what the end of a slew
  // costs grows with its distance.
  const double part_s = std::min(std::abs(offset_s), rate * kSlewAhead * poll_.interval_s());
  const Nanoseconds part = from_seconds(std::copysign(part_s, offset_s));
  if (part == Nanoseconds{0}) co_return;
  const double before_s = now_s();
  co_await host_.clock().slew(part, rate * 1e9);
  slew_ = {offset_s, rate, (before_s + now_s()) / 2, part_s / rate};
}

ChronySample ChronyClient::sample_of(const NtpMeasurement& measurement) const {
  ChronySample sample;
  const double received_s = seconds(measurement.received);
  const double taken_s = std::max(to_seconds(measurement.t4 - measurement.t1), 0.0);
  sample.at_s = received_s - taken_s / 2;
  sample.offset_s = measurement.offset_s() - slew_.left_s(sample.at_s);
  sample.delay_s = std::max(measurement.delay_s(), settings_.stats.precision_s);
  const double rate_error = kMaxClockError + std::min(reference_.skew(), 1.0);
  sample.dispersion_s = settings_.stats.precision_s + rate_error * taken_s;
  return sample;
}

void ChronyClient::report(bool synchronised) {
  if (reported_) return;
  reported_ = true;
  SyncOutcome outcome;
  outcome.slave = host_.id();
  outcome.synchronised = synchronised;
  outcome.passes = polls_;
  if (!synchronised) {
    outcome.message = "slave " + std::to_string(host_.id()) + ": no valid reply from time server " +
                      std::to_string(server_) + " in " + std::to_string(polls_) +
                      " polls; is it running, synchronised and reachable?";
  }
  host_.report_outcome(outcome);
}

}  // namespace simbench
