#include "algorithms/host_sync/chrony/chrony.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr double kMeasuredWeight = 3;
constexpr double kMinSlewTime = 1;  // s
constexpr double kSlewArea = 0.5;   // of a linear slew

}  // namespace

ChronyCorrection ChronyReference::update(const ChronyEstimate& estimate, double now_s,
                                         double left_s) {
  ChronyCorrection correction;
  correction.offset_s = estimate.offset_s + (now_s - estimate.at_s) * estimate.frequency;
  correction.frequency = change_of_frequency(estimate);
  const double interval_s = now_s - last_update_s_.value_or(now_s);
  last_update_s_ = now_s;
  const double size_s = std::abs(left_s + correction.offset_s);
  correction.is_step = updates_ < settings_.step_updates && size_s > settings_.step_threshold_s;
  if (updates_ < settings_.step_updates) ++updates_;
  if (size_s > 0) {
    const double area = kSlewArea * settings_.correction_ratio * interval_s * estimate.offset_sd_s;
    const double time_s = std::max(area / size_s, kMinSlewTime);
    correction.slew_rate = std::min(size_s / time_s, settings_.max_slew_ppm * 1e-6);
  }
  return correction;
}

double ChronyReference::change_of_frequency(const ChronyEstimate& estimate) {
  double gain = 0;
  if (estimate.skew <= settings_.max_update_skew_ppm * 1e-6) {
    const double present = kMeasuredWeight * skew_ * skew_;
    gain = present / (present + estimate.skew * estimate.skew);
  }
  const double before = frequency_;
  const double most = settings_.max_frequency;
  frequency_ = std::clamp(frequency_ + gain * estimate.frequency, -most, most);
  const double change = frequency_ - before;
  const double disagreement = std::hypot(std::sqrt(1 - gain) * gain * estimate.frequency,
                                         std::sqrt(gain) * (1 - gain) * estimate.frequency);
  skew_ += gain * (estimate.skew - skew_) + disagreement;
  return change;
}

namespace {

NtpStamps stamps_of(ChronyStamps stamps) {
  switch (stamps) {
    case ChronyStamps::kApplication:
      return NtpStamps::kApplication;
    case ChronyStamps::kProgram:
      return NtpStamps::kProgram;
    case ChronyStamps::kCard:
      return NtpStamps::kCard;
    default:
      return NtpStamps::kKernel;
  }
}

// Whether the service fails without them.
bool needs_stamps(ChronyStamps stamps) {
  return stamps == ChronyStamps::kKernel || stamps == ChronyStamps::kCard;
}

constexpr double kPollSpread = 0.02;
constexpr double kSlewAhead = 1.25;    // poll intervals
constexpr double kMaxJitter = 1;       // s; the default of maxjitter
constexpr double kMaxLanDelay = 0.01;  // s
constexpr double kBurstShare = 0.25;   // of a poll interval
// What the poll's score gets instead of a sample.
constexpr double kBadSample = 0.1;
constexpr double kMissedWhileSynchronised = 0.1;
constexpr double kMissed = 0.25;

ChronyReferenceSettings reference_settings(Host& host, const ChronySettings& settings) {
  ChronyReferenceSettings reference = settings.reference;
  reference.max_frequency =
      std::min(reference.max_frequency, host.clock().max_frequency_ppb() / 1e9);
  return reference;
}

// The client on one slave. The host must outlive the client, and the client its coroutines.
class ChronyClient {
 public:
  static constexpr int kBurst = 4;
  static constexpr std::uint32_t kBurstPolls = 8;
  static constexpr double kBurstSpacing = 2;  // s
  static constexpr double kMaxDelay = 3;      // s
  static constexpr Nanoseconds kInitialDelay{200'000'000};
  static constexpr std::uint32_t kReachPolls = 8;  // the last ones, of which one must be answered
  static constexpr std::uint32_t kPatience = 8;  // polls without a reply, then the slave has failed

  // *is_synchronised once the clock was corrected.
  ChronyClient(Host& host, PeerId server, const ChronySettings& settings,
               std::shared_ptr<bool> is_synchronised);

  // Ends only where the host lacks the stamps asked for.
  Task<void> run();

 private:
  // A measurement and what the clock was corrected by since, or had still to slew then.
  struct Pending {
    NtpMeasurement measurement;
    double at_s = 0;
    double moved_s = 0;
  };

