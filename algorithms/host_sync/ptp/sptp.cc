#include "algorithms/host_sync/ptp/sptp.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/host_sync/ptp/ptp_clocks.h"
#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// Before the servo has its first frequency.
constexpr int kStartUpExchanges = 5;

Task<void> serve_sptp(Host& host, PeerId client, StampSource source,
                      std::shared_ptr<const bool> is_ready) {
  MessageStamps stamps(host, source);
  MessageChannel& channel = host.open_channel(client, Transport::kDatagram);
  while (stamps.lacking().empty()) {
    std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received || !*is_ready) continue;
    const std::optional<PtpMessage> request = decode_ptp_message(received->bytes);
    if (!request || request->type != PtpType::kDelayRequest || !request->is_simple) continue;
    const std::optional<std::int64_t> arrival = stamps.arrival(*received);
    if (!arrival) continue;
    Bytes sync = encode({.type = PtpType::kSync,
                         .sender = host.id(),
                         .sequence = request->sequence,
                         .time_ns = *arrival,
                         .is_simple = true});
    const MessageId id = co_await channel.send(std::move(sync));
    const std::optional<std::int64_t> departure = co_await stamps.departure(channel, id);
    if (!departure) continue;
    Bytes announce = encode({.type = PtpType::kAnnounce,
                             .sender = host.id(),
                             .sequence = request->sequence,
                             .correction = request->correction,
                             .time_ns = *departure,
                             .is_simple = true});
    co_await channel.send(std::move(announce));
  }
}

class SptpClient {
 public:
  SptpClient(Host& host, PeerId server, const SptpSettings& settings)
      : host_(host),
        server_(server),
        settings_(settings),
        clock_(clock_of(settings.stamps)),
        stamps_(host, settings.stamps),
        path_delay_(settings.path_delay),
        servo_(servo_settings(settings)),
        begin_(host.steady_clock().now()),
        outcome_(host) {
    if (clock_ == ClockKind::kHardware && host.hardware_clock() != nullptr) {
      coupling_.emplace(host, ClockKind::kSystem, settings.servo_limits);
    }
  }

  // Never ends, unless the host lacks the stamps.
  Task<void> run() {
    SteadyTime next_exchange = begin_ + part_of_interval(host_.random_uniform());
    SteadyTime next_coupling = SteadyTime::max();
    while (stamps_.lacking().empty()) {
      const SteadyTime now = host_.steady_clock().now();
      if (now >= next_exchange) {
        next_exchange = now + settings_.interval;
        co_await turn();
        report_outcome_if_due();
        continue;
      }
      if (coupling_ && is_locked_ && next_coupling == SteadyTime::max()) next_coupling = now;
      if (now >= next_coupling) {
        next_coupling = now + ClockCoupling::kInterval;
        co_await coupling_->update();
        continue;
      }
      co_await host_.sleep_for(std::min(next_exchange, next_coupling) - now);
    }
    outcome_.failed(exchanges_, stamps_.lacking());
  }

 private:
  static ServoSettings servo_settings(const SptpSettings& settings) {
    ServoSettings servo = settings.servo_limits;
    servo.interval_s = to_seconds(settings.interval);
    return servo;
  }

  Nanoseconds part_of_interval(double part) const {
    return from_ns(part * to_ns(settings_.interval));
  }
  MessageChannel& channel() { return host_.open_channel(server_, Transport::kDatagram); }

  // An exchange, and what follows from it.
  Task<void> turn() {
    const std::optional<SptpExchange> exchange = co_await ask();
    if (!exchange) {
      co_await apply(servo_.hold(), Nanoseconds(0));
      co_return;
    }
    ++exchanges_;
    report(*exchange);
    const Nanoseconds offset = path_delay_.offset(*exchange);
    const SptpServo::Answer answer =
        servo_.sample(to_ns(offset), exchange->t2, host_.steady_clock().now());
    is_locked_ = is_locked_ || answer.is_locked;
    co_await apply(answer, offset);
  }

