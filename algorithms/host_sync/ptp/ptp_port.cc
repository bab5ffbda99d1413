#include "algorithms/host_sync/ptp/ptp_port.h"

#include <algorithm>
#include <string>
#include <utility>

namespace simbench {
namespace {

constexpr int kStepCalls = 3;
// An error below this needs no further call.
constexpr Nanoseconds kStepTolerance{1'000};

// The system clock's lead over the steady clock.
Task<Nanoseconds> system_lead(Host& host) {
  const HostTime reading = co_await host.clock().now();
  co_return offset_between(reading, host.steady_clock().now());
}

ServoSettings servo_settings(const PtpSettings& settings, Nanoseconds interval) {
  return {.interval_s = to_seconds(interval),
          .max_frequency_ppb = settings.max_frequency_ppm * 1e3,
          .first_step_threshold_ns = settings.first_step_threshold_us * 1e3,
          .step_threshold_ns = settings.step_threshold_us * 1e3};
}

// Adds `offset` to the system clock. A set call takes effect late by a part of its duration, so its
// effect is measured against the steady clock and the rest is set again.
Task<void> step_system_clock(Host& host, Nanoseconds offset) {
  const Nanoseconds before = co_await system_lead(host);
  const Nanoseconds wanted = before + offset;
  Nanoseconds lead = wanted;  // to be set, so that `wanted` results
  for (int call = 0; call < kStepCalls; ++call) {
    const SteadyTime now = host.steady_clock().now();
    co_await host.clock().set(HostTime(now.time_since_epoch() + lead));
    const Nanoseconds reached = co_await system_lead(host);
    const Nanoseconds missing = wanted - reached;
    if (missing < kStepTolerance && -missing < kStepTolerance) co_return;
    lead += missing;
  }
}

// Does to the clock what the servo answered; `offset` is what the servo was fed.
Task<void> apply_answer(Host& host, ClockKind kind, ServoAnswer answer, Nanoseconds offset) {
  if (answer.state == ServoState::kUnlocked) co_return;
  if (kind == ClockKind::kSystem) {
    co_await host.clock().adjust_frequency(-answer.ppb);
    if (answer.state == ServoState::kJump) co_await step_system_clock(host, -offset);
    co_return;
  }
  co_await host.hardware_clock()->adjust_frequency(-answer.ppb);
  if (answer.state == ServoState::kJump) co_await host.hardware_clock()->step(-offset);
}

// When the message left that send() has just returned from; nothing if the card did not stamp it.
Task<std::optional<std::int64_t>> departure_stamp(Host& host, MessageChannel& channel, MessageId id,
                                                  ClockKind kind) {
  const SteadyTime deadline = host.steady_clock().now() + kStampTimeout;
  if (kind == ClockKind::kHardware) {
    const std::optional<HardwareTime> stamp =
        co_await channel.hardware_transmit_stamp(id, deadline);
    if (!stamp) co_return std::nullopt;
    co_return nanoseconds_of(*stamp);
  }
  const std::optional<HostTime> stamp = co_await channel.transmit_stamp(id, deadline);
  if (stamp) co_return nanoseconds_of(*stamp);
  const HostTime now = co_await host.clock().now();
  co_return nanoseconds_of(now);
}

std::optional<std::int64_t> arrival_stamp(const ReceivedMessage& message, ClockKind kind) {
  if (kind == ClockKind::kSystem) return nanoseconds_of(message.received);
  if (!message.received_hardware) return std::nullopt;
  return nanoseconds_of(*message.received_hardware);
}

std::unique_ptr<Servo> make_port_servo(const PtpSettings& settings) {
  const ServoSettings servo = servo_settings(settings, settings.sync_interval);
  if (settings.servo == ServoKind::kLinearRegression) {
    return std::make_unique<LinearRegressionServo>(servo);
  }
  return std::make_unique<PiServo>(
      settings.has_hardware_stamps ? PiServo::kHardwareStamps : PiServo::kSoftwareStamps, servo);
}

}  // namespace

ClockCoupling::ClockCoupling(Host& host, ClockKind follower, const PtpSettings& settings)
    : host_(host),
      follower_(follower),
      servo_(PiServo::kHardwareStamps, servo_settings(settings, kInterval)) {}

Task<void> ClockCoupling::update() {
  CrossStamp best;
  Nanoseconds width = Nanoseconds::max();
  for (int i = 0; i < kCrossStamps; ++i) {
    const CrossStamp stamp = co_await host_.hardware_clock()->cross_stamp();
    if (stamp.after - stamp.before >= width) continue;
    best = stamp;
    width = stamp.after - stamp.before;
  }
  const HostTime system = best.before + width / 2;
  const Nanoseconds system_lead = offset_between(system, best.hardware);
  const bool system_follows = follower_ == ClockKind::kSystem;
  const Nanoseconds offset = system_follows ? system_lead : -system_lead;
  const std::int64_t local =
      system_follows ? nanoseconds_of(system) : nanoseconds_of(best.hardware);
  const ServoAnswer answer = servo_.sample(static_cast<double>(offset.count()), local, 1);
  co_await apply_answer(host_, follower_, answer, offset);
  if (answer.state != ServoState::kUnlocked) is_locked_ = true;
}

Task<void> PtpMaster::run() {
  const double part = host_.random_uniform();
  SteadyTime next_sync =
      host_.steady_clock().now() + from_ms(part * to_ms(settings_.sync_interval));
  while (true) {
    std::optional<ReceivedMessage> received = co_await channel().receive(next_sync);
    if (received) co_await answer(std::move(*received));
    if (host_.steady_clock().now() < next_sync) continue;
    next_sync += settings_.sync_interval;
    if (*is_ready_) co_await send_sync();
  }
}

Task<void> PtpMaster::send_sync() {
  PtpMessage message{.type = PtpType::kSync, .sender = host_.id(), .sequence = ++sequence_};
  Bytes sync = encode(message);
  const MessageId id = co_await channel().send(std::move(sync));
  const std::optional<std::int64_t> departure =
      co_await departure_stamp(host_, channel(), id, clock());
  if (!departure) co_return;
  message.type = PtpType::kFollowUp;
  message.time_ns = *departure;
  Bytes follow_up = encode(message);
  co_await channel().send(std::move(follow_up));
}

Task<void> PtpMaster::answer(ReceivedMessage received) {
  const std::optional<PtpMessage> request = decode_ptp_message(received.bytes);
  if (!request) co_return;
  const std::optional<std::int64_t> arrival = arrival_stamp(received, clock());
  if (!arrival) co_return;
  if (request->type == PtpType::kPeerDelayRequest) {
    co_await answer_peer_delay(*request, *arrival);
    co_return;
  }
  if (request->type != PtpType::kDelayRequest) co_return;
  // The request's correction goes back to the slave, which takes it out.
  Bytes response = encode({.type = PtpType::kDelayResponse,
                           .sender = host_.id(),
                           .sequence = request->sequence,
                           .correction = request->correction,
                           .time_ns = *arrival,
                           .asked_by = request->sender});
  co_await channel().send(std::move(response));
}

Task<void> PtpMaster::answer_peer_delay(PtpMessage request, std::int64_t arrival) {
  PtpMessage message{.type = PtpType::kPeerDelayResponse,
                     .sender = host_.id(),
                     .sequence = request.sequence,
                     .correction = 0,
                     .time_ns = arrival,
                     .asked_by = request.sender};
  Bytes response = encode(message);
  const MessageId id = co_await channel().send(std::move(response));
  const std::optional<std::int64_t> departure =
      co_await departure_stamp(host_, channel(), id, clock());
  if (!departure) co_return;
  message.type = PtpType::kPeerDelayFollowUp;
  message.correction = request.correction;
  message.time_ns = *departure;
  Bytes follow_up = encode(message);
  co_await channel().send(std::move(follow_up));
}

namespace {

// A Sync this much older than the last one is no late copy: the master has restarted.
constexpr int kLateSyncs = 64;

}  // namespace

PtpSlave::PtpSlave(Host& host, PeerId master, PtpSettings settings)
    : host_(host),
      master_(master),
      settings_(settings),
      servo_(make_port_servo(settings)),
      offset_(settings.median_length),
      outcome_(host) {
  if (settings.has_hardware_stamps && host.hardware_clock() != nullptr) {
    coupling_.emplace(host, ClockKind::kSystem, settings);
  }
}

Task<void> PtpSlave::run() {
  if (settings_.has_hardware_stamps && !coupling_) {
    outcome_.failed(0,
                    "the host has no hardware clock (Host::hardware_clock); use software stamps");
    co_return;
  }
  begin_ = host_.steady_clock().now();
  const double part = host_.random_uniform();
  SteadyTime next_request = begin_ + from_ms(part * to_ms(settings_.delay_interval));
  SteadyTime next_coupling = SteadyTime::max();
  while (true) {
    std::optional<ReceivedMessage> received =
        co_await channel().receive(std::min(next_request, next_coupling));
    if (received) co_await take(std::move(*received));
    const SteadyTime now = host_.steady_clock().now();
    if (now >= next_request) {
      // End to end: at random times (IEEE 1588 9.5.11.2), so that the slaves' requests do not meet.
      const double factor = settings_.is_peer_delay ? 1 : 2 * host_.random_uniform();
      next_request = now + from_ms(factor * to_ms(settings_.delay_interval));
      co_await ask();
    }
    if (coupling_ && is_locked_ && next_coupling == SteadyTime::max()) next_coupling = now;
    if (now >= next_coupling) {
      next_coupling = now + ClockCoupling::kInterval;
      co_await coupling_->update();
    }
    report_outcome_if_due();
  }
}

Task<void> PtpSlave::ask() {
  const PtpType type =
      settings_.is_peer_delay ? PtpType::kPeerDelayRequest : PtpType::kDelayRequest;
  const PtpMessage message{.type = type, .sender = host_.id(), .sequence = ++sequence_};
  request_.reset();
  peer_response_.reset();
  peer_follow_up_.reset();
  Bytes bytes = encode(message);
  const MessageId id = co_await channel().send(std::move(bytes));
  const std::optional<std::int64_t> departure =
      co_await departure_stamp(host_, channel(), id, clock());
  if (departure) request_ = Half{message, *departure};
}

Task<void> PtpSlave::take(ReceivedMessage received) {
  const std::optional<PtpMessage> message = decode_ptp_message(received.bytes);
  if (!message) co_return;
  const std::optional<std::int64_t> arrival = arrival_stamp(received, clock());
  const bool is_answer = request_ && message->sequence == request_->message.sequence &&
                         message->asked_by == host_.id();
  switch (message->type) {
    case PtpType::kSync:
      if (arrival && !is_late(message->sequence)) sync_ = Half{*message, *arrival};
      break;
    case PtpType::kFollowUp:
      sync_follow_up_ = *message;
      break;
    case PtpType::kDelayResponse:
      if (is_answer && !settings_.is_peer_delay) take_delay_response(*message);
      break;
    case PtpType::kPeerDelayResponse:
      if (is_answer && arrival) peer_response_ = Half{*message, *arrival};
      break;
    case PtpType::kPeerDelayFollowUp:
      if (is_answer) peer_follow_up_ = *message;
      break;
    default:
      co_return;
  }
  if (peer_response_ && peer_follow_up_) take_peer_delay();
  if (sync_ && sync_follow_up_ && sync_->message.sequence == sync_follow_up_->sequence) {
    co_await take_sync();
  }
}

bool PtpSlave::is_late(std::uint16_t sequence) const {
  if (!last_sync_) return false;
  const auto older_by = static_cast<std::int16_t>(*last_sync_ - sequence);
  return older_by >= 0 && older_by < kLateSyncs;
}

void PtpSlave::take_delay_response(const PtpMessage& response) {
  const std::int64_t arrived = response.time_ns - correction_of(response).count();
  offset_.add_request(request_->stamp, arrived);
  if (offset_.sync()) report(request_->stamp, arrived, offset_.sync()->t1, offset_.sync()->t2);
  request_.reset();
}

void PtpSlave::take_peer_delay() {
  const Nanoseconds correction =
      correction_of(peer_response_->message) + correction_of(*peer_follow_up_);
  const std::int64_t t4 = peer_response_->stamp - correction.count();
  offset_.add_peer_delay(request_->stamp, peer_response_->message.time_ns, peer_follow_up_->time_ns,
                         t4);
  report(request_->stamp, peer_response_->message.time_ns, peer_follow_up_->time_ns, t4);
  request_.reset();
  peer_response_.reset();
  peer_follow_up_.reset();
}

Task<void> PtpSlave::take_sync() {
  const Nanoseconds correction = correction_of(sync_->message) + correction_of(*sync_follow_up_);
  offset_.add_sync(sync_follow_up_->time_ns + correction.count(), sync_->stamp);
  last_sync_ = sync_->message.sequence;
  sync_.reset();
  sync_follow_up_.reset();
  co_await correct();
}

Task<void> PtpSlave::correct() {
  const std::optional<Nanoseconds> offset = offset_.offset();
  if (!offset) co_return;
  ++corrections_;
  const ServoAnswer answer =
      servo_->sample(static_cast<double>(offset->count()), offset_.sync()->t2, 1);
  co_await apply_answer(host_, clock(), answer, *offset);
  if (answer.state == ServoState::kUnlocked) co_return;
  is_locked_ = true;
  if (answer.state != ServoState::kJump) co_return;
  // Stamps from before the step are of another clock.
  offset_.forget_sync();
  request_.reset();
  sync_.reset();
}

void PtpSlave::report(std::int64_t t1, std::int64_t t2, std::int64_t t3, std::int64_t t4) {
  if (settings_.has_hardware_stamps) return;
  host_.report_exchange({.peer = master_,
                         .t1 = HostTime(Nanoseconds(t1)),
                         .t2 = HostTime(Nanoseconds(t2)),
                         .t3 = HostTime(Nanoseconds(t3)),
                         .t4 = HostTime(Nanoseconds(t4))});
}

void PtpSlave::report_outcome_if_due() {
  if (outcome_.is_reported()) return;
  if (coupling_ ? coupling_->is_locked() : is_locked_) return outcome_.synchronised(corrections_);
  if (host_.steady_clock().now() - begin_ < settings_.patience) return;
  outcome_.failed(corrections_,
                  "the servo has not locked after " +
                      std::to_string(static_cast<int>(to_seconds(settings_.patience))) + " s and " +
                      std::to_string(corrections_) + " measured offsets; is host " +
                      std::to_string(master_) + " running and reachable" +
                      (coupling_ ? ", and do both network cards stamp messages" : "") + "?");
}

}  // namespace simbench
