#include "tests/cli/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

namespace simbench {
namespace {

namespace fs = std::filesystem;

std::string read_all(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

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
  if (options.largest_file) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {*options.largest_file, *options.largest_file};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(SIMBENCH_PROGRAM, argv.data());
  _exit(127);
}

}  // namespace

bool has_reconstruction() {
  return fs::exists(fs::path(SIMBENCH_PROGRAM).parent_path() / "simbench-reconstruct");
}

ProgramTest::ProgramTest() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string("simbench_") + test->test_suite_name() + "_" + test->name() +
                           "_" + std::to_string(getpid());
  folder_ = fs::temp_directory_path() / name;
  captures_ = fs::temp_directory_path() / (name + "_captures");
  for (const fs::path& path : {folder_, captures_}) {
    fs::remove_all(path);
    fs::create_directory(path);
  }
}

ProgramTest::~ProgramTest() {
  fs::remove_all(folder_);
  fs::remove_all(captures_);
}

ProgramResult ProgramTest::run(const std::vector<std::string>& arguments,
                               const ProgramOptions& options) const {
  const fs::path out = options.out_file.empty() ? captures_ / "out" : fs::path(options.out_file);
  const fs::path err = captures_ / "err";
  std::vector<std::string> command = {SIMBENCH_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const pid_t process = fork();
  if (process == 0) become_program(folder_, command, out, err, options);
  if (options.interrupt_after) {
    std::this_thread::sleep_for(*options.interrupt_after);
    kill(process, SIGINT);
  }
  int wait_status = 0;
  waitpid(process, &wait_status, 0);
  ProgramResult result;
  result.status = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
  if (options.out_file.empty()) result.out = read_all(out);
  result.err = read_all(err);
  return result;
}

std::string ProgramTest::file(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
  return name;
}

std::string ProgramTest::content(const std::string& name) const { return read_all(folder_ / name); }

std::vector<std::string> ProgramTest::names_in(const std::string& folder) const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / folder)) {
    names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace simbench