  // Nothing if it is not complete in time, or if a switch corrected by less than nothing.
  Task<std::optional<SptpExchange>> ask() {
    const SteadyTime deadline =
        host_.steady_clock().now() + std::min(settings_.exchange_timeout, settings_.interval / 2);
    Bytes request = encode({.type = PtpType::kDelayRequest,
                            .sender = host_.id(),
                            .sequence = ++sequence_,
                            .is_simple = true});
    const MessageId id = co_await channel().send(std::move(request));
    const std::optional<std::int64_t> departure = co_await stamps_.departure(channel(), id);
    if (!departure) co_return std::nullopt;
    SptpExchange exchange{.t3 = *departure};
    bool has_sync = false;
    bool has_announce = false;
    while (!has_sync || !has_announce) {
      std::optional<ReceivedMessage> received = co_await channel().receive(deadline);
      if (!received) co_return std::nullopt;
      const std::optional<PtpMessage> message = decode_ptp_message(received->bytes);
      if (!message || !message->is_simple || message->sequence != sequence_) continue;
      if (message->type == PtpType::kAnnounce) {
        has_announce = true;
        exchange.t1 = message->time_ns;
        exchange.request_correction = correction_of(*message);
      }
      if (message->type != PtpType::kSync) continue;
      const std::optional<std::int64_t> arrival = stamps_.arrival(*received);
      if (!arrival) co_return std::nullopt;
      has_sync = true;
      exchange.t2 = *arrival;
      exchange.t4 = message->time_ns;
      exchange.sync_correction = correction_of(*message);
    }
    const bool is_possible =
        exchange.sync_correction.count() >= 0 && exchange.request_correction.count() >= 0;
    if (!is_possible) co_return std::nullopt;
    co_return exchange;
  }

  Task<void> apply(SptpServo::Answer answer, Nanoseconds offset) {
    if (answer.action == SptpServo::Action::kStep) co_await step_clock(host_, clock_, -offset);
    if (answer.action == SptpServo::Action::kSetFrequency) {
      co_await set_frequency(host_, clock_, -answer.ppb);
    }
  }

  void report(const SptpExchange& exchange) {
    if (clock_ == ClockKind::kHardware) return;
    host_.report_exchange({.peer = server_,
                           .t1 = HostTime(Nanoseconds(exchange.t3)),
                           .t2 = HostTime(Nanoseconds(exchange.t4)),
                           .t3 = HostTime(Nanoseconds(exchange.t1)),
                           .t4 = HostTime(Nanoseconds(exchange.t2))});
  }

  void report_outcome_if_due() {
    if (outcome_.is_reported()) return;
    if (coupling_ ? coupling_->is_locked() : is_locked_) return outcome_.synchronised(exchanges_);
    const Nanoseconds allowed = settings_.patience + from_seconds(servo_.first_frequency_s()) +
                                kStartUpExchanges * settings_.interval;
    if (host_.steady_clock().now() - begin_ < allowed) return;
    outcome_.failed(exchanges_, "the servo has not locked after " + std::to_string(exchanges_) +
                                    " exchanges; is host " + std::to_string(server_) +
                                    " running and reachable, and does it stamp its messages as "
                                    "this one does?");
  }

  Host& host_;
  PeerId server_;
  SptpSettings settings_;
  ClockKind clock_;
  MessageStamps stamps_;
  SptpPathDelay path_delay_;
  SptpServo servo_;
  std::optional<ClockCoupling> coupling_;  // with hardware stamps
  std::uint16_t sequence_ = 0;
  std::uint32_t exchanges_ = 0;
  bool is_locked_ = false;
  SteadyTime begin_;
  OutcomeReport outcome_;
};

}  // namespace

