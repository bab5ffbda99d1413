#include "cli/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <system_error>

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
  const std::string program = sibling_program(name);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  return errno;
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
