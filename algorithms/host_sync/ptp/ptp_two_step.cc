#include "algorithms/host_sync/ptp/ptp_two_step.h"

#include <utility>

namespace simbench {

Task<std::optional<std::int64_t>> send_stamped(MessageChannel& channel, MessageStamps& stamps,
                                               PtpMessage message) {
  Bytes bytes = encode(message);
  const MessageId id = co_await channel.send(std::move(bytes));
  co_return co_await stamps.departure(channel, id);
}

Task<void> answer_peer_delay(MessageChannel& channel, MessageStamps& stamps, PtpMessage request,
                             std::int64_t arrival, PtpMessage answer) {
  answer.type = PtpType::kPeerDelayResponse;
  answer.sequence = request.sequence;
  answer.time_ns = arrival;
  answer.asked_by = request.sender;
  const std::optional<std::int64_t> departure = co_await send_stamped(channel, stamps, answer);
  if (!departure) co_return;
  answer.type = PtpType::kPeerDelayFollowUp;
  answer.correction = request.correction;
  answer.time_ns = *departure;
  Bytes follow_up = encode(answer);
  co_await channel.send(std::move(follow_up));
}

}  // namespace simbench
