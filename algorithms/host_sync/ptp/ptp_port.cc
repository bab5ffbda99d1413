#include "algorithms/host_sync/ptp/ptp_port.h"

#include <algorithm>
#include <string>
#include <utility>

#include "algorithms/host_sync/ptp/ptp_two_step.h"

namespace simbench {
namespace {

constexpr int kStartUpIntervals = 5;

ServoSettings port_servo_settings(const PtpSettings& settings) {
  ServoSettings servo = settings.servo_limits;
  servo.interval_s = to_seconds(settings.sync_interval);
  return servo;
}

PiServo make_pi(const PtpSettings& settings) {
  const bool is_card = settings.stamps == StampSource::kCard;
  return PiServo(is_card ? PiServo::kHardwareStamps : PiServo::kSoftwareStamps,
                 port_servo_settings(settings));
}

std::unique_ptr<Servo> make_port_servo(const PtpSettings& settings) {
  if (settings.servo == ServoKind::kPi) return std::make_unique<PiServo>(make_pi(settings));
  return std::make_unique<LinearRegressionServo>(port_servo_settings(settings));
}

// What the clock that stamps takes.
PtpSettings with_limits_of(Host& host, PtpSettings settings) {
  settings.servo_limits = limited_by(host, clock_of(settings.stamps), settings.servo_limits);
  return settings;
}

std::uint8_t domain_of(const PtpSettings& settings) {
  return static_cast<std::uint8_t>(settings.domain);
}

bool is_foreign(const PtpMessage& message, const PtpSettings& settings) {
  return message.is_generalised || message.domain != settings.domain;
}

// Until there is a first offset and a frequency: some Syncs, and what the PI servo waits.
Nanoseconds start_up_time(const PtpSettings& settings) {
  const double servo_s =
      settings.servo == ServoKind::kPi ? make_pi(settings).first_frequency_s() : 0;
  return settings.patience + from_seconds(servo_s) +
         kStartUpIntervals * (settings.sync_interval + settings.delay_interval);
}

}  // namespace

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
    // The slave will report that no Sync came.
    if (!stamps_.lacking().empty()) co_return;
  }
}

Task<void> PtpMaster::send_sync() {
  PtpMessage message{.type = PtpType::kSync,
                     .sender = host_.id(),
                     .sequence = ++sequence_,
                     .domain = domain_of(settings_)};
  const std::optional<std::int64_t> departure = co_await send_stamped(channel(), stamps_, message);
  if (!departure) co_return;
  message.type = PtpType::kFollowUp;
  message.time_ns = *departure;
  Bytes follow_up = encode(message);
  co_await channel().send(std::move(follow_up));
}

Task<void> PtpMaster::answer(ReceivedMessage received) {
  const std::optional<PtpMessage> request = decode_ptp_message(received.bytes);
  if (!request || is_foreign(*request, settings_)) co_return;
  const std::optional<std::int64_t> arrival = stamps_.arrival(received);
  if (!arrival) co_return;
  if (request->type == PtpType::kPeerDelayRequest) {
    // To a request that the network delivered twice there would be two answers, whose halves the
    // slave could not tell apart: the departure of the one, the arrival of the other.
    if (std::exchange(answered_, request->sequence) == request->sequence) co_return;
    co_await answer_peer_delay(channel(), stamps_, *request, *arrival,
                               {.sender = host_.id(), .domain = domain_of(settings_)});
    co_return;
  }
  if (request->type != PtpType::kDelayRequest) co_return;
  // The request's correction goes back to the slave, which takes it out.
  Bytes response = encode({.type = PtpType::kDelayResponse,
                           .sender = host_.id(),
                           .sequence = request->sequence,
                           .correction = request->correction,
                           .time_ns = *arrival,
                           .asked_by = request->sender,
                           .domain = domain_of(settings_)});
  co_await channel().send(std::move(response));
}

namespace {

// A Sync this much older than the last one is no late copy: the master has restarted.
constexpr int kLateSyncs = 64;

}  // namespace

PtpSlave::PtpSlave(Host& host, PeerId master, PtpSettings settings)
    : host_(host),
      master_(master),
      settings_(settings),
      servo_(make_port_servo(with_limits_of(host, settings))),
      stamps_(host, settings.stamps),
      offset_(settings.median_length),
      outcome_(host) {
  if (settings.stamps == StampSource::kCard && host.hardware_clock() != nullptr) {
    coupling_.emplace(host, ClockKind::kSystem, settings.servo_limits);
  }
}

