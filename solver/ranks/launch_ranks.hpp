#pragma once

/// Starts suffuse-solver-mpi on several ranks with mpirun (`suffuse-solver --ranks N`).

#include <string>
#include <vector>

namespace suffuse {

/// Runs suffuse-solver-mpi, which lies beside this program, on `ranks` processes with these
/// arguments, and returns its exit code. SIGINT, SIGTERM and SIGHUP, which would have mpirun kill
/// its processes, come to them as SIGUSR1. If this program is killed, mpirun ends its processes.
/// `output`: gets what they print on standard output, a page at most. Throws FileError if
/// suffuse-solver-mpi or mpirun is not there, NumericalError if a process is killed or mpirun does
/// not end.
int launch_ranks(int ranks, const std::vector<std::string>& arguments,
                 std::string* output = nullptr);

}  // namespace suffuse
