#pragma once

/// The picture of what slides at the factor of safety.

#include <string>

namespace suffuse {

/// Draws the plane mechanism in the file of `suffuse-solver --strength-reduction --mechanism`:
/// colours by the shear strain, arrows along the motion, both over the largest motion.
/// \param path  picture to write: .png, .svg or .pdf
/// Throws InputError for a mechanism in space and for an unknown suffix, FileError for any other
/// file.
void draw_slip(const std::string& file, const std::string& path);

}  // namespace suffuse
