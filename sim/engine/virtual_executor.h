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
// Waits are Asio's asynchronous operations: co_await them, or call them with a completion token,
// as awaitable_operators need it: `point.wait()(use_awaitable) || sleep(use_awaitable)`.
//
// Cost: no allocation per await in steady state.
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
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/associated_cancellation_slot.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/execution.hpp>
#include <boost/asio/execution_context.hpp>
#include <boost/intrusive/list.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <new>
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

// One suspended co_await. It lies in its context's memory from its start until its handler is
// called.
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
  // Disposes of the wait, then calls its handler.
  virtual void complete(Outcome outcome) = 0;
  // Destroys the wait and gives its memory back.
  virtual void dispose() = 0;

  VirtualContext& context() const { return context_; }

 private:
  friend class VirtualContext;
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
  template <class Handler>
  friend class HandlerWait;

  // The memory of a wait: two pointers are left for its handler.
  struct WaitMemory {
    alignas(std::max_align_t) std::byte bytes[128];
  };

  void handle(Event event) override { posted_.run(event.subject); }
  WaitMemory& take_memory() {
    if (free_memory_.empty()) return memory_.emplace_back();
    WaitMemory* const memory = free_memory_.back();
    free_memory_.pop_back();
    return *memory;
  }

  Engine& engine_;
  HandlerId handler_id_;
  std::deque<WaitMemory> memory_;
  std::vector<WaitMemory*> free_memory_;
  boost::intrusive::list<PendingWait> waits_;
  CallbackSlab posted_;
};

// A wait and the handler that resumes its coroutine, called with (error) or (error, notified).
template <class Handler>
class HandlerWait final : public PendingWait {
 public:
  static PendingWait& start(VirtualContext& context, std::string_view label,
                            std::optional<TrueTime> deadline, Handler handler) {
    static_assert(sizeof(HandlerWait) <= sizeof(VirtualContext::WaitMemory),
                  "the handler is larger than its place");
    VirtualContext::WaitMemory& memory = context.take_memory();
    return *::new (static_cast<void*>(memory.bytes))
        HandlerWait(memory, context, label, deadline, std::move(handler));
  }
  HandlerWait(const HandlerWait&) = delete;
  HandlerWait& operator=(const HandlerWait&) = delete;
  ~HandlerWait() override { cancellation_.clear(); }

 private:
  HandlerWait(VirtualContext::WaitMemory& memory, VirtualContext& context, std::string_view label,
              std::optional<TrueTime> deadline, Handler handler)
      : PendingWait(context, label, deadline),
        memory_(memory),
        handler_(std::move(handler)),
        cancellation_(boost::asio::get_associated_cancellation_slot(handler_)) {
    if (cancellation_.is_connected()) {
      cancellation_.assign([this](boost::asio::cancellation_type) { finish(Outcome::kAborted); });
    }
  }

  void complete(Outcome outcome) override {
    Handler handler = std::move(handler_);
    dispose();
    using boost::system::error_code;
    const error_code error = outcome == Outcome::kAborted
                                 ? error_code(boost::asio::error::operation_aborted)
                                 : error_code();
    if constexpr (std::is_invocable_v<Handler, error_code, bool>) {
      std::move(handler)(error, outcome == Outcome::kNotified);
    } else {
      std::move(handler)(error);
    }
  }
  void dispose() override {
    std::vector<VirtualContext::WaitMemory*>& free = context().free_memory_;
    VirtualContext::WaitMemory& memory = memory_;
    this->~HandlerWait();
    free.push_back(&memory);
  }

  VirtualContext::WaitMemory& memory_;
  Handler handler_;
  boost::asio::cancellation_slot cancellation_;
};

template <class Work>
void VirtualExecutor::execute(Work&& work) const {
  context_->post(std::forward<Work>(work));
}

// The operation of sleep_until().
class [[nodiscard]] Sleep {
 public:
  Sleep(VirtualContext& context, TrueTime at, std::string_view label)
      : context_(&context), at_(at), label_(label) {}

  template <boost::asio::completion_token_for<void(boost::system::error_code)> Token>
  auto operator()(Token&& token) const {
    return boost::asio::async_initiate<Token, void(boost::system::error_code)>(
        [sleep = *this](auto handler) {
          HandlerWait<decltype(handler)>::start(*sleep.context_, sleep.label_, sleep.at_,
                                                std::move(handler));
        },
        token);
  }

 private:
  VirtualContext* context_;
  TrueTime at_;
  std::string_view label_;
};

// Waits until virtual time `at`; if that is past, until after the events already due now. `label`
// names the purpose and must outlive the wait (a literal).
inline Sleep sleep_until(VirtualContext& context, TrueTime at, std::string_view label) {
  return {context, at, label};
}

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

  // The operation of wait().
  class [[nodiscard]] Wait {
   public:
    Wait(WaitPoint& point, std::optional<TrueTime> deadline)
        : point_(&point), deadline_(deadline) {}

    template <boost::asio::completion_token_for<void(boost::system::error_code, bool)> Token>
    auto operator()(Token&& token) const {
      return boost::asio::async_initiate<Token, void(boost::system::error_code, bool)>(
          [wait = *this](auto handler) {
            WaitPoint& point = *wait.point_;
            point.begin(HandlerWait<decltype(handler)>::start(point.context_, point.label_,
                                                              wait.deadline_, std::move(handler)));
          },
          token);
    }

   private:
    WaitPoint* point_;
    std::optional<TrueTime> deadline_;
  };

  // True when notified, false when the deadline came first; for a notify() and a deadline at the
  // same instant, the earlier event counts. The point must outlive the wait, and no other coroutine
  // may wait here.
  Wait wait(std::optional<TrueTime> deadline = std::nullopt) { return {*this, deadline}; }

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
