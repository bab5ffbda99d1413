// Algorithm 2: operation at the slave host.
#include <optional>
#include <utility>

#include "algorithms/host_sync/yoon2021/wire.h"
#include "algorithms/host_sync/yoon2021/yoon2021.h"

namespace simbench {
namespace {

struct SlaveSession {
  const Yoon2021Settings& settings;
  Host& host;
  MessageChannel& channel;
};

using MaybeMessage = std::optional<SessionMessage>;

// Whether this ends the pass: a later READY, or the end of the session.
bool ends_pass(const SessionMessage& message, std::uint32_t pass) {
  switch (message.kind) {
    case MessageKind::kReady:
      return message.pass > pass;
    case MessageKind::kSuccess:
    case MessageKind::kGiveUp:
      return true;
    default:
      return false;
  }
}

// What the master sends next that matters in this pass: a message of `kind` (with `index`, if one
// is given), or one that ends the pass. Nothing if the master is silent for too long.
Task<MaybeMessage> receive_next(SlaveSession session, MessageKind kind, std::uint32_t pass,
                                std::optional<std::uint32_t> index) {
  const Nanoseconds patience = Yoon2021::kSlavePatience * silence_limit(session.settings);
  const SteadyTime deadline = session.host.steady_clock().now() + patience;
  while (true) {
    std::optional<ReceivedMessage> received = co_await session.channel.receive(deadline);
    if (!received) co_return std::nullopt;
    const MaybeMessage message = decode_session_message(received->bytes);
    if (!message) continue;
    if (ends_pass(*message, pass)) co_return message;
    if (message->kind != kind || message->pass != pass) continue;
    if (!index || *index == message->index) co_return message;
  }
}

// The first READY, or nothing if this slave's turn does not come.
Task<MaybeMessage> wait_for_turn(SlaveSession session) {
  const SteadyTime deadline = session.host.steady_clock().now() + session.settings.turn_timeout;
  while (true) {
    std::optional<ReceivedMessage> received = co_await session.channel.receive(deadline);
    if (!received) co_return std::nullopt;
    const MaybeMessage message = decode_session_message(received->bytes);
    if (message && ends_pass(*message, 0)) co_return message;
  }
}

// The network synchronisation delay t_l. `interruption` is what came instead of a stamp.
struct NetworkDelay {
  Nanoseconds t_l{0};
  bool complete = false;
  MaybeMessage interruption;
};

Task<NetworkDelay> measure_network_delay(SlaveSession session, std::uint32_t pass) {
  const Yoon2021Settings& settings = session.settings;
  const SteadyClock& steady = session.host.steady_clock();
  NetworkDelay result;
  Nanoseconds sum{0};
  for (std::uint32_t i = 0; i < settings.stamps; ++i) {
    if (settings.ask_for_stamps && settings.send_interval > Nanoseconds{0}) {
      co_await session.host.sleep_for(settings.send_interval);
    }
    std::optional<std::uint32_t> index;
    const SteadyTime tic = steady.now();
    if (settings.ask_for_stamps) {
      index = i;
      Bytes request = encode({MessageKind::kRequest, pass, i, HostTime{}});
      co_await session.channel.send(std::move(request));
    }
    const MaybeMessage message = co_await receive_next(session, MessageKind::kStamp, pass, index);
    const SteadyTime toc = steady.now();
    if (!message || message->kind != MessageKind::kStamp) {
      result.interruption = message;
      co_return result;
    }
    sum += toc - tic;
  }
  result.t_l = sum / (settings.ask_for_stamps ? 2 * std::int64_t{settings.stamps}
                                              : std::int64_t{settings.stamps});
  result.complete = true;
  co_return result;
}

// The time synchronisation delay t_t. Each call really sets the clock, to a reading that has aged.
Task<Nanoseconds> measure_time_delay(SlaveSession session) {
  const SteadyClock& steady = session.host.steady_clock();
  HostClock& clock = session.host.clock();
  Nanoseconds sum{0};
  for (std::uint32_t i = 0; i < session.settings.clock_calls; ++i) {
    const SteadyTime tic = steady.now();
    const HostTime now = co_await clock.now();
    co_await clock.set(now);
    const SteadyTime toc = steady.now();
    sum += toc - tic;
  }
  co_return sum / (2 * std::int64_t{session.settings.clock_calls});
}

// One turn of the loop of Algorithm 2. Returns the message that the next turn begins with.
Task<MaybeMessage> run_slave_pass(SlaveSession session, std::uint32_t pass) {
  const Yoon2021Settings& settings = session.settings;
  const NetworkDelay network = co_await measure_network_delay(session, pass);
  if (!network.complete) co_return network.interruption;
  const Nanoseconds t_t = co_await measure_time_delay(session);
  Nanoseconds t_d{0};
  if (settings.add_network_delay) t_d += network.t_l;
  if (settings.add_time_delay) t_d += t_t;
  Bytes measured = encode({MessageKind::kMeasured, pass, 0, HostTime{}});
  co_await session.channel.send(std::move(measured));

  const MaybeMessage set_time =
      co_await receive_next(session, MessageKind::kSetTime, pass, std::nullopt);
  if (!set_time || set_time->kind != MessageKind::kSetTime) co_return set_time;
  HostClock& clock = session.host.clock();
  co_await clock.set(set_time->time + t_d);
  const HostTime t_s = co_await clock.now();
  Bytes slave_time = encode({MessageKind::kSlaveTime, pass, 0, t_s});
  co_await session.channel.send(std::move(slave_time));

  const MaybeMessage next =
      co_await receive_next(session, MessageKind::kReady, pass + 1, std::nullopt);
  co_return next;
}

}  // namespace

Task<void> Yoon2021::run_slave(Host& host, PeerId master) {
  const SlaveSession session{settings_, host, host.open_channel(master, settings_.transport)};
  MaybeMessage message = co_await wait_for_turn(session);
  while (message && message->kind == MessageKind::kReady) {
    const std::uint32_t pass = message->pass;
    message = co_await run_slave_pass(session, pass);
  }
}

}  // namespace simbench
