#pragma once

namespace suffuse {

/// Largest resident set of this process so far, bytes.
[[nodiscard]] double peak_memory();

}  // namespace suffuse
