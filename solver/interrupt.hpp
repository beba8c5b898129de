#pragma once

/// SIGINT and SIGTERM ask for an orderly end.

namespace suffuse {

/// From here on the signals are noted instead of ending the program.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace suffuse
