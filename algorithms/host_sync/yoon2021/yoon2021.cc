// Algorithm 1: operation at the master host.
// Algorithm 2: operation at the slave host.
#include "algorithms/host_sync/yoon2021/yoon2021.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/messages.h"
#include "algorithms/registry.h"

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

// The next message of this kind, pass and index; others are late, duplicated or foreign.
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

// Sends the master's clock n_d times. False if the slave stopped its requests.
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

// One turn of the loop of Algorithm 1; nothing if the slave is silent.
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

// Runs passes until one is within the threshold, or a limit is reached. Does not notify the slave.
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

namespace {

struct SlaveSession {
  const Yoon2021Settings& settings;
  Host& host;
  MessageChannel& channel;
};

using MaybeMessage = std::optional<SessionMessage>;

// Whether the message ends the pass: a later READY, or the end of the session.
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

// The master's next message of `kind` (with `index`, if given) in this pass, or one that ends the
// pass. Nothing if the master is silent for too long.
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

// The first READY; nothing if this slave's turn does not come.
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

// The time synchronisation delay t_t, and its two parts.
struct TimeDelay {
  Nanoseconds t_t{0};
  Nanoseconds get{0};
  Nanoseconds set{0};
};

// Each call sets the clock to a reading that has aged.
Task<TimeDelay> measure_time_delay(SlaveSession session) {
  const SteadyClock& steady = session.host.steady_clock();
  HostClock& clock = session.host.clock();
  Nanoseconds get{0};
  Nanoseconds set{0};
  for (std::uint32_t i = 0; i < session.settings.clock_calls; ++i) {
    const SteadyTime tic = steady.now();
    const HostTime now = co_await clock.now();
    const SteadyTime has_read = steady.now();
    co_await clock.set(now);
    const SteadyTime toc = steady.now();
    get += has_read - tic;
    set += toc - has_read;
  }
  const std::int64_t calls{session.settings.clock_calls};
  co_return TimeDelay{.t_t = (get + set) / (2 * calls), .get = get / calls, .set = set / calls};
}

// One turn of the loop of Algorithm 2. Returns the message that the next turn begins with.
Task<MaybeMessage> run_slave_pass(SlaveSession session, std::uint32_t pass) {
  const Yoon2021Settings& settings = session.settings;
  const SteadyClock& steady = session.host.steady_clock();
  const SteadyTime begin = steady.now();
  const NetworkDelay network = co_await measure_network_delay(session, pass);
  if (!network.complete) co_return network.interruption;
  const TimeDelay time = co_await measure_time_delay(session);
  Nanoseconds t_d{0};
  if (settings.add_network_delay) t_d += network.t_l;
  if (settings.add_time_delay) t_d += time.t_t;
  Bytes measured = encode({MessageKind::kMeasured, pass, 0, HostTime{}});
  co_await session.channel.send(std::move(measured));

  const MaybeMessage set_time =
      co_await receive_next(session, MessageKind::kSetTime, pass, std::nullopt);
  if (!set_time || set_time->kind != MessageKind::kSetTime) co_return set_time;
  HostClock& clock = session.host.clock();
  co_await clock.set(set_time->time + t_d);
  const SteadyTime end = steady.now();
  const HostTime t_s = co_await clock.now();
  Bytes slave_time = encode({MessageKind::kSlaveTime, pass, 0, t_s});
  co_await session.channel.send(std::move(slave_time));
  session.host.report_delays({.slave = session.host.id(),
                              .pass = pass,
                              .begin = begin,
                              .end = end,
                              .t_l = network.t_l,
                              .t_t = time.t_t,
                              .t_d = t_d,
                              .get = time.get,
                              .set = time.set});

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

namespace {

const char* const kNotPublished =
    "not published; a fit (docs/reference/calibration.md section 1, FIT-C)";
const char* const kRepair = "assumption; not part of the printed algorithm";

}  // namespace

void Yoon2021Settings::bind(ParameterBinder& parameters) {
  parameters.number("stamps", stamps, 1, 1e6, "n_d, the stamps whose mean is t_l", kNotPublished);
  parameters.number("clock_calls", clock_calls, 1, 1e6,
                    "n_c, the calls of get and set whose mean is t_t", kNotPublished);
  parameters.number("threshold_ms", threshold, 0, 1e6, "T_th, largest accepted delay",
                    kNotPublished);
  parameters.number("send_interval_ms", send_interval, 0, 1e5,
                    "pace of the stamps; 0: as fast as they can be sent",
                    "Yoon et al. 2021, Algorithm 1");
  parameters.number("pass_limit", pass_limit, 1, 1e6,
                    "passes after which the master ends the session", kRepair);
  parameters.number("session_gap_ms", session_gap, 0, 1e6,
                    "pause between the sessions of two slaves",
                    "docs/reference/calibration.md section 1 (gap)");
  parameters.number("parallel_sessions", parallel_sessions, 1, 1e4,
                    "groups of slaves that are synchronised concurrently",
                    "Yoon et al. 2021, section 3: slaves in turn");
  parameters.choice("latency_estimate", ask_for_stamps, {{"literal", false}, {"intended", true}},
                    "t_l as printed (mean spacing of the stamps), or half the mean round trip",
                    "docs/reference/paper.md section 4, defect 1");
  parameters.choice("transport", transport,
                    {{"stream", Transport::kStream}, {"datagram", Transport::kDatagram}},
                    "transport of the messages", kNotPublished);
  parameters.number("receive_timeout_ms", receive_timeout, 1, 1e7,
                    "silence that ends a pass; must cover the slave's clock_calls", kRepair);
  parameters.number("turn_timeout_s", turn_timeout, 1, 1e7, "how long a slave waits for its turn",
                    kRepair);
}

namespace {

HostSyncEntry yoon2021(std::string name, std::string summary, bool add_network_delay,
                       bool add_time_delay) {
  return with_settings<HostSyncEntry>(
      {.name = std::move(name),
       .family = "yoon2021",
       .summary = std::move(summary),
       .source = "Yoon et al. 2021, Sensors 21(18) 6276, Algorithms 1 and 2, Tables 2 and 3"},
      Yoon2021Settings{.add_network_delay = add_network_delay, .add_time_delay = add_time_delay},
      kMake<Yoon2021>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_yoon2021() {
  return {
      yoon2021("yoon2021_network", "the paper's row Network: t_d = t_l", true, false),
      yoon2021("yoon2021_time", "the paper's row Time: t_d = t_t", false, true),
      yoon2021("yoon2021_both", "the paper's proposal: t_d = t_l + t_t", true, true),
      yoon2021("yoon2021_neither", "the paper's protocol without compensation: t_d = 0", false,
               false),
  };
}

}  // namespace simbench
