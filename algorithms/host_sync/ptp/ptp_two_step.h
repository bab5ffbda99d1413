// Two-step messages of PTP: one that is sent, and when it left.
//
// Stamps are counts of nanoseconds of the clock that stamps (stamps.h).
// Source: IEEE 1588-2008 clauses 11.3 and 11.4; IEEE 802.1AS-2020, 11.2.
//
//   MessageStamps stamps(host, StampSource::kCard);
//   const auto departure = co_await send_stamped(channel, stamps, {.type = PtpType::kSync});
//   if (departure) co_await channel.send(Bytes(44));
#pragma once

#include <cstdint>
#include <optional>

#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"

namespace simbench {

// Sends the message. When it left; nothing if it was not stamped.
Task<std::optional<std::int64_t>> send_stamped(MessageChannel& channel, MessageStamps& stamps,
                                               PtpMessage message);

// Answers a Pdelay_Req that arrived then, by Pdelay_Resp and its Follow_Up, in which the request's
// correction goes back. `answer`: who answers, in which domain and protocol.
Task<void> answer_peer_delay(MessageChannel& channel, MessageStamps& stamps, PtpMessage request,
                             std::int64_t arrival, PtpMessage answer);

}  // namespace simbench
