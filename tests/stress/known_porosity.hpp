#pragma once

/// Mean porosity of the one soil that erodes, where its law does not depend on the flow.

#include "scene/scene.hpp"

namespace suffuse::stress {

class KnownPorosity {
 public:
  explicit KnownPorosity(const Scene& scene);
  [[nodiscard]] bool known() const { return soil_ != nullptr; }
  [[nodiscard]] double at(double t) const;

 private:
  const Soil* soil_ = nullptr;
};

}  // namespace suffuse::stress
