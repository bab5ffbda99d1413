#include "algorithms/host_sync/chrony/chrony.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/ntp/ntp_service.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr double kMeasuredWeight = 3;
constexpr double kMinSlewTime = 1;  // s

}  // namespace

ChronyCorrection ChronyReference::update(const ChronyEstimate& estimate, double now_s,
                                         double left_s) {
  ChronyCorrection correction;
  correction.offset_s = estimate.offset_s + (now_s - estimate.at_s) * estimate.frequency;
  correction.frequency = change_of_frequency(estimate);
  const double interval_s = now_s - last_update_s_.value_or(now_s);
  last_update_s_ = now_s;
  const double size_s = std::abs(left_s + correction.offset_s);
  if (size_s > 0) {
    const double area = settings_.correction_ratio * interval_s * estimate.offset_sd_s;
    const double time_s = std::max(area / size_s, kMinSlewTime);
    correction.slew_rate = std::min(size_s / time_s, settings_.max_slew_rate);
  }
  return correction;
}

double ChronyReference::change_of_frequency(const ChronyEstimate& estimate) {
  double gain = 0;
  if (estimate.skew <= settings_.max_update_skew) {
    const double present = kMeasuredWeight * skew_ * skew_;
    gain = present / (present + estimate.skew * estimate.skew);
  }
  const double before = frequency_;
  frequency_ = std::clamp(frequency_ + gain * estimate.frequency, -kMaxFrequency, kMaxFrequency);
  const double change = frequency_ - before;
  const double disagreement = std::hypot(std::sqrt(1 - gain) * gain * estimate.frequency,
                                         std::sqrt(gain) * (1 - gain) * estimate.frequency);
  skew_ += gain * (estimate.skew - skew_) + disagreement;
  return change;
}

