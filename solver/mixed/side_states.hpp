#pragma once

/// Saturation and conductivity of the soil at the sides of elements.

#include "mixed/mixed_model.hpp"

namespace suffuse {

/// Two elements of one soil have the same state at the face between them, which is found once.
template <int Dim>
class SideStates {
 public:
  /// Keeps references. Pressures are per face, Pa.
  SideStates(const MixedModel<Dim>& model, const std::vector<double>& pressure);
  [[nodiscard]] RetentionState at(int e, int k) const {
    const int f = model_.grid.element_face[e][k];
    const int left = model_.grid.face_left[f];
    return model_.soils.are_alike(e, left) ? of_left_[f] : model_.soils.at(e, pressure_[f]);
  }

 private:
  const MixedModel<Dim>& model_;
  const std::vector<double>& pressure_;
  std::vector<RetentionState> of_left_;  ///< per face, of the element on its left
};

}  // namespace suffuse
