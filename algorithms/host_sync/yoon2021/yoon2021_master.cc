// Algorithm 1: operation at the master host.
#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/yoon2021/wire.h"
#include "algorithms/host_sync/yoon2021/yoon2021.h"

namespace simbench {
namespace {

struct MasterSession {
  const Yoon2021Settings& settings;
  Host& host;
  MessageChannel& channel;
  PeerId slave;
};

struct PassResult {
  Nanoseconds round_trip;  // T_r - T_m
  Nanoseconds delay;       // max(T_r - T_m, T_r - T_s)
};

// The next message of this kind, pass and index; whatever else comes is late, doubled or foreign.
Task<std::optional<SessionMessage>> receive_answer(MasterSession session, MessageKind kind,
                                                   std::uint32_t pass, std::uint32_t index) {
  const SteadyTime deadline = session.host.steady_clock().now() + silence_limit(session.settings);
  while (true) {
    std::optional<ReceivedMessage> received = co_await session.channel.receive(deadline);
    if (!received) co_return std::nullopt;
    const std::optional<SessionMessage> message = decode_session_message(received->bytes);
    if (message && message->kind == kind && message->pass == pass && message->index == index) {
      co_return message;
    }
  }
}

// The master's clock, n_d times. False if the slave stopped asking.
Task<bool> send_stamps(MasterSession session, std::uint32_t pass) {
  const Yoon2021Settings& settings = session.settings;
  const SteadyTime begin = session.host.steady_clock().now();
  for (std::uint32_t i = 0; i < settings.stamps; ++i) {
    if (settings.ask_for_stamps) {
      const std::optional<SessionMessage> request =
          co_await receive_answer(session, MessageKind::kRequest, pass, i);
      if (!request) co_return false;
    } else if (settings.send_interval > Nanoseconds{0}) {
      const Nanoseconds elapsed = session.host.steady_clock().now() - begin;
      const Nanoseconds due = settings.send_interval * (i + 1);
      if (elapsed < due) co_await session.host.sleep_for(due - elapsed);
    }
    const HostTime now = co_await session.host.clock().now();
    Bytes stamp = encode({MessageKind::kStamp, pass, i, now});
    co_await session.channel.send(std::move(stamp));
  }
  co_return true;
}

// One turn of the loop of Algorithm 1; nothing if the slave fell silent.
Task<std::optional<PassResult>> run_master_pass(MasterSession session, std::uint32_t pass) {
  Bytes ready = encode({MessageKind::kReady, pass, 0, HostTime{}});
  co_await session.channel.send(std::move(ready));
  const bool stamps_sent = co_await send_stamps(session, pass);
  if (!stamps_sent) co_return std::nullopt;
  const std::optional<SessionMessage> measured =
      co_await receive_answer(session, MessageKind::kMeasured, pass, 0);
  if (!measured) co_return std::nullopt;

  const HostTime t_m = co_await session.host.clock().now();
  Bytes set_time = encode({MessageKind::kSetTime, pass, 0, t_m});
  co_await session.channel.send(std::move(set_time));
  const std::optional<SessionMessage> answer =
      co_await receive_answer(session, MessageKind::kSlaveTime, pass, 0);
  if (!answer) co_return std::nullopt;
  const HostTime t_s = answer->time;
  const HostTime t_r = co_await session.host.clock().now();

  Exchange exchange;
  exchange.peer = session.slave;
  exchange.t1 = t_m;
  exchange.t3 = t_s;
  exchange.t4 = t_r;
  session.host.report_exchange(exchange);
  co_return PassResult{t_r - t_m, std::max(t_r - t_m, t_r - t_s)};
}

std::string milliseconds(Nanoseconds interval) {
  std::ostringstream text;
  text.precision(4);
  text << to_ms(interval) << " ms";
  return text.str();
}

std::string passes(std::uint32_t count) {
  return std::to_string(count) + (count == 1 ? " pass" : " passes");
}

std::string silence_message(PeerId slave, const Yoon2021Settings& settings) {
  return "slave " + std::to_string(slave) + ": no complete answer within " +
         milliseconds(settings.receive_timeout) + " in " + passes(Yoon2021::kSilentPassLimit) +
         " in a row; is it running and reachable, and does the transport lose messages?";
}

std::string limit_message(PeerId slave, const Yoon2021Settings& settings,
                          const std::optional<PassResult>& smallest) {
  const std::string begin = "slave " + std::to_string(slave) + ": not synchronised after " +
                            passes(settings.pass_limit) + ": ";
  const std::string threshold = "the threshold is " + milliseconds(settings.threshold);
  if (!smallest) return begin + "none was answered completely";
  if (smallest->round_trip > settings.threshold) {
    return begin + "the smallest round trip seen was " + milliseconds(smallest->round_trip) + ", " +
           threshold + "; a threshold_ms above the round trip can be met";
  }
  return begin + "its clock stayed behind: the smallest delay seen was " +
         milliseconds(smallest->delay) + ", " + threshold;
}

// Passes until one is within the threshold, or a limit is reached. The slave is not told yet.
Task<SyncOutcome> run_passes(MasterSession session) {
  const Yoon2021Settings& settings = session.settings;
  SyncOutcome outcome;
  outcome.slave = session.slave;
  std::optional<PassResult> smallest;  // each member by itself
  std::uint32_t silent = 0;
  while (outcome.passes < settings.pass_limit) {
    ++outcome.passes;
    const std::optional<PassResult> result = co_await run_master_pass(session, outcome.passes);
    if (!result) {
      if (++silent < Yoon2021::kSilentPassLimit) continue;
      outcome.message = silence_message(session.slave, settings);
      co_return outcome;
    }
    silent = 0;
    if (result->delay <= settings.threshold) {
      outcome.synchronised = true;
      co_return outcome;
    }
    if (!smallest) smallest = result;
    smallest->round_trip = std::min(smallest->round_trip, result->round_trip);
    smallest->delay = std::min(smallest->delay, result->delay);
  }
  outcome.message = limit_message(session.slave, settings, smallest);
  co_return outcome;
}

Task<void> run_session(MasterSession session) {
  const SyncOutcome outcome = co_await run_passes(session);
  const MessageKind kind = outcome.synchronised ? MessageKind::kSuccess : MessageKind::kGiveUp;
  Bytes end = encode({kind, outcome.passes, 0, HostTime{}});
  co_await session.channel.send(std::move(end));
  session.host.report_outcome(outcome);
}

Task<void> run_sessions_in_turn(const Yoon2021Settings& settings, Host& host,
                                std::vector<PeerId> slaves) {
  bool first = true;
  for (const PeerId slave : slaves) {
    if (!first) co_await host.sleep_for(settings.session_gap);
    first = false;
    const MasterSession session{settings, host, host.open_channel(slave, settings.transport),
                                slave};
    co_await run_session(session);
  }
}

}  // namespace

Task<void> Yoon2021::run_master(Host& host, std::vector<PeerId> slaves) {
  const std::size_t groups = std::min<std::size_t>(settings_.parallel_sessions, slaves.size());
  if (groups <= 1) {
    co_await run_sessions_in_turn(settings_, host, std::move(slaves));
    co_return;
  }
  std::vector<Task<void>> tasks;
  for (std::size_t group = 0; group < groups; ++group) {
    std::vector<PeerId> members;
    for (std::size_t i = group; i < slaves.size(); i += groups) members.push_back(slaves[i]);
    tasks.push_back(run_sessions_in_turn(settings_, host, std::move(members)));
  }
  co_await join_all(std::move(tasks));
}

}  // namespace simbench
