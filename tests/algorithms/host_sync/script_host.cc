#include "tests/algorithms/host_sync/script_host.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <deque>
#include <exception>
#include <optional>
#include <stdexcept>

namespace simbench {
namespace {

namespace asio = boost::asio;

// A wait that an event of the timeline ends. The real timer under it never expires.
class Gate {
 public:
  explicit Gate(asio::io_context& context)
      : timer_(context, asio::steady_timer::time_point::max()) {}
  void open() { timer_.cancel(); }
  Task<void> wait() {
    boost::system::error_code opened;
    co_await timer_.async_wait(asio::redirect_error(asio::use_awaitable, opened));
  }

 private:
  asio::steady_timer timer_;
};

}  // namespace

ScriptWorld::ScriptWorld(PeerId hosts) {
  for (PeerId id = 0; id < hosts; ++id) hosts_.push_back(std::make_unique<ScriptHost>(*this, id));
}

ScriptWorld::~ScriptWorld() = default;

std::vector<PeerId> ScriptWorld::slaves() const {
  std::vector<PeerId> ids;
  for (PeerId id = 1; id < hosts_.size(); ++id) ids.push_back(id);
  return ids;
}

void ScriptWorld::script_link(PeerId from, PeerId to, LinkScript script) {
  links_[{from, to}].script = std::move(script);
}

void ScriptWorld::set_latency(PeerId from, PeerId to, Nanoseconds latency) {
  script_link(from, to, [latency](std::size_t, const Bytes&) { return std::vector{latency}; });
}

ScriptWorld& ScriptWorld::connect(Nanoseconds latency) {
  for (const PeerId slave : slaves()) {
    set_latency(0, slave, latency);
    set_latency(slave, 0, latency);
  }
  return *this;
}

void ScriptWorld::start(Task<void> task) {
  ++unfinished_;
  asio::co_spawn(context_, std::move(task), [this](std::exception_ptr error) {
    --unfinished_;
    if (error) std::rethrow_exception(error);
  });
}

void ScriptWorld::run(Nanoseconds end) {
  while (true) {
    context_.restart();
    context_.poll();
    if (unfinished_ == 0 || events_.empty() || events_.begin()->first > end) return;
    auto event = events_.extract(events_.begin());
    now_ = event.key();
    event.mapped()();
  }
}

void ScriptWorld::run(HostSync& algorithm, Nanoseconds end) {
  for (const PeerId slave : slaves()) start(algorithm.run_slave(host(slave), 0));
  start(algorithm.run_master(host(0), slaves()));
  run(end);
}

void ScriptWorld::call_at(Nanoseconds time, std::function<void()> action) {
  events_.emplace(std::max(time, now_), std::move(action));
}

Task<void> ScriptWorld::wait_until(Nanoseconds time) {
  if (time <= now_) co_return;
  auto gate = std::make_shared<Gate>(context_);
  call_at(time, [gate] { gate->open(); });
  co_await gate->wait();
}

void ScriptWorld::transmit(PeerId from, PeerId to, Bytes bytes) {
  Link& link = links_[{from, to}];
  if (!link.script) throw std::logic_error("the link has no script");
  for (const Nanoseconds latency : link.script(link.sent++, bytes)) {
    call_at(now_ + latency, [this, from, to, bytes] { host(to).deliver(from, bytes); });
  }
}

class ScriptHost::SystemClock : public HostClock {
 public:
  explicit SystemClock(ScriptHost& host) : host_(host) {}

  Task<HostTime> now() override { co_return host_.reading(); }

  Task<void> set(HostTime value) override {
    const Nanoseconds cost = host_.costs.set;
    const Nanoseconds begin = host_.book_cpu(cost);
    const Nanoseconds effective =
        begin + Nanoseconds(static_cast<std::int64_t>(static_cast<double>(cost.count()) *
                                                      host_.costs.set_fraction));
    co_await host_.world_.wait_until(effective);
    const Nanoseconds step = value - HostTime(host_.world_.now() + host_.offset);
    host_.offset += step;
    host_.steps.push_back(step);
    co_await host_.world_.wait_until(begin + cost);
  }

  Task<void> adjust_frequency(double ppb) override {
    host_.frequencies_ppb.push_back(ppb);
    co_return;
  }

  double max_frequency_ppb() const override { return host_.max_frequency_ppb; }

