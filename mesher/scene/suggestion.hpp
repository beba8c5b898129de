#pragma once

/// "Did you mean ...?" for the keys of a scene.

#include <string>

namespace suffuse {

/// A key, in full, that an unknown `name` given in the table `table` most likely stands for, or an
/// empty text. Names near it in the same table come first, then those of other tables, then
/// symbols. \param table    dotted key of the table, `soil.specimen` \param pattern  its pattern,
/// `soil.*` \param soil     what to call a soil in a suggestion from elsewhere
std::string nearest_key(const std::string& name, const std::string& table,
                        const std::string& pattern, const std::string& soil);

}  // namespace suffuse
