// The trigger of a rig, switched on and off by the commands of the rig file or by the user's hand.
//
// Commands run in the shell (/bin/sh -c) of the conducting machine, with standard output sent to
// standard error; turn() waits for their end, at most kCommandLimitSeconds. They run in a thread of
// their own, so that the conductor goes on serving its nodes.
//
// Errors: TriggerError with the command and how it ended, or because the user gave up.
//
//   TriggerSwitch trigger(context, rig.trigger, prompt);
//   co_await trigger.turn(true);
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "algorithms/ports/host.h"
#include "hardware/rig/rig.h"

namespace simbench::hardware {

class TriggerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class TriggerSwitch {
 public:
  using Prompt = std::function<bool(const std::string& text)>;
  static constexpr int kCommandLimitSeconds = 30;

  // Without a trigger, turn() does nothing.
  TriggerSwitch(boost::asio::io_context& context, std::optional<RigTrigger> trigger, Prompt prompt);

  Task<void> turn(bool on);
  // It was switched on, and nobody has tried to switch it off since.
  bool is_on() const { return is_on_; }

 private:
  std::string problem(bool on) const;  // empty: done

  boost::asio::io_context& context_;
  std::optional<RigTrigger> trigger_;
  Prompt prompt_;
  bool is_on_ = false;
};

}  // namespace simbench::hardware
