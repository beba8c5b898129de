#pragma once

/// A scene that takes a state of the run of another one: what must be equal in both.

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// Throws InputError with all keys of the later scene, `here`, that must be as in the earlier one:
/// formulation, liquid, and porosity, grains and retention of each soil. If the skeleton moves in
/// both, a region may be free in one of them and have a soil in the other.
/// \param folder  results of the earlier scene, for messages
void refuse_other_soils(const SceneDocument& here, const Scene& there, const std::string& folder);

/// The key of a scene whose other value would give the state of a run, `there`, another weight,
/// other pores or other suction: gravity, the liquid's density, or a key of a soil. Empty if all
/// are equal.
std::string key_of_other_state(const Scene& here, const Scene& there);

/// A sentence for each region that has soil in one of the scenes and none in the other: `pit is dug
/// out`, `berm is filled`.
std::vector<std::string> construction(const Scene& here, const Scene& there,
                                      const std::vector<std::string>& regions);

}  // namespace suffuse
