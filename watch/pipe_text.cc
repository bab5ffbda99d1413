#include "watch/pipe_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include "watch/shell.h"

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
  PipeText text(command, ends[0], 0);
  try {
    text.child_ = start_shell(loop, {.output = ends[1]});
  } catch (const std::system_error&) {
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  return text;
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