Task<void> Sptp::run_master(Host& host, std::vector<PeerId> slaves) {
  const bool needs_card = settings_.stamps == StampSource::kCard;
  // The slaves will report that nothing came.
  if (needs_card && host.hardware_clock() == nullptr) co_return;
  auto is_ready = std::make_shared<bool>(!needs_card);
  std::vector<Task<void>> tasks;
  tasks.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) {
    tasks.push_back(serve_sptp(host, slave, settings_.stamps, is_ready));
  }
  if (needs_card) {
    tasks.push_back(keep_coupled(host, ClockKind::kHardware, settings_.servo_limits, is_ready));
  }
  co_await join_all(std::move(tasks));
}

Task<void> Sptp::run_slave(Host& host, PeerId master) {
  SptpClient client(host, master, settings_);
  co_await client.run();
}

namespace {

const char* const kSptpDefault = "facebook/time, ptp/sptp/client/config.go: default";
const char* const kSptpExample = "facebook/time, ptp/sptp/README.md: its example";

std::vector<ParameterSpec> sptp_parameters(bool has_hardware_stamps) {
  std::vector<ParameterSpec> specs = {
      number_parameter("warm_up_s", 60, 1, 1e6, "how long the service has run before the capture",
                       kAssumption),
      number_parameter("log_interval", 0, -7, 12, "log2 of the seconds between two exchanges",
                       kSptpDefault),
      number_parameter("exchange_timeout_ms", 100, 1, 1e6,
                       "an exchange that takes longer (or half of the interval) is lost",
                       kSptpDefault),
      number_parameter("path_delay_filter_length", 59, 1, 1e4, "path delays of the median",
                       kSptpExample),
      number_parameter("discard_below_us", 0, 0, 1e6, "shorter path delays are discarded",
                       "assumption: 0; the README's example has 2, its network's least delay"),
      number_parameter("discard_from_us", 20, 0, 1e6,
                       "longer path delays are discarded if they exceed the multiple",
                       kSptpExample),
      number_parameter("discard_multiplier", 3, 2, 1e6, "of the path delay", kSptpExample),
      number_parameter("first_step_threshold_us", 20, 0, 1e12,
                       "the first correction is a step above this; 0: never",
                       "facebook/time, servo/servo.go; its example has 1 s"),
      number_parameter("max_frequency_ppm", 500, 1, 4e5, "largest correction of a frequency",
                       "adjtimex(2)"),
  };
  if (!has_hardware_stamps) specs.push_back(software_stamps_parameter());
  return specs;
}

HostSyncEntry sptp(std::string name, std::string summary, bool has_hardware_stamps) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = "sptp";
  entry.info.summary = std::move(summary);
  entry.info.source = "facebook/time, ptp/sptp (docs/reference/host_sync.md section 1)";
  entry.info.parameters = sptp_parameters(has_hardware_stamps);
  if (has_hardware_stamps) entry.info.needs = {Need::kHardwareStamps};
  entry.make = [has_hardware_stamps](const Parameters& parameters) {
    SptpSettings settings;
    settings.stamps = has_hardware_stamps ? StampSource::kCard : software_stamps(parameters);
    settings.service_time = from_seconds(parameters.number("warm_up_s"));
    settings.interval = from_seconds(std::exp2(parameters.number("log_interval")));
    settings.exchange_timeout = from_ms(parameters.number("exchange_timeout_ms"));
    settings.path_delay.length =
        static_cast<std::size_t>(parameters.number("path_delay_filter_length"));
    settings.path_delay.discard_below = from_us(parameters.number("discard_below_us"));
    settings.path_delay.discard_from = from_us(parameters.number("discard_from_us"));
    settings.path_delay.multiplier = parameters.number("discard_multiplier");
    settings.servo_limits.first_step_threshold_ns =
        parameters.number("first_step_threshold_us") * 1e3;
    settings.servo_limits.max_frequency_ppb = parameters.number("max_frequency_ppm") * 1e3;
    return std::make_unique<Sptp>(settings);
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> host_sync_sptp() {
  return {
      sptp("sptp_software", "SPTP with software stamps: the client asks, once a second", false),
      sptp("sptp_hardware",
           "SPTP with the network cards' stamps and clocks: the client asks, then phc2sys", true),
  };
}

}  // namespace simbench
