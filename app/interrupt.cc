#include "app/interrupt.h"

#include <atomic>
#include <span>
#include <utility>
#include <variant>

#include "recording/forwarding_sink.h"
#include "sim/rig/clock_simulation.h"
#include "sim/rig/simulation.h"

namespace simbench::app {
namespace {

std::atomic<bool> interrupt_flag{false};
std::atomic<bool> insistence_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not wait");

void change_mask(int how, sigset_t* previous) {
  sigset_t interruptions;
  sigemptyset(&interruptions);
  for (const int number : kInterruptions) sigaddset(&interruptions, number);
  pthread_sigmask(how, &interruptions, previous);
}

void throw_if_interrupted() {
  if (interrupt_flag.load(std::memory_order_relaxed)) throw RecordingCancelled();
}

// Hands everything on; polls the flag at frames and exchanges, which are frequent.
class InterruptibleSink final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    throw_if_interrupted();
    sink().on_frames(frames, truths);
  }
  void on_event(const RecordingEvent& event) override {
    if (std::holds_alternative<ExchangeEvent>(event)) throw_if_interrupted();
    sink().on_event(event);
  }
};

class InterruptibleSource : public RecordingSource {
 public:
  explicit InterruptibleSource(std::unique_ptr<RecordingSource> source)
      : source_(std::move(source)) {}
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    throw_if_interrupted();
    InterruptibleSink watched(sink);
    RecordingRequest cancellable = request;
    cancellable.cancel = &interrupt_flag;
    return source_->record(cancellable, watched);
  }
  bool runs_host_sync() const override { return source_->runs_host_sync(); }

 private:
  std::unique_ptr<RecordingSource> source_;
};

// The simulation polls the flag itself.
class InterruptibleClocks : public ClockSource {
 public:
  explicit InterruptibleClocks(std::unique_ptr<ClockSource> source) : source_(std::move(source)) {}
  ClockCost run(const ClockRequest& request, ClockSink& sink) override {
    throw_if_interrupted();
    ClockRequest cancellable = request;
    cancellable.cancel = &interrupt_flag;
    return source_->run(cancellable, sink);
  }

 private:
  std::unique_ptr<ClockSource> source_;
};

}  // namespace

InterruptHandler::InterruptHandler() {
  struct sigaction action = {};
  action.sa_handler = [](int number) {
    if (!interrupt_flag.exchange(true)) return;
    // The third signal meets the default.
    if (insistence_flag.exchange(true)) std::signal(number, SIG_DFL);
  };
  // An interrupted write is resumed, so that the result of a complete run is not lost.
  action.sa_flags = static_cast<int>(SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kInterruptions.size(); ++i) {
    sigaction(kInterruptions[i], &action, &previous_[i]);
  }
  change_mask(SIG_UNBLOCK, &previous_mask_);
}

InterruptHandler::~InterruptHandler() {
  // In this order: a signal that came too late waits until what is half-written is gone.
  pthread_sigmask(SIG_SETMASK, &previous_mask_, nullptr);
  for (std::size_t i = 0; i < kInterruptions.size(); ++i) {
    sigaction(kInterruptions[i], &previous_[i], nullptr);
  }
}

bool InterruptHandler::raised() { return interrupt_flag; }

bool InterruptHandler::insisted() { return insistence_flag; }

void InterruptHandler::set(bool raised) { interrupt_flag = raised; }

const std::atomic<bool>& InterruptHandler::flag() { return interrupt_flag; }

std::unique_ptr<RecordingSource> interruptible(std::unique_ptr<RecordingSource> source) {
  return std::make_unique<InterruptibleSource>(std::move(source));
}

std::unique_ptr<RecordingSource> simulated_world(const scenarios::Scenario& scenario) {
  return interruptible(sim::make_simulation(scenario));
}

std::unique_ptr<ClockSource> simulated_clocks(const scenarios::Scenario& scenario) {
  return std::make_unique<InterruptibleClocks>(sim::make_clock_simulation(scenario));
}

}  // namespace simbench::app
