#include "watch/hook.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <utility>
#include <vector>

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
  std::vector<std::string> variables = {
      "SIMBENCH_EVENT=" +
          event_json(event).dump(-1, ' ', false, reports::Json::error_handler_t::replace),
      "SIMBENCH_EVENT_KIND=" + event.kind, "SIMBENCH_EVENT_SUBJECT=" + event.subject,
      "SIMBENCH_EVENT_TEXT=" + event.text};
  std::vector<char*> environment;
  for (char** each = environ; *each != nullptr; ++each) environment.push_back(*each);
  for (std::string& each : variables) environment.push_back(each.data());
  environment.push_back(nullptr);
  std::string shell = "sh";
  std::string option = "-c";
  const std::array<char*, 4> words = {shell.data(), option.data(), command_.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  // What it prints must not stand between the lines of events.
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  if (posix_spawn(&running_, "/bin/sh", &actions, nullptr, words.data(), environment.data()) != 0) {
    running_ = 0;
    ++failed_;
  }
  posix_spawn_file_actions_destroy(&actions);
}

}  // namespace simbench::watch
