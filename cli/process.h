// This process: how it keeps its memory, and which program it goes on as.
//
// simbench-mpi and simbench-reconstruct lie beside simbench and are the same command line with more
// in it, so that their libraries are needed, and loaded, by those who use them only. `mpirun -n 64
// simbench sweep ...` goes on as simbench-mpi, `simbench reconstruct` as simbench-reconstruct.
#ifndef SIMBENCH_CLI_PROCESS_H_
#define SIMBENCH_CLI_PROCESS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace simbench::cli {

// Keeps the memory that one run frees for the next, instead of giving it back to the system.
//
// Runs are alike: each needs what the one before has freed, a few megabytes. Returned to the
// kernel and asked for again, that memory costs page faults, about a sixth of a run's time. A
// setting of the whole process, so the program's choice and not the library's. Call once, before
// there are threads. Without glibc it does nothing.
void keep_freed_memory();

std::filesystem::path sibling_program(const std::string& name);

// Goes on as that program, with these arguments (argv, its own name included), and returns only
// where it cannot be started: the error number that says why.
int become_sibling(const std::string& name, std::vector<std::string> arguments);

// The rank of this process if an MPI launcher started more than one; nothing else. Known by their
// environment: OpenMPI, and those that speak PMI or PMIx (MPICH, Intel MPI, Slurm's srun --mpi).
std::optional<long> mpi_rank();

// Under MPI becomes simbench-mpi and does not return, if the arguments are those of a sweep. Throws
// scenarios::InputError if there is no such program.
void become_mpi_program(const std::vector<std::string>& arguments);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_PROCESS_H_
