#include "cli/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <system_error>

#include "cli/embedding.h"
#include "scenarios/loader.h"
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace simbench::cli {
namespace {

std::optional<long> number_in_environment(const char* name) {
  const char* text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  if (end == text || *end != '\0') return std::nullopt;
  return number;
}

struct Launcher {
  const char* size;
  const char* rank;
};
// Slurm counts tasks of any job; only with PMIx's rank are they ranks of MPI.
constexpr std::initializer_list<Launcher> kLaunchers = {
    {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
    {"PMI_SIZE", "PMI_RANK"},
    {"SLURM_NTASKS", "PMIX_RANK"}};

// Its first argument is a folder to look for the package in, or nothing.
constexpr const char* kStartPackage = R"(
import sys
beside = sys.argv.pop(1)
if beside: sys.path.insert(0, beside)
try:
    from simbench.__main__ import main
except ImportError as error:
    print(f"error: --python: {sys.executable} has no package simbench ({error}); `pip install .` in "
          "simbench's folder installs it, SIMBENCH_PYTHON names another interpreter",
          file=sys.stderr)
    sys.exit(2)
sys.exit(main(["simbench", *sys.argv[1:]]))
)";

// The words must outlive it.
std::vector<char*> argv_of(std::vector<std::string>& words) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return argv;
}

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kBytes = 256 << 20;
  mallopt(M_TRIM_THRESHOLD, kBytes);
  mallopt(M_MMAP_THRESHOLD, kBytes);
#endif
}

void hold_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free number is taken; one that can only be read.
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) ::open("/dev/null", O_RDONLY);
  }
}

std::filesystem::path sibling_program(const std::string& name) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
}

int become_sibling(const std::string& name, std::vector<std::string> arguments) {
  if (embedding() != nullptr) return ENOTSUP;
  const std::string program = sibling_program(name);
  ::execv(program.c_str(), argv_of(arguments).data());
  return errno;
}

void become_python_program(std::vector<std::string> arguments) {
  if (mpi_rank()) {
    throw scenarios::InputError("--python: not under mpirun; allowed: on the cores of one machine");
  }
  const char* const named = std::getenv("SIMBENCH_PYTHON");
  const std::string interpreter = named == nullptr || *named == '\0' ? "python3" : named;
  const std::filesystem::path beside = sibling_program("../python");
  const bool has_package = std::filesystem::exists(beside / "simbench" / "__init__.py");
  std::vector<std::string> words = {interpreter, "-c", kStartPackage,
                                    has_package ? beside.string() : ""};
  words.insert(words.end(), arguments.begin() + 1, arguments.end());
  ::execvp(interpreter.c_str(), argv_of(words).data());
  throw scenarios::InputError(fmt::format(
      "--python: the interpreter {} cannot be started: {}; SIMBENCH_PYTHON names another",
      interpreter, std::strerror(errno)));
}

std::optional<long> mpi_rank() {
  for (const Launcher& launcher : kLaunchers) {
    const std::optional<long> size = number_in_environment(launcher.size);
    const std::optional<long> rank = number_in_environment(launcher.rank);
    if (size && rank && *size > 1) return rank;
  }
  return std::nullopt;
}

void become_mpi_program(const std::vector<std::string>& arguments) {
  const std::optional<long> rank = mpi_rank();
  if (arguments.size() < 2 || arguments[1] != "sweep" || !rank) return;
  const int reason = become_sibling("simbench-mpi", arguments);
  // Rank 0 reports for all; a failure here might end it before it has done so.
  if (*rank > 0) std::exit(0);
  throw scenarios::InputError(fmt::format(
      "launched by MPI on more than one rank, but {} cannot be started: {}; build simbench where "
      "OpenMPI and Boost.MPI 1.81 are installed (tools/setup check), or start it without mpirun",
      sibling_program("simbench-mpi").string(), std::strerror(reason)));
}

}  // namespace simbench::cli
