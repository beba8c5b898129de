#pragma once

/// Choices of a scene as the scene itself spells them.

#include <string>

#include "scene/scene.hpp"

namespace suffuse {

std::string scene_word(Formulation value);
std::string scene_word(Seeding value);
std::string scene_word(PressureIntegration value);
std::string scene_word(MassTransfer value);
std::string scene_word(EmptyElements value);

}  // namespace suffuse
