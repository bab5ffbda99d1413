// Costs of the simulation engine: typed events, callbacks, coroutines, random draws.
#include <benchmark/benchmark.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "sim/engine/engine.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"

namespace simbench::bench {
namespace {

// Delays between events: exponential with a mean of 1 ms.
Nanoseconds draw_delay(sim::RandomStream& random) {
  return Nanoseconds(static_cast<std::int64_t>(random.exponential(1e6)));
}

void count_events(benchmark::State& state, const sim::Engine& engine) {
  state.SetItemsProcessed(static_cast<std::int64_t>(engine.events()));
}

class Timers : public sim::EventHandler {
 public:
  explicit Timers(sim::Engine& engine) : engine_(engine), id_(engine.attach(*this)) {}
  void add(std::uint32_t timer) {
    engine_.schedule(engine_.now() + draw_delay(random_), id_, 0, timer);
  }
  void handle(sim::Event event) override { add(event.subject); }

 private:
  sim::Engine& engine_;
  sim::HandlerId id_;
  sim::RandomStream random_{1, "timers"};
};

// Argument of the first three: how many timers, callbacks or coroutines are pending.
void typed_events(benchmark::State& state) {
  sim::Engine engine;
  Timers timers(engine);
  for (std::uint32_t i = 0; i < state.range(0); ++i) timers.add(i);
  for (auto _ : state) engine.run_until(engine.now() + from_ms(1));
  count_events(state, engine);
}
BENCHMARK(typed_events)->Arg(24)->Arg(1000)->Arg(100'000);

struct Callback {
  sim::Engine& engine;
  sim::RandomStream& random;
  std::uint64_t timer;
  void operator()() const { engine.call_at(engine.now() + draw_delay(random), *this); }
};

void callbacks(benchmark::State& state) {
  sim::Engine engine;
  sim::RandomStream random(1, "callbacks");
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(state.range(0)); ++i) {
    Callback{engine, random, i}();
  }
  for (auto _ : state) engine.run_until(engine.now() + from_ms(1));
  count_events(state, engine);
}
BENCHMARK(callbacks)->Arg(24)->Arg(1000)->Arg(100'000);

boost::asio::awaitable<void> sleep_forever(sim::VirtualContext& context,
                                           sim::RandomStream& random) {
  for (;;) {
    co_await sim::sleep_until(context, context.engine().now() + draw_delay(random), "benchmark");
  }
}

void coroutine_sleeps(benchmark::State& state) {
  sim::Engine engine;
  sim::VirtualContext context(engine);
  sim::RandomStream random(1, "sleeps");
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    boost::asio::co_spawn(context, sleep_forever(context, random), boost::asio::detached);
  }
  for (auto _ : state) engine.run_until(engine.now() + from_ms(1));
  count_events(state, engine);
}
BENCHMARK(coroutine_sleeps)->Arg(24)->Arg(1000);

// Deadlines as a conversation sets them: far ahead, cancelled before they come.
void cancelled_deadlines(benchmark::State& state) {
  sim::Engine engine;
  for (auto _ : state) {
    engine.cancel(engine.call_at(engine.now() + from_ms(1000), [] {}));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(cancelled_deadlines);

template <class Draw>
void draws(benchmark::State& state, Draw draw) {
  sim::RandomStream random(1, "draws");
  for (auto _ : state) benchmark::DoNotOptimize(draw(random));
}
BENCHMARK_CAPTURE(draws, raw, [](sim::RandomStream& r) { return r(); });
BENCHMARK_CAPTURE(draws, uniform, [](sim::RandomStream& r) { return r.uniform(); });
BENCHMARK_CAPTURE(draws, normal, [](sim::RandomStream& r) { return r.normal(2.0); });
BENCHMARK_CAPTURE(draws, exponential, [](sim::RandomStream& r) { return r.exponential(2.0); });
BENCHMARK_CAPTURE(draws, lognormal, [](sim::RandomStream& r) { return r.lognormal(0.5); });
BENCHMARK_CAPTURE(draws, below, [](sim::RandomStream& r) { return r.below(1000); });

void keyed_streams(benchmark::State& state) {
  constexpr sim::ComponentKey link("link delay");
  std::uint64_t message = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sim::RandomStream(1, link, 7, message++).uniform());
  }
}
BENCHMARK(keyed_streams);

}  // namespace
}  // namespace simbench::bench
