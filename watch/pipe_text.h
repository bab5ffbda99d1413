// The text that a program writes while it runs, or that comes on standard input.
//
// A command is run by the shell again and again, kCommandPauseS apart, as one that asks a daemon
// ("chronyc -c -n tracking") needs; one that goes on by itself is simply never asked again. It ends
// with this object. Reading never waits.
//
//   PipeText asked = PipeText::of_command("chronyc -c -n tracking");
//   use(asked.poll().text);
#pragma once

#include <sys/types.h>

#include <string>

#include "watch/tail.h"

namespace simbench::watch {

inline constexpr int kCommandPauseS = 1;

class PipeText final : public GrowingText {
 public:
  static PipeText of_standard_input();
  // Throws std::system_error if it cannot be started.
  static PipeText of_command(const std::string& command);
  PipeText(PipeText&& other) noexcept;
  PipeText& operator=(PipeText&&) = delete;
  ~PipeText() override;

  const std::string& path() const override { return name_; }
  GrownText poll() override;
  // A pipe has no beginning that could be read again.
  std::string head(std::size_t) const override { return {}; }

 private:
  PipeText(std::string name, int file, pid_t child);

  std::string name_;
  int file_;
  pid_t child_;  // 0: none
  bool has_ended_ = false;
  std::string unfinished_;
};

}  // namespace simbench::watch
