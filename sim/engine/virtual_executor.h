// Coroutines in virtual time: an Asio execution context over the engine.
//
// The protocols of the project are boost::asio::awaitable<T> coroutines. In the simulated world
// they run on this context, whose queue is the engine's event queue and whose time moves only when
// an event is taken. All of Asio's features for coroutines work: awaitable<T> with its default
// any_io_executor, co_spawn, completion handlers, and the || and && of awaitable_operators.
//
// Posted work runs at the current virtual time, in the order of posting, never inside the call that
// posts it. Waits end with the event of their deadline or with an event of their own, so resuming
// never nests and a loop of any number of ready awaits needs no stack.
//
// Cancellation through the handler's cancellation slot ends a wait at the current virtual time with
// boost::asio::error::operation_aborted, thrown from the co_await as boost::system::system_error.
//
// The context must be destroyed before its engine, and the engine must not run after that.
// Destroying it destroys all coroutines that still wait. One context per engine.
//
// Cost: at most two allocations per await (the frame of the await and the state of the wait).
//
//   boost::asio::awaitable<void> blink(VirtualContext& context, Lamp& lamp) {
//     for (;;) {
//       lamp.toggle();
//       co_await sleep_until(context, context.engine().now() + from_ms(500), "lamp: blink");
//     }
//   }
//
//   Engine engine;
//   VirtualContext context(engine);
//   boost::asio::co_spawn(context, blink(context, lamp), boost::asio::detached);
//   engine.run_until(TrueTime(std::chrono::seconds(10)));
#ifndef SIMBENCH_SIM_ENGINE_VIRTUAL_EXECUTOR_H_
#define SIMBENCH_SIM_ENGINE_VIRTUAL_EXECUTOR_H_

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/execution.hpp>
#include <boost/asio/execution_context.hpp>
#include <boost/intrusive/list.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "recording/true_time.h"
#include "sim/engine/callback_slab.h"
#include "sim/engine/engine.h"

namespace simbench::sim {

class VirtualContext;
class WaitPoint;

// The executor of a VirtualContext. Copies are equal and cost a pointer.
class VirtualExecutor {
 public:
  explicit VirtualExecutor(VirtualContext& context) : context_(&context) {}

  VirtualContext& query(boost::asio::execution::context_t) const noexcept { return *context_; }
  static constexpr boost::asio::execution::blocking_t query(
      boost::asio::execution::blocking_t) noexcept {
    return boost::asio::execution::blocking.never;
  }
  VirtualExecutor require(boost::asio::execution::blocking_t::never_t) const noexcept {
    return *this;
  }
  friend bool operator==(const VirtualExecutor&, const VirtualExecutor&) noexcept = default;

  template <class Work>
  void execute(Work&& work) const;

 private:
  VirtualContext* context_;
};

// One suspended co_await. Owned by its context from its start until its handler is called.
class PendingWait : public boost::intrusive::list_base_hook<> {
 public:
  enum class Outcome { kNotified, kDeadline, kAborted };

  PendingWait(VirtualContext& context, std::string_view label, std::optional<TrueTime> deadline);
  PendingWait(const PendingWait&) = delete;
  PendingWait& operator=(const PendingWait&) = delete;
  virtual ~PendingWait();

  // Ends the wait by an event at the current virtual time. Only the first outcome counts.
  void finish(Outcome outcome);

  bool is_finished() const { return outcome_.has_value(); }
  std::string describe() const;

 protected:
  // Destroys the wait, then calls its handler.
  virtual void complete(Outcome outcome) = 0;

 private:
  friend class WaitPoint;

  VirtualContext& context_;
  WaitPoint* point_ = nullptr;
  std::string_view label_;
  TrueTime since_;
  std::optional<TrueTime> deadline_;
  std::optional<Outcome> outcome_;
  TimerId timer_;
};

class VirtualContext : public boost::asio::execution_context, private EventHandler {
 public:
  using executor_type = VirtualExecutor;

  explicit VirtualContext(Engine& engine);
  ~VirtualContext() override;

  Engine& engine() { return engine_; }
  executor_type get_executor() noexcept { return VirtualExecutor(*this); }

  // Runs `work()` at the current virtual time, after everything already due at it.
  template <class Work>
  void post(Work&& work) {
    using Stored = std::decay_t<Work>;
    std::uint32_t slot = 0;
    if constexpr (kFitsCallback<Stored>) {
      slot = posted_.emplace(std::forward<Work>(work));
    } else {
      slot = posted_.emplace(
          [stored = std::make_unique<Stored>(std::forward<Work>(work))] { std::move (*stored)(); });
    }
    engine_.schedule(engine_.now(), handler_id_, 0, slot);
  }

  // What every waiting coroutine waits for, in the order in which they began to wait, e.g.
  // "host3: receive from host0, since 12.345678 s, deadline 17 s".
  std::vector<std::string> waiting() const;
  // Suspended waits, including those whose end is already on its way.
  std::size_t live() const { return waits_.size(); }

 private:
  friend class PendingWait;

  void handle(const Event& event) override { posted_.run(event.subject); }

  Engine& engine_;
  HandlerId handler_id_;
  boost::intrusive::list<PendingWait> waits_;
  CallbackSlab posted_;
};

template <class Work>
void VirtualExecutor::execute(Work&& work) const {
  context_->post(std::forward<Work>(work));
}

// Waits until virtual time `at`; if that is past, until after the events already due now. `label`
// names the purpose and must outlive the wait (a literal).
boost::asio::awaitable<void> sleep_until(VirtualContext& context, TrueTime at,
                                         std::string_view label);

// One coroutine at a time waits here for an event, e.g. for a message in a mailbox.
//
// notify() ends the present wait; without one it does nothing and is not remembered, so check
// before waiting and again afterwards:
//
//   while (messages.empty()) {
//     const bool notified = co_await arrived.wait(deadline);
//     if (!notified) co_return std::nullopt;
//   }
class WaitPoint {
 public:
  // `label` names the waiting coroutine and the event, e.g. "host3: receive from host0".
  WaitPoint(VirtualContext& context, std::string label);
  WaitPoint(const WaitPoint&) = delete;
  WaitPoint& operator=(const WaitPoint&) = delete;
  // A wait that is under way ends as if cancelled.
  ~WaitPoint();

  // True when notified, false when the deadline came first; for a notify() and a deadline at the
  // same instant, the earlier event counts. The point must outlive the wait, and no other coroutine
  // may wait here.
  boost::asio::awaitable<bool> wait(std::optional<TrueTime> deadline = std::nullopt);

  void notify();
  bool waiting() const { return wait_ != nullptr; }

 private:
  friend class PendingWait;

  void begin(PendingWait& wait);

  VirtualContext& context_;
  std::string label_;
  PendingWait* wait_ = nullptr;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_ENGINE_VIRTUAL_EXECUTOR_H_
