#pragma once

/// Signals that end a run in an orderly way: SIGINT, SIGTERM, SIGHUP (the terminal was closed)
/// and SIGUSR1 (mpirun and job schedulers pass it on).

namespace suffuse {

/// From this call on these signals set `interrupted` instead of ending the program, and SIGPIPE is
/// ignored.
void catch_interrupts();
/// Whether such a signal came since the last `catch_interrupts`.
[[nodiscard]] bool interrupted();

}  // namespace suffuse
