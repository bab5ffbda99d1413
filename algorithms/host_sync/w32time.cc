#include "algorithms/host_sync/w32time.h"

#include <chrono>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/ntp_packet.h"
#include "algorithms/host_sync/w32time_spikes.h"

namespace simbench {
namespace {

constexpr double kUnitNs = 100;             // unit of the adjustment
constexpr double kClockRateUnits = 156250;  // one tick, 15.625 ms
constexpr double kPollFactor = 16;
constexpr Nanoseconds kIdle = std::chrono::hours(1);  // a server's wait is endless, in steps

constexpr std::uint8_t kStratumLocal = 1;
constexpr std::uint8_t kStratumMax = 15;
constexpr std::uint32_t kReferenceLocal = 0x4C4F434C;      // "LOCL"
constexpr std::uint32_t kLocalClockDispersion = 10 << 16;  // 10 s, the documented default
constexpr std::int8_t kPrecision = -23;                    // 100 ns

Nanoseconds magnitude(Nanoseconds interval) {
  return interval < Nanoseconds{0} ? -interval : interval;
}

// The reply to a request, without t3.
NtpPacket reply_to(const NtpPacket& request, HostTime t2) {
  NtpPacket reply;
  reply.version = request.version;
  reply.mode = kNtpModeServer;
  reply.stratum = kStratumLocal;
  reply.poll = request.poll;
  reply.precision = kPrecision;
  reply.root_dispersion = kLocalClockDispersion;
  reply.reference_id = kReferenceLocal;
  reply.reference = to_ntp(t2);
  reply.origin = request.transmit;
  reply.receive = to_ntp(t2);
  return reply;
}

Task<void> serve(Host& host, PeerId client) {
  MessageChannel& channel = host.open_channel(client, Transport::kDatagram);
  while (true) {
    std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received) continue;
    const std::optional<NtpPacket> request = decode_ntp_packet(received->bytes);
    if (!request || request->mode != kNtpModeClient) continue;
    NtpPacket reply = reply_to(*request, received->received);
    const HostTime t3 = co_await host.clock().now();
    reply.transmit = to_ntp(t3);
    Bytes bytes = encode(reply);
    co_await channel.send(std::move(bytes));
  }
}

// RFC 4330 section 5, and the reply must be to this very request.
bool is_valid_reply(const NtpPacket& reply, NtpTimestamp sent) {
  return reply.mode == kNtpModeServer && reply.leap != kNtpLeapAlarm && reply.stratum >= 1 &&
         reply.stratum <= kStratumMax && reply.origin == sent && reply.transmit != NtpTimestamp{};
}

// One request and its reply; t1 alone if no valid reply came in time.
Task<Exchange> exchange_with(Host& host, PeerId server) {
  MessageChannel& channel = host.open_channel(server, Transport::kDatagram);
  Exchange exchange;
  exchange.peer = server;
  const HostTime t1 = co_await host.clock().now();
  exchange.t1 = t1;
  NtpPacket request;
  request.transmit = to_ntp(t1);
  Bytes bytes = encode(request);
  co_await channel.send(std::move(bytes));
  const SteadyTime deadline = host.steady_clock().now() + W32Time::kReplyTimeout;
  while (true) {
    std::optional<ReceivedMessage> received = co_await channel.receive(deadline);
    if (!received) co_return exchange;
    const std::optional<NtpPacket> reply = decode_ntp_packet(received->bytes);
    if (!reply || !is_valid_reply(*reply, request.transmit)) continue;
    exchange.t2 = from_ntp(reply->receive, t1);
    exchange.t3 = from_ntp(reply->transmit, t1);
    exchange.t4 = received->received;
    co_return exchange;
  }
}

Task<void> correct(Host& host, Nanoseconds offset, W32TimeSettings settings) {
  const W32TimeCorrection correction = w32time_correction(offset, settings);
  if (!correction.set) {
    co_await host.clock().slew(offset, correction.rate_ppb);
    co_return;
  }
  const HostTime now = co_await host.clock().now();
  co_await host.clock().set(now + offset);
}

// Asks until there is an answer, and corrects the clock by it. `spikes` must outlive the call.
Task<SyncOutcome> poll(Host& host, PeerId server, W32TimeSettings settings, W32TimeSpikes& spikes) {
  SyncOutcome outcome;
  outcome.slave = host.id();
  for (int request = 0; request < W32Time::kRequestLimit; ++request) {
    ++outcome.passes;
    const Exchange exchange = co_await exchange_with(host, server);
    if (!exchange.t4) continue;
    host.report_exchange(exchange);
    const Nanoseconds offset = clock_offset(*exchange.t1, *exchange.t2, *exchange.t3, *exchange.t4);
    if (settings.max_phase_correction && magnitude(offset) > *settings.max_phase_correction) {
      outcome.message = "slave " + std::to_string(host.id()) + ": the clock is off by " +
                        std::to_string(to_seconds(offset)) +
                        " s, more than W32Time corrects (MaxPosPhaseCorrection " +
                        std::to_string(to_seconds(*settings.max_phase_correction)) +
                        " s); set it by hand";
      co_return outcome;
    }
    if (spikes.accept(offset, host.steady_clock().now())) {
      co_await correct(host, offset, settings);
    }
    outcome.synchronised = true;
    co_return outcome;
  }
  outcome.message = "slave " + std::to_string(host.id()) + ": no valid reply from time server " +
                    std::to_string(server) + " to " + std::to_string(W32Time::kRequestLimit) +
                    " requests; is it running and reachable?";
  co_return outcome;
}

}  // namespace

W32TimeSettings w32time_domain_settings() {
  W32TimeSettings settings;
  settings.poll_interval = from_ms(1024e3);
  settings.phase_correct_rate = 1;
  settings.max_allowed_phase_offset = from_ms(300e3);
  settings.max_phase_correction.reset();
  settings.service_time = from_ms(4 * 3600e3);
  settings.start_spread = from_ms(1024e3);
  return settings;
}

W32TimeCorrection w32time_correction(Nanoseconds offset, const W32TimeSettings& settings) {
  const Nanoseconds size = magnitude(offset);
  const double units = static_cast<double>(size.count()) / kUnitNs;
  W32TimeCorrection correction;
  correction.units_per_tick =
      units / (kPollFactor * settings.phase_correct_rate * to_seconds(settings.poll_interval));
  correction.rate_ppb = correction.units_per_tick / kClockRateUnits * 1e9;
  correction.set =
      size >= settings.max_allowed_phase_offset || correction.units_per_tick > kClockRateUnits / 2;
  return correction;
}

Task<void> W32Time::run_master(Host& host, std::vector<PeerId> slaves) {
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size());
  for (const PeerId slave : slaves) servers.push_back(serve(host, slave));
  co_await join_all(std::move(servers));
}

Task<void> W32Time::run_slave(Host& host, PeerId master) {
  const double part = host.random_uniform();
  co_await host.sleep_for(from_ms(part * to_ms(settings_.start_spread)));
  W32TimeSpikes spikes;
  bool reported = false;
  while (true) {
    const SyncOutcome outcome = co_await poll(host, master, settings_, spikes);
    if (!reported) host.report_outcome(outcome);
    reported = true;
    co_await host.sleep_for(settings_.poll_interval);
  }
}

}  // namespace simbench
