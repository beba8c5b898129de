#pragma once

/// Memory of this process.

namespace suffuse {

/// Largest resident set of this process so far, bytes.
[[nodiscard]] double peak_memory();

/// From this call on the C library returns freed blocks above 1 MB to the system at once. By
/// default it keeps blocks up to 32 MB, which is a third of the memory of a run with a million
/// liquid points.
void give_memory_back();

}  // namespace suffuse
