#include "tests/cli/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace simbench {
namespace {

namespace fs = std::filesystem;

void redirect(const fs::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(126);
}

// In the new process; does not return.
[[noreturn]] void become_program(const fs::path& folder, std::vector<std::string> arguments,
                                 const fs::path& out, const fs::path& err,
                                 const ProgramOptions& options) {
  if (chdir(folder.c_str()) != 0) _exit(126);
  unsetenv("COLUMNS");
  for (const std::string& setting : options.environment) {
    const std::size_t equals = setting.find('=');
    setenv(setting.substr(0, equals).c_str(), setting.substr(equals + 1).c_str(), 1);
  }
  redirect(out, STDOUT_FILENO);
  redirect(err, STDERR_FILENO);
  if (options.closed_out) close(STDOUT_FILENO);
  if (options.largest_file) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {*options.largest_file, *options.largest_file};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  std::string program = SIMBENCH_PROGRAM;
  if (!options.kernel_without.empty()) {
    arguments.front() = program;
    program = fs::path(SIMBENCH_PROGRAM).replace_filename("simbench_older_kernel");
    std::vector<std::string> before = {program};
    before.insert(before.end(), options.kernel_without.begin(), options.kernel_without.end());
    before.emplace_back("--");
    arguments.insert(arguments.begin(), before.begin(), before.end());
  }
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

// The line of /proc/PID/status with this name; empty without one.
std::string status_line(pid_t process, const std::string& name) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name + ":\t")) return line.substr(name.size() + 2);
  }
  return "";
}

bool has_ended(pid_t process) {
  const std::string state = status_line(process, "State");
  return state.empty() || state.starts_with("Z");
}

// Returns when the program has a handler of SIGINT, or has ended.
void wait_for_handler(pid_t process) {
  constexpr std::uint64_t kInterrupt = std::uint64_t{1} << (SIGINT - 1);
  for (;;) {
    const std::string caught = status_line(process, "SigCgt");
    if (caught.empty() || has_ended(process)) return;
    if ((std::stoull(caught, nullptr, 16) & kInterrupt) != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

// Returns when there is something in the file, or the program has ended.
void wait_for_content(pid_t process, const fs::path& file) {
  std::error_code missing;
  while (!has_ended(process) && (!fs::exists(file, missing) || fs::file_size(file, missing) == 0)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

bool has_reconstruction() {
  return fs::exists(fs::path(SIMBENCH_PROGRAM).parent_path() / "simbench-reconstruct");
}

ProgramResult ProgramTest::run(const std::vector<std::string>& arguments,
                               const ProgramOptions& options) const {
  const fs::path out =
      options.out_file.empty() ? fs::path(captures_ / "out") : fs::path(options.out_file);
  const fs::path err = captures_ / "err";
  std::vector<std::string> command = {SIMBENCH_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const pid_t process = fork();
  if (process == 0) become_program(folder(), command, out, err, options);
  if (options.interrupt_after) {
    wait_for_handler(process);
    if (!options.interrupt_once_written.empty()) {
      wait_for_content(process, folder() / options.interrupt_once_written);
    }
    std::this_thread::sleep_for(*options.interrupt_after);
    kill(process, SIGINT);
  }
  if (options.interrupt_at) {
    std::this_thread::sleep_for(*options.interrupt_at);
    for (int sent = 0; sent < options.interrupts; ++sent) kill(process, SIGINT);
  }
  int wait_status = 0;
  waitpid(process, &wait_status, 0);
  ProgramResult result;
  result.status = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
  if (options.out_file.empty()) result.out = simbench::content(out);
  result.err = simbench::content(err);
  return result;
}

std::string ProgramTest::file(const std::string& name, const std::string& content) const {
  put(folder_ / name, content);
  return name;
}

std::string ProgramTest::content(const std::string& name) const { return folder_.content(name); }

std::vector<std::string> ProgramTest::names_in(const std::string& folder) const {
  return folder_.names(folder);
}

}  // namespace simbench