  Task<void> slew(Nanoseconds amount, double max_rate_ppb) override {
    host_.slews.push_back({amount, max_rate_ppb});
    host_.offset += amount;
    co_return;
  }

 private:
  ScriptHost& host_;
};

class ScriptHost::Oscillator : public SteadyClock {
 public:
  explicit Oscillator(ScriptHost& host) : host_(host) {}
  SteadyTime now() const override { return SteadyTime(host_.world_.now()); }

 private:
  ScriptHost& host_;
};

class ScriptHost::Channel : public MessageChannel {
 public:
  Channel(ScriptHost& host, PeerId peer) : host_(host), peer_(peer) {}

  void deliver(Bytes bytes) {
    inbox_.push_back({std::move(bytes), host_.reading(), SteadyTime(host_.world_.now())});
    if (waiting_) waiting_->open();
  }

  Task<MessageId> send(Bytes message) override {
    const Nanoseconds end = host_.book_cpu(host_.costs.send) + host_.costs.send;
    co_await host_.world_.wait_until(end);
    last_departure_ = host_.reading();
    host_.world_.transmit(host_.id_, peer_, std::move(message));
    co_return ++sent_;
  }

  Task<std::optional<ReceivedMessage>> receive(SteadyTime deadline) override {
    if (waiting_) throw std::logic_error("a receive is already pending on this channel");
    if (inbox_.empty()) {
      auto gate = std::make_shared<Gate>(host_.world_.context());
      waiting_ = gate;
      host_.world_.call_at(deadline.time_since_epoch(), [gate] { gate->open(); });
      co_await gate->wait();
      waiting_.reset();
    }
    if (inbox_.empty()) co_return std::nullopt;
    co_await host_.world_.wait_until(host_.world_.now() + host_.costs.wake);
    ReceivedMessage message = std::move(inbox_.front());
    inbox_.pop_front();
    co_return message;
  }

  // Knows the last message only.
  Task<std::optional<HostTime>> transmit_stamp(MessageId id, SteadyTime /*deadline*/) override {
    if (!host_.stamps_departures || id != sent_) co_return std::nullopt;
    co_return last_departure_;
  }
  Task<std::optional<HardwareTime>> hardware_transmit_stamp(MessageId /*id*/,
                                                            SteadyTime /*deadline*/) override {
    co_return std::nullopt;
  }

 private:
  ScriptHost& host_;
  PeerId peer_;
  std::deque<ReceivedMessage> inbox_;
  std::shared_ptr<Gate> waiting_;
  MessageId sent_ = 0;
  HostTime last_departure_{};
};

ScriptHost::ScriptHost(ScriptWorld& world, PeerId id)
    : world_(world),
      id_(id),
      clock_(std::make_unique<SystemClock>(*this)),
      steady_clock_(std::make_unique<Oscillator>(*this)) {}

ScriptHost::~ScriptHost() = default;

HostTime ScriptHost::reading() const {
  const Nanoseconds exact = world_.now() + offset;
  return HostTime(granularity * floor_div(exact.count(), granularity.count()));
}

void ScriptHost::deliver(PeerId from, Bytes bytes) { channel(from).deliver(std::move(bytes)); }

HostClock& ScriptHost::clock() { return *clock_; }

const SteadyClock& ScriptHost::steady_clock() const { return *steady_clock_; }

MessageChannel& ScriptHost::open_channel(PeerId peer, Transport /*transport*/) {
  return channel(peer);
}

Task<void> ScriptHost::sleep_for(Nanoseconds interval) {
  co_await world_.wait_until(world_.now() + interval);
}

Task<void> ScriptHost::sleep_until(HostTime at) {
  co_await world_.wait_until(at.time_since_epoch() - offset);
}

void ScriptHost::report_outcome(const SyncOutcome& outcome) {
  if (throw_on_outcome) throw std::runtime_error("the recording is full");
  outcomes.push_back(outcome);
  outcome_times.push_back(world_.now());
}

Nanoseconds ScriptHost::book_cpu(Nanoseconds cost) {
  const Nanoseconds begin = std::max(world_.now(), cpu_free_);
  cpu_free_ = begin + cost;
  return begin;
}

ScriptHost::Channel& ScriptHost::channel(PeerId peer) {
  auto& slot = channels_[peer];
  if (!slot) slot = std::make_unique<Channel>(*this, peer);
  return *slot;
}

}  // namespace simbench
