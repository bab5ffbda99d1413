#include "reports/figures/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "reports/text/output_file.h"
#include "reports/text/output_folder.h"

extern char** environ;

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAbsent =
    "SVG and PDF are drawn by gnuplot, which is not installed; run `apt-get install gnuplot-nox`, "
    "or name a .csv file";

// Runs gnuplot on a script; what it says goes to `log`. Returns its exit status.
int run_gnuplot(const fs::path& script, const fs::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  std::string program = "gnuplot";
  std::string argument = script.string();
  std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT) throw OutputError(kAbsent);
  if (failed != 0) throw OutputError(fmt::format("gnuplot: {}", std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw OutputError(fmt::format("gnuplot: {}", std::strerror(errno)));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string content(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

void draw(const Figure& figure, PlotFormat format, const fs::path& output) {
  const OutputFile picture(output.string());
  const OutputFile script(picture.path().string() + ".gnuplot");
  const OutputFile log(picture.path().string() + ".log");
  script.write(gnuplot_script(figure, format, picture.path().string()));
  const int status = run_gnuplot(script.path(), log.path());
  std::error_code error;
  const bool drawn = status == 0 && fs::file_size(picture.path(), error) > 0 && !error;
  if (!drawn) {
    throw OutputError(fmt::format("{}: gnuplot failed (status {}): {}", output.string(), status,
                                  content(log.path())));
  }
  picture.publish();
}

std::string drawn_svg(const Figure& figure) {
  const fs::path picture =
      fs::temp_directory_path() / fmt::format("simbench_{}_{}.svg", figure.id, ::getpid());
  std::error_code ignored;  // of tidying up
  try {
    draw(figure, PlotFormat::kSvg, picture);
  } catch (const OutputError&) {
    fs::remove(picture, ignored);
    throw;
  }
  std::string svg = content(picture);
  fs::remove(picture, ignored);
  return svg;
}

}  // namespace simbench::reports
