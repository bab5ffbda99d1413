// `mpirun -n 64 simbench sweep ...`: a sweep that was launched on many ranks goes on as the program
// simbench-mpi, which lies beside this one and is the same command line with MPI in it. So MPI is
// needed by those who use it only.
#ifndef SIMBENCH_CLI_MPI_LAUNCH_H_
#define SIMBENCH_CLI_MPI_LAUNCH_H_

#include <optional>
#include <string>
#include <vector>

namespace simbench::cli {

// The rank of this process if an MPI launcher started more than one; nothing else. Known by their
// environment: OpenMPI, and those that speak PMI or PMIx (MPICH, Intel MPI, Slurm's srun --mpi).
std::optional<long> mpi_rank();

// Under MPI becomes simbench-mpi and does not return, if the arguments are those of a sweep. Throws
// scenarios::InputError if there is no such program.
void become_mpi_program(const std::vector<std::string>& arguments);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_MPI_LAUNCH_H_
