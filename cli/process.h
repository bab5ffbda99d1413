// This process: its memory, and the program as which it goes on.
//
// simbench-mpi and simbench-reconstruct lie beside simbench. They are the same command line with
// more libraries, which only their users need. `mpirun -n 64 simbench sweep ...` goes on as
// simbench-mpi, `simbench reconstruct` as simbench-reconstruct. `simbench run --python FILE ...`
// goes on as the interpreter of Python with the package simbench, which has the command line in it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace simbench::cli {

// Keeps the memory that one run frees for the next, instead of returning it to the system.
//
// Each run needs the few megabytes that the run before has freed. Returning them to the kernel
// costs page faults, about a sixth of a run's time. A setting of the whole process, so programs
// call it and the library does not. Call once, before there are threads. Without glibc it does
// nothing.
void keep_freed_memory();

// Occupies those of the three standard descriptors that are closed, so that no file of results gets
// the number of standard output; what is written there fails as it would if they were closed. Call
// before any file is opened.
void hold_standard_descriptors();

std::filesystem::path sibling_program(const std::string& name);

// Goes on as that program, with these arguments (argv, its own name included). Returns only if it
// cannot be started: the error number, ENOTSUP for an embedded command (cli/embedding.h).
int become_sibling(const std::string& name, std::vector<std::string> arguments);

// Goes on as `python3 -m simbench` with these arguments (argv). SIMBENCH_PYTHON names another
// interpreter; the package that lies beside this program (../python, as a build has it) is
// preferred to an installed one. Throws scenarios::InputError if there is no interpreter; Python
// says, with exit status 2, if it has no simbench.
[[noreturn]] void become_python_program(std::vector<std::string> arguments);

// The rank of this process if an MPI launcher started more than one; else nothing. Reads the
// environment of OpenMPI and of launchers with PMI or PMIx (MPICH, Intel MPI, Slurm's srun --mpi).
std::optional<long> mpi_rank();

// Under MPI goes on as simbench-mpi and does not return, if the arguments are those of a sweep.
// Throws scenarios::InputError if there is no such program.
void become_mpi_program(const std::vector<std::string>& arguments);

}  // namespace simbench::cli
