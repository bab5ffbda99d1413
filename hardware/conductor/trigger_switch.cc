#include "hardware/conductor/trigger_switch.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <future>
#include <utility>

#include "hardware/net/notice.h"
#include "recording/shell_quoted.h"

namespace simbench::hardware {
namespace {

// GNU timeout ends a command that hangs; a shell of its own keeps the user's redirections.
std::string run(const std::string& command) {
  const std::string line = fmt::format("timeout {} /bin/sh -c {} 1>&2",
                                       TriggerSwitch::kCommandLimitSeconds, shell_quoted(command));
  const int status = std::system(line.c_str());
  if (status == 0) return {};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 124) {
    return fmt::format("'{}' took longer than {} s", command, TriggerSwitch::kCommandLimitSeconds);
  }
  if (WIFEXITED(status)) {
    return fmt::format("'{}' ended with exit status {}", command, WEXITSTATUS(status));
  }
  return fmt::format("'{}' could not be run, or was killed", command);
}

}  // namespace

TriggerSwitch::TriggerSwitch(boost::asio::io_context& context, std::optional<RigTrigger> trigger,
                             Prompt prompt)
    : context_(context), trigger_(std::move(trigger)), prompt_(std::move(prompt)) {}

std::string TriggerSwitch::problem(bool on) const {
  if (trigger_->manual) {
    const char* text = on ? "Switch the trigger on now" : "Switch the trigger off now";
    if (!prompt_) return "it is switched by hand, and there is no prompt";
    return prompt_(text) ? "" : "given up at the prompt";
  }
  return run(on ? trigger_->on_command : trigger_->off_command);
}

Task<void> TriggerSwitch::turn(bool on) {
  if (!trigger_) co_return;
  is_on_ = false;
  std::future<std::string> done =
      std::async(std::launch::async, [this, on] { return problem(on); });
  while (done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    co_await pause(context_.get_executor(), std::chrono::milliseconds(5));
  }
  const std::string problem = done.get();
  if (!problem.empty()) {
    throw TriggerError(fmt::format("trigger {}: {}", on ? "on" : "off", problem));
  }
  is_on_ = on;
}

}  // namespace simbench::hardware