Task<void> PtpSlave::run() {
  begin_ = host_.steady_clock().now();
  const double part = host_.random_uniform();
  SteadyTime next_request = begin_ + from_ms(part * to_ms(settings_.delay_interval));
  SteadyTime next_coupling = SteadyTime::max();
  while (stamps_.lacking().empty()) {
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
    if (coupling_ && *is_locked_ && next_coupling == SteadyTime::max()) next_coupling = now;
    if (now >= next_coupling) {
      next_coupling = now + ClockCoupling::kInterval;
      co_await coupling_->update();
    }
    report_outcome_if_due();
  }
  outcome_.failed(0, stamps_.lacking());
}

Task<void> PtpSlave::ask() {
  const PtpType type =
      settings_.is_peer_delay ? PtpType::kPeerDelayRequest : PtpType::kDelayRequest;
  const PtpMessage message{
      .type = type, .sender = host_.id(), .sequence = ++sequence_, .domain = domain_of(settings_)};
  request_.reset();
  peer_response_.reset();
  peer_follow_up_.reset();
  const std::optional<std::int64_t> departure = co_await send_stamped(channel(), stamps_, message);
  if (departure) request_ = Half{message, *departure};
}

Task<void> PtpSlave::take(ReceivedMessage received) {
  const std::optional<PtpMessage> message = decode_ptp_message(received.bytes);
  if (!message || is_foreign(*message, settings_)) co_return;
  const std::optional<std::int64_t> arrival = stamps_.arrival(received);
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
  offset_.add_request(request_->stamp, arrived, servo_->rate_ratio());
  if (offset_.sync()) report(request_->stamp, arrived, offset_.sync()->t1, offset_.sync()->t2);
  request_.reset();
}

void PtpSlave::take_peer_delay() {
  // The follow-up brings the request's correction back. The delay is the same whichever stamp it is
  // taken from; what is reported has each taken out of its own way, since out of the other it would
  // put an arrival before the departure.
  const std::int64_t there = correction_of(*peer_follow_up_).count();
  const std::int64_t back = correction_of(peer_response_->message).count();
  const std::int64_t t2 = peer_response_->message.time_ns;
  const std::int64_t t4 = peer_response_->stamp;
  offset_.add_peer_delay(request_->stamp, t2, peer_follow_up_->time_ns, t4 - there - back);
  report(request_->stamp, t2 - there, peer_follow_up_->time_ns, t4 - back);
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
  co_await apply_answer(host_, clock_of(settings_.stamps), answer, *offset);
  if (answer.state == ServoState::kUnlocked) co_return;
  *is_locked_ = true;
  if (answer.state != ServoState::kJump) co_return;
  // Stamps from before the step are of another clock.
  offset_.forget_sync();
  request_.reset();
  sync_.reset();
}

void PtpSlave::report(std::int64_t t1, std::int64_t t2, std::int64_t t3, std::int64_t t4) {
  if (settings_.stamps == StampSource::kCard) return;
  host_.report_exchange({.peer = master_,
                         .t1 = HostTime(Nanoseconds(t1)),
                         .t2 = HostTime(Nanoseconds(t2)),
                         .t3 = HostTime(Nanoseconds(t3)),
                         .t4 = HostTime(Nanoseconds(t4)),
                         .is_estimated = settings_.stamps == StampSource::kProgram});
}

void PtpSlave::report_outcome_if_due() {
  if (outcome_.is_reported()) return;
  if (coupling_ ? coupling_->is_locked() : *is_locked_) return outcome_.synchronised(corrections_);
  const Nanoseconds waited = host_.steady_clock().now() - begin_;
  if (waited < start_up_time(settings_)) return;
  outcome_.failed(
      corrections_,
      "the servo has not locked after " + std::to_string(static_cast<int>(to_seconds(waited))) +
          " s and " + std::to_string(corrections_) + " measured offsets; is host " +
          std::to_string(master_) + " running and reachable, in domain " +
          std::to_string(settings_.domain) + ", and does it stamp its messages as this one does?");
}

}  // namespace simbench
