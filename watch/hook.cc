#include "watch/hook.h"

#include <sys/wait.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "watch/shell.h"

namespace simbench::watch {

Hook::Hook(std::string command) : command_(std::move(command)) {}

Hook::~Hook() {
  if (running_ != 0) waitpid(running_, nullptr, 0);
}

void Hook::tell(const WatchEvent& event) {
  if (command_.empty()) return;
  if (waiting_.size() >= kMostWaiting) {
    ++dropped_;
    return;
  }
  waiting_.push_back(event);
  look();
}

void Hook::look() {
  if (running_ != 0) {
    int status = 0;
    if (waitpid(running_, &status, WNOHANG) != running_) return;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) ++failed_;
    running_ = 0;
  }
  if (waiting_.empty()) return;
  start(waiting_.front());
  waiting_.pop_front();
}

void Hook::finish() {
  while (running_ != 0) {
    int status = 0;
    waitpid(running_, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) ++failed_;
    running_ = 0;
    look();
  }
}

void Hook::start(const WatchEvent& event) {
  const std::string line =
      event_json(event).dump(-1, ' ', false, reports::Json::error_handler_t::replace);
  try {
    // What it prints must not stand between the lines of events.
    running_ = start_shell(
        command_, {.output = STDERR_FILENO,
                   .variables = {"SIMBENCH_EVENT=" + line, "SIMBENCH_EVENT_KIND=" + event.kind,
                                 "SIMBENCH_EVENT_SUBJECT=" + event.subject,
                                 "SIMBENCH_EVENT_TEXT=" + event.text}});
  } catch (const std::system_error&) {
    ++failed_;
  }
}

}  // namespace simbench::watch