  Task<void> poll();
  void missed();
  // Returns whether there is an estimate to correct the clock by.
  bool use(const NtpMeasurement& measurement);
  bool use(const ChronySample& sample);
  Task<void> correct();
  Task<void> step(double offset_s);
  // Adds `offset_s` at a rate, as a fraction, in parts.
  Task<void> slew(double offset_s, double rate);
  // The measurement that is complete with this reply: in interleaved mode the one before.
  std::optional<Pending> completed(const NtpMeasurement& reply);
  // The measurement as the clock sees it that has finished its slew.
  Pending pending(const NtpMeasurement& measurement) const;
  ChronySample sample_of(const Pending& complete) const;
  Nanoseconds interval() const;
  bool lacks_stamps() const {
    return needs_stamps(settings_.stamps) && !association_.lacking().empty();
  }

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
  std::optional<Pending> last_;  // in interleaved mode: without the server's departure stamp
  bool last_is_interleaved_ = false;
  SteadyTime start_;
  SteadyTime heard_;  // the last reply, or the last poll that was not answered
  std::uint32_t polls_ = 0;
  std::uint32_t replies_ = 0;
  std::uint32_t unanswered_ = 0;
  int good_samples_ = 0;
  std::shared_ptr<bool> is_synchronised_;
  OutcomeReport outcome_;
};

}  // namespace

double UnfinishedSlew::left_s(double at_s) const {
  const double done_s = rate * std::clamp(at_s - start_s, 0.0, duration_s);
  return std::copysign(std::max(std::abs(offset_s) - done_s, 0.0), offset_s);
}

ChronyClient::ChronyClient(Host& host, PeerId server, const ChronySettings& settings,
                           std::shared_ptr<bool> is_synchronised)
    : host_(host),
      server_(server),
      settings_(settings),
      association_(host, server, stamps_of(settings.stamps)),
      stats_(settings.stats),
      reference_(reference_settings(host, settings)),
      poll_(settings.poll_min, settings.poll_max, settings.poll_target),
      start_(host.steady_clock().now()),
      heard_(start_),
      is_synchronised_(std::move(is_synchronised)),
      outcome_(host) {
  if (settings.is_interleaved) association_.interleave();
}

Task<void> ChronyClient::run() {
  if (const auto stored = host_.stored_frequency()) {
    reference_.start_with(stored->ppb * 1e-9, stored->error_ppb * 1e-9);
    co_await host_.clock().adjust_frequency(reference_.frequency() * 1e9);
  }
  co_await host_.sleep_for(kInitialDelay);
  while (!lacks_stamps()) {
    co_await poll();
    const double spread = 1 + host_.random_uniform() * kPollSpread;
    const Nanoseconds wait = from_seconds(to_seconds(interval()) * spread);
    const Nanoseconds passed = host_.steady_clock().now() - heard_;
    if (passed < wait) co_await host_.sleep_for(wait - passed);
  }
  outcome_.failed(polls_, association_.lacking());
}

Nanoseconds ChronyClient::interval() const {
  const bool in_burst = settings_.initial_burst && good_samples_ < kBurst && polls_ < kBurstPolls;
  if (!in_burst) return from_seconds(poll_.interval_s());
  return from_seconds(std::min(kBurstSpacing, kBurstShare * poll_.interval_s()));
}

Task<void> ChronyClient::poll() {
  heard_ = host_.steady_clock().now();
  const std::optional<NtpMeasurement> reply = co_await association_.exchange(interval());
  ++polls_;
  if (reply) heard_ = reply->received;
  if (!reply) missed();
  const bool is_used = reply && use(*reply);
  const bool is_near = unanswered_ < kReachPolls && stats_.min_delay_s() <= kMaxLanDelay;
  if (!is_near) poll_.keep_whole_seconds();
  if (!is_used) {
    co_await slew(slew_.left_s(now_s()), slew_.rate);
    co_return;
  }
  co_await correct();
  *is_synchronised_ = true;
  outcome_.synchronised(polls_);
}

void ChronyClient::missed() {
  ++unanswered_;
  poll_.add(stats_.estimate() ? kMissedWhileSynchronised : kMissed);
  if (replies_ > 0 || polls_ < kPatience) return;
  outcome_.failed(polls_, "no valid reply from time server " + std::to_string(server_) + " in " +
                              std::to_string(polls_) +
                              " polls; is it running, synchronised and reachable?");
}

bool ChronyClient::use(const NtpMeasurement& measurement) {
  ++replies_;
  unanswered_ = 0;
  const bool is_stamped = measurement.is_stamped || !needs_stamps(settings_.stamps);
  const std::optional<Pending> complete = is_stamped ? completed(measurement) : std::nullopt;
  if (complete) return use(sample_of(*complete));
  poll_.add(kBadSample);
  return false;
}

std::optional<ChronyClient::Pending> ChronyClient::completed(const NtpMeasurement& reply) {
  const Pending now = pending(reply);
  if (!settings_.is_interleaved) return now;
  std::optional<Pending> complete;
  if (!reply.is_interleaved) {
    complete = now;
  } else if (last_ && last_is_interleaved_) {
    complete = last_;
    complete->measurement.t3 = reply.t3;
    host_.report_exchange(complete->measurement.exchange(server_));
  }
  last_ = now;
  last_is_interleaved_ = reply.is_interleaved;
  return complete;
}

