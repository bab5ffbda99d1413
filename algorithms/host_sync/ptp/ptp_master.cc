#include "algorithms/host_sync/ptp/ptp_master.h"

#include <utility>

namespace simbench {

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

}  // namespace simbench
