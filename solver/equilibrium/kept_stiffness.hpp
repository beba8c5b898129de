#pragma once

/// What the equilibria of successive steps keep.

#include <memory>

#include "linear/newton_system.hpp"
#include "solid/stiffness_pattern.hpp"

namespace suffuse {

/// The pattern of the matrices, as long as the same elements have soil, and the factor of an
/// elastic stiffness, as long as solutions with it converge.
template <int Dim>
struct KeptStiffness {
  std::shared_ptr<const StiffnessPattern<Dim>> pattern;  ///< null: none yet
  NewtonSystem system;

  void archive(auto& archive, const Mesh<Dim>& mesh, const Supports<Dim>& supports) {
    SoilCouplings couplings = pattern ? pattern->couplings() : SoilCouplings();
    archive(couplings);
    if (archive.restores()) {
      const DisplacementUnknowns<Dim> unknowns(supports, nodes_of(mesh, couplings.elements));
      pattern = std::make_shared<StiffnessPattern<Dim>>(mesh, unknowns, std::move(couplings));
      system = NewtonSystem();  // its order of unknowns may be that of another pattern
    }
    system.archive_factor(archive, pattern ? pattern->zeros() : Eigen::SparseMatrix<double>());
  }
};

}  // namespace suffuse
