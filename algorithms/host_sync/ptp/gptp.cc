#include "algorithms/host_sync/ptp/gptp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "algorithms/host_sync/cross_stamps.h"
#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/host_sync/ptp/gptp_time.h"
#include "algorithms/host_sync/ptp/ptp_clocks.h"
#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/host_sync/ptp/ptp_two_step.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr double kCorrectionSteps = 65'536;  // of a nanosecond

// What the ports of a station share: the grandmaster's time, once a Sync has told it.
using StationTime = std::shared_ptr<std::optional<GrandmasterTime>>;

PtpMessage gptp_message(const Host& host, PtpType type, std::uint16_t sequence, int domain) {
  return {.type = type,
          .sender = host.id(),
          .sequence = sequence,
          .domain = static_cast<std::uint8_t>(domain),
          .is_generalised = true};
}

// A message of this protocol and domain.
std::optional<PtpMessage> decode_gptp(const Bytes& bytes, int domain) {
  const std::optional<PtpMessage> message = decode_ptp_message(bytes);
  if (!message || !message->is_generalised || message->domain != domain) return std::nullopt;
  return message;
}

// The port towards a station further from the grandmaster.
class TimeTransmitter {
 public:
  // The time is that of the own card where `station` is null: the grandmaster's.
  TimeTransmitter(Host& host, PeerId peer, GptpSettings settings,
                  std::shared_ptr<const bool> is_ready, StationTime station)
      : host_(host),
        peer_(peer),
        settings_(settings),
        stamps_(host, StampSource::kCard),
        is_ready_(std::move(is_ready)),
        station_(std::move(station)) {}

  // Never ends, unless the host lacks the stamps.
  Task<void> run() {
    const double part = host_.random_uniform();
    SteadyTime next_sync =
        host_.steady_clock().now() + from_ms(part * to_ms(settings_.sync_interval));
    while (stamps_.lacking().empty()) {
      std::optional<ReceivedMessage> received = co_await channel().receive(next_sync);
      if (received) co_await answer(std::move(*received));
      if (host_.steady_clock().now() < next_sync) continue;
      next_sync += settings_.sync_interval;
      if (*is_ready_ && (station_ == nullptr || *station_)) co_await send_sync();
    }
  }

 private:
  MessageChannel& channel() { return host_.open_channel(peer_, Transport::kDatagram); }

  Task<void> send_sync() {
    PtpMessage message = gptp_message(host_, PtpType::kSync, ++sequence_, settings_.domain);
    const std::optional<std::int64_t> departure =
        co_await send_stamped(channel(), stamps_, message);
    if (!departure) co_return;
    message.type = PtpType::kFollowUp;
    if (station_ == nullptr) {
      message.time_ns = *departure;
      message.scaled_rate_offset = 0;
    } else {
      const GrandmasterTime& time = **station_;
      message.time_ns = time.origin_ns;
      message.correction = std::llround(time.after_origin_at(*departure) * kCorrectionSteps);
      message.scaled_rate_offset = scaled_rate_offset(time.rate);
    }
    Bytes follow_up = encode(message);
    co_await channel().send(std::move(follow_up));
  }

  Task<void> answer(ReceivedMessage received) {
    const std::optional<PtpMessage> request = decode_gptp(received.bytes, settings_.domain);
    const std::optional<std::int64_t> arrival = stamps_.arrival(received);
    if (!request || !arrival || request->type != PtpType::kPeerDelayRequest) co_return;
    co_await answer_peer_delay(
        channel(), stamps_, *request, *arrival,
        gptp_message(host_, PtpType::kPeerDelayResponse, request->sequence, settings_.domain));
  }

  Host& host_;
  PeerId peer_;
  GptpSettings settings_;
  MessageStamps stamps_;
  std::shared_ptr<const bool> is_ready_;
  StationTime station_;
  std::uint16_t sequence_ = 0;
};

ServoSettings system_servo(Host& host, ServoSettings settings) {
  settings = limited_by(host, ClockKind::kSystem, settings);
  settings.interval_s = to_seconds(ClockCoupling::kInterval);
  return settings;
}

// The port towards the grandmaster, and the system clock's servo.
class TimeReceiver {
 public:
  TimeReceiver(Host& host, PeerId peer, GptpSettings settings)
      : host_(host),
        peer_(peer),
        settings_(settings),
        stamps_(host, StampSource::kCard),
        link_(settings.delay_exchanges),
        servo_(PiServo::kHardwareStamps, system_servo(host, settings.servo_limits)),
        outcome_(host) {}

