#include "cli/interrupt_deadline.h"

#include <unistd.h>

#include <chrono>
#include <system_error>
#include <utility>

#include "app/interrupt.h"
#include "cli/messages.h"
#include "recording/disposable.h"

namespace simbench::cli {
namespace {

constexpr std::chrono::milliseconds kLook(50);
constexpr std::chrono::milliseconds kGrace(400);

}  // namespace

InterruptDeadline::InterruptDeadline(std::function<void()> report, Patience patience)
    : report_(std::move(report)), patience_(patience) {
  try {
    watcher_ = std::jthread([this](const std::stop_token& over) { watch(over); });
  } catch (const std::system_error&) {
    // The work must end by itself.
  }
}

void InterruptDeadline::watch(const std::stop_token& over) {
  std::unique_lock lock(mutex_);
  const auto is_over_within = [&](std::chrono::milliseconds time) {
    return condition_.wait_for(lock, over, time, [&] { return over.stop_requested(); });
  };
  while (!app::InterruptHandler::raised()) {
    if (is_over_within(kLook)) return;
  }
  for (std::chrono::milliseconds waited(0);
       patience_ == Patience::kUntilInsisted || waited < kGrace; waited += kLook) {
    if (app::InterruptHandler::insisted()) break;
    if (is_over_within(kLook)) return;
  }
  report_();
  dispose_of_all();
  ::_exit(kInterrupted);
}

}  // namespace simbench::cli
