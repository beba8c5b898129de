#pragma once

/// "Did you mean ...?" for the keys of a scene.

#include <string>

namespace suffuse {

/// The full key that an unknown `name` in a table most likely means, or an empty text. Similar
/// names in the same table come first, then those of other tables, then symbols.
/// \param table    dotted key of the table, `soil.specimen`; its pattern is `pattern`, `soil.*`
/// \param soil     name of a soil for suggestions from other tables
std::string nearest_key(const std::string& name, const std::string& table,
                        const std::string& pattern, const std::string& soil);

}  // namespace suffuse