  StationTime station() const { return station_; }

  // Never ends, unless the host lacks the stamps.
  Task<void> run() {
    begin_ = host_.steady_clock().now();
    const double part = host_.random_uniform();
    SteadyTime next_request = begin_ + from_ms(part * to_ms(settings_.delay_interval));
    SteadyTime next_steering = begin_ + ClockCoupling::kInterval;
    while (stamps_.lacking().empty()) {
      std::optional<ReceivedMessage> received =
          co_await channel().receive(std::min(next_request, next_steering));
      if (received) take(*received);
      const SteadyTime now = host_.steady_clock().now();
      if (now >= next_request) {
        next_request += settings_.delay_interval;
        co_await ask();
      }
      if (now >= next_steering) {
        next_steering += ClockCoupling::kInterval;
        if (*station_) co_await steer();
        report_if_due();
      }
    }
    outcome_.failed(0, stamps_.lacking());
  }

 private:
  MessageChannel& channel() { return host_.open_channel(peer_, Transport::kDatagram); }

  Task<void> ask() {
    const PtpMessage message =
        gptp_message(host_, PtpType::kPeerDelayRequest, ++sequence_, settings_.domain);
    request_.reset();
    response_.reset();
    request_ = co_await send_stamped(channel(), stamps_, message);
  }

  void take(const ReceivedMessage& received) {
    const std::optional<PtpMessage> message = decode_gptp(received.bytes, settings_.domain);
    if (!message) return;
    const std::optional<std::int64_t> arrival = stamps_.arrival(received);
    const bool is_answer =
        request_ && message->sequence == sequence_ && message->asked_by == host_.id();
    switch (message->type) {
      case PtpType::kSync:
        if (arrival) sync_ = Arrived{*message, *arrival};
        break;
      case PtpType::kFollowUp:
        if (sync_ && sync_->message.sequence == message->sequence) take_sync(*message);
        break;
      case PtpType::kPeerDelayResponse:
        if (is_answer && arrival) response_ = Arrived{*message, *arrival};
        break;
      case PtpType::kPeerDelayFollowUp:
        if (is_answer && response_) take_peer_delay(*message);
        break;
      default:
        break;
    }
  }

  void take_peer_delay(const PtpMessage& follow_up) {
    const Nanoseconds corrections = correction_of(response_->message) + correction_of(follow_up);
    link_.add({.t1 = *request_,
               .t2 = response_->message.time_ns,
               .t3 = follow_up.time_ns,
               .t4 = response_->stamp - corrections.count()});
    request_.reset();
    response_.reset();
  }

  bool is_capable() const {
    return link_.rate_ratio() && *link_.delay() <= settings_.most_link_delay_ns;
  }

  void take_sync(const PtpMessage& follow_up) {
    const Arrived sync = *std::exchange(sync_, std::nullopt);
    if (!is_capable() || !follow_up.scaled_rate_offset) return;
    const double rate_before = rate_of_scaled(*follow_up.scaled_rate_offset);
    const double corrections =
        static_cast<double>(sync.message.correction + follow_up.correction) / kCorrectionSteps;
    *station_ = GrandmasterTime{.origin_ns = follow_up.time_ns,
                                .local_ns = sync.stamp,
                                .after_origin_ns = corrections + rate_before * *link_.delay(),
                                .rate = rate_before * *link_.rate_ratio()};
  }

  Task<void> steer() {
    const CrossStamp best = co_await narrowest_cross_stamp(host_);
    const HostTime system = best.before + (best.after - best.before) / 2;
    const double ahead_ns = (*station_)->ahead_ns(nanoseconds_of(best.hardware));
    const Nanoseconds offset =
        offset_between(system, best.hardware) - Nanoseconds(std::llround(ahead_ns));
    const ServoAnswer answer =
        servo_.sample(static_cast<double>(offset.count()), nanoseconds_of(system), 1);
    co_await apply_answer(host_, ClockKind::kSystem, answer, offset);
    if (answer.state != ServoState::kUnlocked) outcome_.synchronised(++steered_);
  }

