#pragma once

namespace suffuse {

/// Largest resident set of this process so far, bytes.
[[nodiscard]] double peak_memory();

/// From now on large pieces of memory go back to the system when they are given up, whatever was
/// asked for before; left alone, the C library keeps those up to 32 MB, a third of what a run with
/// a million liquid points holds.
void give_memory_back();

}  // namespace suffuse