namespace {

constexpr double kPollSpread = 0.02;
constexpr double kSlewAhead = 1.25;      // poll intervals
constexpr double kMaxClockError = 1e-6;  // the default of maxclockerror, 1 ppm

// The client on one slave. The host must outlive the client, and the client its coroutines.
class ChronyClient {
 public:
  static constexpr int kBurst = 4;
  static constexpr Nanoseconds kBurstSpacing{2'000'000'000};
  static constexpr Nanoseconds kMaxDelay{3'000'000'000};
  static constexpr std::uint32_t kPatience = 8;  // polls without a reply, then the slave has failed

  ChronyClient(Host& host, PeerId server, const ChronySettings& settings);

  // Never ends.
  Task<void> run();

 private:
  Task<void> poll();
  // Returns whether there is an estimate to correct the clock by.
  bool use(const NtpMeasurement& measurement);
  Task<void> correct();
  // Adds `offset_s` at a rate, as a fraction, in parts.
  Task<void> slew(double offset_s, double rate);
  // The measurement as seen by the clock that has finished its slew.
  ChronySample sample_of(const NtpMeasurement& measurement) const;

  double seconds(SteadyTime at) const { return to_seconds(at - start_); }
  double now_s() const { return seconds(host_.steady_clock().now()); }

  Host& host_;
  PeerId server_;
  ChronySettings settings_;
  NtpAssociation association_;
  ChronySourceStats stats_;
  ChronyReference reference_;
  ChronyPoll poll_;
  UnfinishedSlew slew_;
  SteadyTime start_;
  std::uint32_t polls_ = 0;
  std::uint32_t replies_ = 0;
  int good_samples_ = 0;
  OutcomeReport outcome_;
};

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
      start_(host.steady_clock().now()),
      outcome_(host) {}

Task<void> ChronyClient::run() {
  if (const auto stored = host_.stored_frequency()) {
    reference_.start_with(stored->ppb * 1e-9, stored->error_ppb * 1e-9);
    co_await host_.clock().adjust_frequency(reference_.frequency() * 1e9);
  }
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
    if (replies_ == 0 && polls_ >= kPatience) {
      outcome_.failed(polls_, "no valid reply from time server " + std::to_string(server_) +
                                  " in " + std::to_string(polls_) +
                                  " polls; is it running, synchronised and reachable?");
    }
    co_return;
  }
  co_await correct();
  outcome_.synchronised(polls_);
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
  // No more at a time than is certainly due before the next poll: the cost of a slew's end grows
  // with its distance.
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

Task<void> ChronyService::run_master(Host& host, std::vector<PeerId> slaves) {
  co_await serve_ntp(host, std::move(slaves));
}

Task<void> ChronyService::run_slave(Host& host, PeerId master) {
  ChronyClient client(host, master, settings_);
  co_await client.run();
}

namespace {

const char* const kChronyDocumentation =
    "chrony.conf documentation (docs/reference/host_sync.md section 2)";

std::vector<ParameterSpec> chrony_parameters() {
  return {
      number_parameter("min_poll", 6, 0, 17, "shortest poll interval, log2 s",
                       kChronyDocumentation),
      not_below("min_poll", number_parameter("max_poll", 10, 0, 17, "longest poll interval, log2 s",
                                             kChronyDocumentation)),
      number_parameter("poll_target", 8, 3, 60, "samples that the poll interval aims at",
                       kChronyDocumentation),
      flag_parameter("iburst", true, "four good exchanges at 2 s to begin with",
                     "usual configuration (iburst)"),
      number_parameter("min_samples", 6, 3, 64, "samples that the runs test leaves",
                       kChronyDocumentation),
      not_below("min_samples", number_parameter("max_samples", 64, 4, 64, "samples that are kept",
                                                kChronyDocumentation)),
      number_parameter("max_delay_ratio", 10, 0.1, 1e6,
                       "largest delay above the minimum, in standard deviations of the samples",
                       kChronyDocumentation),
      number_parameter("correction_ratio", 3, 0.01, 100,
                       "duration of a slew over the time between updates (corrtimeratio)",
                       kChronyDocumentation),
      number_parameter("max_slew_ppm", 83333.333, 1, 100000, "fastest slew (maxslewrate)",
                       kChronyDocumentation),
      number_parameter("max_update_skew_ppm", 1000, 0.001, 1e6,
                       "skew above which a frequency is not used (maxupdateskew)",
                       kChronyDocumentation),
      choice_parameter("stamps", {"application", "kernel"},
                       "t1 from before the send, or from the kernel where it stamps",
                       "the other stamps are the application's"),
      number_parameter("service_hours", 4, 0, 1e4,
                       "how long the service has run when the capture starts",
                       "assumption: start-up transients are over"),
  };
}

std::unique_ptr<HostSync> make_chrony(const Parameters& parameters) {
  ChronySettings settings;
  settings.poll_min = static_cast<int>(parameters.number("min_poll"));
  settings.poll_max = static_cast<int>(parameters.number("max_poll"));
  settings.poll_target = parameters.number("poll_target");
  settings.initial_burst = parameters.flag("iburst");
  settings.stats.min_samples = static_cast<std::size_t>(parameters.number("min_samples"));
  settings.stats.max_samples = static_cast<std::size_t>(parameters.number("max_samples"));
  settings.stats.max_delay_ratio = parameters.number("max_delay_ratio");
  settings.reference.correction_ratio = parameters.number("correction_ratio");
  settings.reference.max_slew_rate = parameters.number("max_slew_ppm") * 1e-6;
  settings.reference.max_update_skew = parameters.number("max_update_skew_ppm") * 1e-6;
  settings.stamps = stamps_of(parameters);
  settings.service_time = from_ms(parameters.number("service_hours") * 3600e3);
  return std::make_unique<ChronyService>(settings);
}

HostSyncEntry chrony() {
  HostSyncEntry entry;
  entry.info.name = "chrony";
  entry.info.family = "chrony";
  entry.info.summary = "NTP client in the manner of chronyd: weighted regression, slews only";
  entry.info.source = "chrony (docs/reference/host_sync.md sections 1 and 2); RFC 5905";
  entry.info.parameters = chrony_parameters();
  entry.make = make_chrony;
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> host_sync_chrony() { return {chrony()}; }

}  // namespace simbench
