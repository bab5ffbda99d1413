#include "algorithms/host_sync/ptp/sptp.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/outcome.h"
#include "algorithms/host_sync/ptp/ptp_clocks.h"
#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// Before the servo has its first frequency.
constexpr int kStartUpExchanges = 5;

Task<void> serve_sptp_client(Host& host, PeerId client, StampSource source,
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
        servo_(servo_settings(host, settings)),
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
  static ServoSettings servo_settings(Host& host, const SptpSettings& settings) {
    ServoSettings servo = limited_by(host, clock_of(settings.stamps), settings.servo_limits);
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
                           .t4 = HostTime(Nanoseconds(exchange.t2)),
                           .is_estimated = settings_.stamps == StampSource::kProgram});
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

Task<void> serve_sptp(Host& host, std::vector<PeerId> clients, SptpSettings settings) {
  const auto serve = [&host, settings](PeerId client, std::shared_ptr<const bool> is_ready) {
    return serve_sptp_client(host, client, settings.stamps, std::move(is_ready));
  };
  return serve_slaves(host, std::move(clients), settings.stamps, settings.servo_limits, serve);
}

Task<void> follow_sptp(Host& host, PeerId server, SptpSettings settings) {
  SptpClient client(host, server, settings);
  co_await client.run();
}

void SptpSettings::bind(ParameterBinder& parameters) {
  const char* const by_default = "facebook/time, ptp/sptp/client/config.go: default";
  const char* const example = "facebook/time, ptp/sptp/README.md: its example";
  bind_warm_up(parameters, service_time);
  parameters.log2_seconds("log_interval", interval, -7, 12,
                          "log2 of the seconds between two exchanges", by_default);
  parameters.number("exchange_timeout_ms", exchange_timeout, 1, 1e6,
                    "an exchange that takes longer (or half of the interval) is lost", by_default);
  parameters.number("path_delay_filter_length", path_delay.length, 1, 1e4,
                    "path delays of the median", example);
  parameters.number("discard_below_us", path_delay.discard_below, 0, 1e6,
                    "shorter path delays are discarded",
                    "assumption: 0; the README's example has 2, its network's least delay");
  parameters.number("discard_from_us", path_delay.discard_from, 0, 1e6,
                    "longer path delays are discarded if they exceed the multiple", example);
  parameters.number("discard_multiplier", path_delay.multiplier, 2, 1e6, "of the path delay",
                    example);
  servo_limits.bind_first_step(parameters, "facebook/time, servo/servo.go; its example has 1 s");
  servo_limits.bind_max_frequency(
      parameters, stamps == StampSource::kCard
                      ? "facebook/time, phc: MaxFreqAdjPPB, the driver's max_adj"
                      : "facebook/time, clock: MaxFreqPPB, the kernel's tolerance of 500 ppm");
  bind_software_stamps(parameters, stamps);
}

namespace {

HostSyncEntry sptp(std::string name, std::string summary, StampSource stamps) {
  SptpSettings settings{.stamps = stamps};
  if (stamps == StampSource::kCard) settings.servo_limits = {};
  return with_settings<HostSyncEntry>(
      {.name = std::move(name),
       .family = "sptp",
       .summary = std::move(summary),
       .source = "facebook/time, ptp/sptp (docs/reference/host_sync.md section 1)",
       .needs = needs_of(stamps)},
      settings, kMake<Sptp>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_sptp() {
  return {
      sptp("sptp_software", "SPTP with software stamps: the client asks, once a second",
           StampSource::kKernel),
      sptp("sptp_hardware",
           "SPTP with the network cards' stamps and clocks: the client asks, then phc2sys",
           StampSource::kCard),
  };
}

}  // namespace simbench