  void report_if_due() {
    const Nanoseconds waited = host_.steady_clock().now() - begin_;
    if (outcome_.is_reported() || waited < settings_.patience) return;
    const std::optional<double> delay = link_.delay();
    if (delay && *delay > settings_.most_link_delay_ns) {
      return outcome_.failed(
          0, fmt::format("its link to host {} takes {:.0f} ns, more than the {:g} of "
                         "most_link_delay_ns: what stands between them does not know 802.1AS; a "
                         "cable of its own does, or a switch that does (/network/switch_clock "
                         "\"transparent\")",
                         peer_, *delay, settings_.most_link_delay_ns));
    }
    outcome_.failed(0, fmt::format("no Sync of domain {} in {:.0f} s; is host {} running and "
                                   "reachable, in this domain, and does its card stamp?",
                                   settings_.domain, to_seconds(waited), peer_));
  }

  struct Arrived {
    PtpMessage message;
    std::int64_t stamp = 0;
  };

  Host& host_;
  PeerId peer_;
  GptpSettings settings_;
  MessageStamps stamps_;
  LinkDelay link_;
  PiServo servo_;
  OutcomeReport outcome_;
  StationTime station_ = std::make_shared<std::optional<GrandmasterTime>>();
  SteadyTime begin_{};
  std::uint16_t sequence_ = 0;
  std::optional<std::int64_t> request_;  // when the newest one left
  std::optional<Arrived> response_;
  std::optional<Arrived> sync_;
  std::uint32_t steered_ = 0;
};

Task<void> transmit_time(Host& host, PeerId peer, GptpSettings settings,
                         std::shared_ptr<const bool> is_ready, StationTime station) {
  TimeTransmitter port(host, peer, settings, std::move(is_ready), std::move(station));
  co_await port.run();
}

ServeSlave transmitting(Host& host, const GptpSettings& settings, StationTime station) {
  return [&host, settings, station = std::move(station)](PeerId slave,
                                                         std::shared_ptr<const bool> is_ready) {
    return transmit_time(host, slave, settings, std::move(is_ready), station);
  };
}

}  // namespace

Task<void> serve_gptp(Host& host, std::vector<PeerId> slaves, GptpSettings settings) {
  return serve_slaves(host, std::move(slaves), StampSource::kCard, settings.servo_limits,
                      transmitting(host, settings, nullptr));
}

Task<void> follow_gptp(Host& host, PeerId master, GptpSettings settings) {
  TimeReceiver port(host, master, settings);
  co_await port.run();
}

Task<void> relay_gptp(Host& host, PeerId master, std::vector<PeerId> slaves,
                      GptpSettings settings) {
  TimeReceiver port(host, master, settings);
  std::vector<Task<void>> ports;
  ports.push_back(port.run());
  ports.push_back(serve_slaves_of_relay(std::move(slaves), std::make_shared<bool>(true),
                                        transmitting(host, settings, port.station())));
  co_await join_all(std::move(ports));
}

void GptpSettings::bind(ParameterBinder& parameters) {
  const char* const profile = "linuxptp, configs/gPTP.cfg; IEEE 802.1AS-2020";
  bind_warm_up(parameters, service_time);
  parameters.log2_seconds("log_sync_interval", sync_interval, -7, 12,
                          "log2 of the seconds between two Sync messages: -3 is 8 a second",
                          profile);
  parameters.log2_seconds("log_delay_interval", delay_interval, -7, 12,
                          "log2 of the seconds between two measurements of the link", profile);
  parameters.number("delay_exchanges", delay_exchanges, 2, 1e4,
                    "measurements over which a link's delay and rate ratio are taken", kAssumption);
  parameters.number("most_link_delay_ns", most_link_delay_ns, 0, 1e9,
                    "a link that takes longer takes no Sync: neighborPropDelayThresh", profile);
  parameters.number("domain", domain, 0, 127, "domainNumber: messages of others are ignored",
                    profile);
  servo_limits.bind_first_step(parameters, "linuxptp (phc2sys), default");
  servo_limits.bind_max_frequency(parameters, "linuxptp: clockadj_max_freq()");
}

std::vector<HostSyncEntry> host_sync_gptp() {
  return {with_settings<HostSyncEntry>(
      {.name = "gptp_hardware",
       .family = "gptp",
       .summary = "generalised PTP (802.1AS): links' delays and rate ratios, relays that forward "
                  "the grandmaster's time unsteered",
       .source = "IEEE 802.1AS-2020; docs/reference/host_sync.md section 1 (gPTP)",
       .needs = needs_of(StampSource::kCard)},
      GptpSettings{}, kMake<Gptp>)};
}

}  // namespace simbench
