// Hosts for testing conversations: everything is scripted, constant, and known in nanoseconds.
//
// A ScriptWorld is a few hosts on a virtual timeline. Each host has a system clock without rate
// error (reading = time + offset), a CPU that serialises sends and clock calls, and a channel to
// every other host whose latency the test states message by message. Reading a clock is free.
//
//   ScriptWorld world(2);
//   world.host(1).costs.set = from_ms(4);
//   world.set_latency(0, 1, from_ms(0.2));
//   world.run(algorithm);
//   EXPECT_EQ(world.host(1).lead_over(world.host(0)), from_ms(-1.5));
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"

namespace simbench {

class ScriptHost;

// When the copies of the index-th message on a link arrive, as times after it has left: none if it
// is lost, two if it is duplicated.
using LinkScript = std::function<std::vector<Nanoseconds>(std::size_t index, const Bytes& bytes)>;

class ScriptWorld {
 public:
  explicit ScriptWorld(PeerId hosts);
  ~ScriptWorld();

  ScriptHost& host(PeerId id) { return *hosts_.at(id); }
  std::vector<PeerId> slaves() const;
  Nanoseconds now() const { return now_; }

  void script_link(PeerId from, PeerId to, LinkScript script);
  void set_latency(PeerId from, PeerId to, Nanoseconds latency);
  // Between the master and each slave, both ways.
  ScriptWorld& connect(Nanoseconds latency);

  // Runs coroutines until all have ended, or until `end`. Rethrows what they throw.
  void start(Task<void> task);
  void run(Nanoseconds end = Nanoseconds::max());
  // Master and slaves of an algorithm.
  void run(HostSync& algorithm, Nanoseconds end = Nanoseconds::max());
  std::size_t unfinished() const { return unfinished_; }

  // For the hosts.
  void call_at(Nanoseconds time, std::function<void()> action);
  Task<void> wait_until(Nanoseconds time);
  void transmit(PeerId from, PeerId to, Bytes bytes);
  boost::asio::io_context& context() { return context_; }

 private:
  struct Link {
    LinkScript script;
    std::size_t sent = 0;
  };

  boost::asio::io_context context_;
  std::multimap<Nanoseconds, std::function<void()>> events_;  // equal times: in order of insertion
  std::map<std::pair<PeerId, PeerId>, Link> links_;
  std::vector<std::unique_ptr<ScriptHost>> hosts_;
  Nanoseconds now_{0};
  std::size_t unfinished_ = 0;
};

// What the calls of a host cost its CPU.
struct ScriptCosts {
  Nanoseconds send{0};  // a message leaves at the end of its call
  Nanoseconds set{0};
  double set_fraction = 0.5;  // part of the set call after which the new value counts
  Nanoseconds wake{0};        // from arrival, or from the call if later, to the return of receive
};

class ScriptHost : public Host {
 public:
  struct Slew {
    Nanoseconds offset;
    double rate_ppb;
  };

  ScriptHost(ScriptWorld& world, PeerId id);
  ~ScriptHost() override;

  // Script.
  ScriptCosts costs;
  Nanoseconds offset{0};       // system clock minus time
  Nanoseconds granularity{1};  // to which the system clock's readings are rounded down
  double max_frequency_ppb = 100e6;
  double uniform = 0;              // what random_uniform() returns
  bool stamps_departures = false;  // in the kernel
  bool throw_on_outcome = false;   // a fault of the host itself
  // Log.
  std::vector<Nanoseconds> steps;       // change of `offset` by each set()
  std::vector<Slew> slews;              // applied at once
  std::vector<double> frequencies_ppb;  // of adjust_frequency(), which changes nothing
  std::vector<Exchange> exchanges;
  std::vector<SyncOutcome> outcomes;
  std::vector<SessionDelays> delays;
  std::vector<Nanoseconds> outcome_times;

  Nanoseconds lead_over(const ScriptHost& other) const { return offset - other.offset; }
  HostTime reading() const;
  void deliver(PeerId from, Bytes bytes);

  PeerId id() const override { return id_; }
  HostClock& clock() override;
  const SteadyClock& steady_clock() const override;
  MessageChannel& open_channel(PeerId peer, Transport transport) override;
  Task<void> sleep_for(Nanoseconds interval) override;
  Task<void> sleep_until(HostTime at) override;
  double random_uniform() override { return uniform; }
  void report_exchange(const Exchange& exchange) override { exchanges.push_back(exchange); }
  void report_outcome(const SyncOutcome& outcome) override;
  void report_delays(const SessionDelays& reported) override { delays.push_back(reported); }

 private:
  class Channel;
  class SystemClock;
  class Oscillator;

  // Books the CPU for a call; returns when the call begins.
  Nanoseconds book_cpu(Nanoseconds cost);
  Channel& channel(PeerId peer);

  ScriptWorld& world_;
  PeerId id_;
  Nanoseconds cpu_free_{0};
  std::unique_ptr<SystemClock> clock_;
  std::unique_ptr<Oscillator> steady_clock_;
  std::map<PeerId, std::unique_ptr<Channel>> channels_;
};

}  // namespace simbench
