#include "values/scene_words.hpp"

namespace suffuse {

std::string scene_word(Formulation value) {
  return value == Formulation::double_point ? "double-point" : "single-point";
}

std::string scene_word(Seeding value) {
  switch (value) {
    case Seeding::gauss:
      return "gauss";
    case Seeding::random:
      return "random";
    case Seeding::low_discrepancy:
      return "low-discrepancy";
  }
  return "";
}

std::string scene_word(PressureIntegration value) {
  return value == PressureIntegration::mixed ? "mixed" : "material-point";
}

std::string scene_word(MassTransfer value) {
  return value == MassTransfer::nodal ? "nodal" : "element";
}

std::string scene_word(EmptyElements value) {
  return value == EmptyElements::wet ? "wet" : "dry";
}

}  // namespace suffuse