bool ChronyClient::use(const ChronySample& sample) {
  const double error_s = std::abs(sample.offset_s - stats_.predict_s(sample.at_s));
  const bool is_good = sample.delay_s - sample.dispersion_s <= kMaxDelay && stats_.is_good(sample);
  if (!is_good) {
    poll_.add(kBadSample);
    return false;
  }
  ++good_samples_;
  stats_.add(sample);
  poll_.update(stats_.samples(), error_s, sample.delay_s / 2 + sample.dispersion_s);
  return stats_.estimate() && stats_.estimate()->sd_s <= kMaxJitter;
}

Task<void> ChronyClient::correct() {
  const double now = now_s();
  const double left_s = slew_.left_s(now);
  const ChronyCorrection correction = reference_.update(*stats_.estimate(), now, left_s);
  stats_.correct(now, correction.offset_s, correction.frequency);
  if (last_) {
    last_->moved_s += correction.offset_s + correction.frequency * (last_->at_s - now);
  }
  if (correction.frequency != 0) {
    co_await host_.clock().adjust_frequency(reference_.frequency() * 1e9);
  }
  if (correction.is_step) {
    co_await step(left_s + correction.offset_s);
  } else {
    co_await slew(left_s + correction.offset_s, correction.slew_rate);
  }
}

