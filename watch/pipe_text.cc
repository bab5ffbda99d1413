#include "watch/pipe_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

namespace simbench::watch {

PipeText::PipeText(std::string name, int file, pid_t child)
    : name_(std::move(name)), file_(file), child_(child) {}

PipeText::PipeText(PipeText&& other) noexcept
    : name_(std::move(other.name_)),
      file_(std::exchange(other.file_, -1)),
      child_(std::exchange(other.child_, 0)),
      has_ended_(other.has_ended_),
      unfinished_(std::move(other.unfinished_)) {}

PipeText::~PipeText() {
  if (child_ != 0) {
    kill(-child_, SIGTERM);
    waitpid(child_, nullptr, 0);
  }
  if (file_ > STDIN_FILENO) close(file_);
}

PipeText PipeText::of_standard_input() { return {"standard input", STDIN_FILENO, 0}; }

PipeText PipeText::of_command(const std::string& command) {
  const std::string loop = fmt::format("while :; do {}\nsleep {}; done", command, kCommandPauseS);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "pipe2");
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string shell = "sh";
  std::string option = "-c";
  std::string text = loop;
  const std::array<char*, 4> words = {shell.data(), option.data(), text.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/bin/sh", &actions, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(ends[1]);
  if (failed != 0) {
    close(ends[0]);
    throw std::system_error(failed, std::generic_category(), command);
  }
  return {command, ends[0], child};
}

GrownText PipeText::poll() {
  GrownText grown{.is_there = !has_ended_};
  std::string text = std::move(unfinished_);
  unfinished_.clear();
  pollfd ready = {.fd = file_, .events = POLLIN, .revents = 0};
  while (!has_ended_ && text.size() < kMostPiece && ::poll(&ready, 1, 0) > 0) {
    std::array<char, 65536> piece{};
    const ssize_t got = read(file_, piece.data(), piece.size());
    if (got <= 0) {
      has_ended_ = got == 0 || (errno != EINTR && errno != EAGAIN);
      break;
    }
    text.append(piece.data(), static_cast<std::size_t>(got));
  }
  const std::size_t end = text.rfind('\n') + 1;
  if (text.size() - end < kLongestLine) unfinished_ = text.substr(end);
  text.resize(end);
  grown.text = std::move(text);
  return grown;
}

}  // namespace simbench::watch
