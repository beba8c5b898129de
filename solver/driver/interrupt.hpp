#pragma once

/// SIGINT, SIGTERM and SIGHUP, the end of a terminal, ask for an orderly end.

namespace suffuse {

/// From here on these signals are noted instead of ending the program, and SIGPIPE is ignored.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace suffuse