Task<void> ChronyClient::step(double offset_s) {
  co_await host_.clock().slew(Nanoseconds{0}, 0);
  slew_ = {};
  const HostTime before = co_await host_.clock().now();
  co_await host_.clock().set(before + from_seconds(offset_s));
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

ChronyClient::Pending ChronyClient::pending(const NtpMeasurement& measurement) const {
  const double taken_s = std::max(to_seconds(measurement.t4 - measurement.t1), 0.0);
  const double at_s = seconds(measurement.received) - taken_s / 2;
  return {.measurement = measurement, .at_s = at_s, .moved_s = slew_.left_s(at_s)};
}

ChronySample ChronyClient::sample_of(const Pending& complete) const {
  const NtpMeasurement& measurement = complete.measurement;
  const double precision_s = 2 * settings_.stats.precision_s;  // the client's and the server's
  const double taken_s = std::abs(to_seconds(measurement.t4 - measurement.t1));
  ChronySample sample;
  sample.at_s = complete.at_s;
  sample.offset_s = measurement.offset_s() - complete.moved_s;
  sample.delay_s = std::max(std::abs(measurement.delay_s()), precision_s);
  sample.dispersion_s = precision_s + stats_.frequency_error() * taken_s;
  return sample;
}

namespace {

Task<void> serve_chrony_clients(Host& host, std::vector<PeerId> slaves, ChronySettings settings,
                                std::shared_ptr<const bool> is_synchronised) {
  return serve_ntp(
      host, std::move(slaves),
      {.stamps = stamps_of(settings.stamps), .is_synchronised = std::move(is_synchronised)});
}

Task<void> follow_chrony_server(Host& host, PeerId master, ChronySettings settings,
                                std::shared_ptr<bool> is_synchronised) {
  ChronyClient client(host, master, settings, std::move(is_synchronised));
  co_await client.run();
}

}  // namespace

Task<void> serve_chronyd(Host& host, std::vector<PeerId> slaves, ChronySettings settings) {
  return serve_chrony_clients(host, std::move(slaves), settings, nullptr);
}

Task<void> follow_chronyd(Host& host, PeerId master, ChronySettings settings) {
  return follow_chrony_server(host, master, settings, std::make_shared<bool>(false));
}

Task<void> relay_chronyd(Host& host, PeerId master, std::vector<PeerId> slaves,
                         ChronySettings settings) {
  auto is_synchronised = std::make_shared<bool>(false);
  std::vector<Task<void>> sides;
  sides.push_back(follow_chrony_server(host, master, settings, is_synchronised));
  sides.push_back(serve_chrony_clients(host, std::move(slaves), settings, is_synchronised));
  co_await join_all(std::move(sides));
}

namespace {

const char* const kChronyDocumentation =
    "chrony.conf documentation (docs/reference/host_sync.md section 2)";
const char* const kDebianConfiguration = "chrony.conf of Debian 12";

void bind_polling(ParameterBinder& parameters, ChronySettings& settings) {
  parameters.number("min_poll", settings.poll_min, -7, 17,
                    "shortest poll interval, log2 s; below a second only in a local network",
                    kChronyDocumentation);
  parameters
      .number("max_poll", settings.poll_max, -7, 17, "longest poll interval, log2 s",
              kChronyDocumentation)
      .not_below("min_poll");
  parameters.number("poll_target", settings.poll_target, 3, 60,
                    "samples that the poll interval aims at", kChronyDocumentation);
  parameters.flag("iburst", settings.initial_burst, "four good exchanges at 2 s to begin with",
                  kDebianConfiguration);
  parameters.flag("xleave", settings.is_interleaved,
                  "interleaved mode: the server's departure stamps are its kernel's",
                  kChronyDocumentation);
  parameters.choice("stamps", settings.stamps,
                    {{"available", ChronyStamps::kAvailable},
                     {"kernel", ChronyStamps::kKernel},
                     {"application", ChronyStamps::kApplication},
                     {"program", ChronyStamps::kProgram},
                     {"card", ChronyStamps::kCard}},
                    "t1 from the kernel where it stamps (available), from the kernel or not at "
                    "all (kernel), or from before the send (application); all four from the "
                    "program (program) or from the network card (card), on both hosts",
                    "chronyd takes the best it gets");
}

void bind_estimate(ParameterBinder& parameters, ChronyStatsSettings& stats) {
  parameters.number("min_samples", stats.min_samples, 3, 64, "samples that the runs test leaves",
                    kChronyDocumentation);
  parameters
      .number("max_samples", stats.max_samples, 4, 64, "samples that are kept",
              kChronyDocumentation)
      .not_below("min_samples");
  parameters.number("max_delay_ratio", stats.max_delay_ratio, 0.1, 1e6,
                    "largest delay above the minimum, in standard deviations of the samples",
                    kChronyDocumentation);
}

void bind_reference(ParameterBinder& parameters, ChronyReferenceSettings& reference) {
  parameters.number("correction_ratio", reference.correction_ratio, 0.01, 100,
                    "duration of a slew over half the time between updates (corrtimeratio)",
                    kChronyDocumentation);
  parameters.number("max_slew_ppm", reference.max_slew_ppm, 1, 100000, "fastest slew (maxslewrate)",
                    kChronyDocumentation);
  parameters.number("max_update_skew_ppm", reference.max_update_skew_ppm, 0.001, 1e6,
                    "skew above which a frequency is not used (maxupdateskew)",
                    kDebianConfiguration);
  parameters.number("step_threshold_s", reference.step_threshold_s, 0, 1e9,
                    "offset above which the clock is stepped", kDebianConfiguration);
  parameters.number("step_updates", reference.step_updates, 0, 1e6,
                    "first updates that may step (makestep)", kDebianConfiguration);
}

}  // namespace

void ChronySettings::bind(ParameterBinder& parameters) {
  bind_polling(parameters, *this);
  bind_estimate(parameters, stats);
  bind_reference(parameters, reference);
  parameters.number("service_hours", service_time, 0, 1e4,
                    "how long the service has run when the capture starts",
                    "assumption: start-up transients are over");
}

namespace {

// Configured as Debian installs it; `settings` say what differs: polls and stamps.
HostSyncEntry chrony(const char* name, const char* summary, ChronySettings settings) {
  const bool has_card = settings.stamps == ChronyStamps::kCard;
  settings.reference.max_update_skew_ppm = 100;
  settings.reference.step_updates = 3;
  return with_settings<HostSyncEntry>(
      {.name = name,
       .family = "chrony",
       .summary = summary,
       .source = "chrony 4.3 (docs/reference/host_sync.md sections 1 and 2); RFC 5905",
       .needs = needs_of(has_card ? StampSource::kCard : StampSource::kKernel)},
      settings, kMake<ChronyService>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_chrony() {
  return {
      chrony("chrony", "NTP client in the manner of chronyd, as Debian installs it", {}),
      chrony("chrony_lan", "The same with the line of chrony's FAQ for a LAN, interleaved",
             {.poll_min = 2,
              .poll_max = 4,
              .poll_target = 30,
              .initial_burst = false,
              .is_interleaved = true,
              .stamps = ChronyStamps::kKernel}),
      chrony("chrony_lan_fast", "The same four times a second, interleaved",
             {.poll_min = -2,
              .poll_max = -2,
              .initial_burst = false,
              .is_interleaved = true,
              .stamps = ChronyStamps::kKernel,
              .service_time = from_ms(0.5 * 3600e3)}),
      chrony("chrony_hw_xleave", "The same polls as chrony, with the cards' stamps, interleaved",
             {.is_interleaved = true, .stamps = ChronyStamps::kCard}),
      chrony("chrony_hw", "The same without interleaving: the server's departure is its program's",
             {.stamps = ChronyStamps::kCard}),
      chrony("chrony_sw_xleave",
             "The same polls as chrony, with stamps of the programs alone, interleaved",
             {.is_interleaved = true, .stamps = ChronyStamps::kProgram}),
      chrony("chrony_sw", "The same without interleaving: chronyd without the kernel's stamps",
             {.stamps = ChronyStamps::kProgram}),
  };
}

}  // namespace simbench
