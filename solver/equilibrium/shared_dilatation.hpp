#pragma once

/// Elements that share their dilatation, against locking.

#include <Eigen/SparseCore>
#include <vector>

#include "solid/stiffness_pattern.hpp"

namespace suffuse {

/// Soil that keeps its volume, or whose plastic flow prescribes its change of volume, is too stiff
/// on triangles and tetrahedra with linear displacements: there are more elements, each with a
/// condition on its volume, than displacements. So neighbours are joined to patches, most of two
/// triangles or of four tetrahedra, and laws see the volume ratio of the patch,
///
///     Jm = sum_e w_e J_e / sum_e w_e,
///
/// with the volume w_e of an element's soil (F-bar patches: de Souza Neto, Andrade Pires and Owen,
/// Int. J. Numer. Meth. Eng. 62 (2005) 353). Patches lie within a region; crossed triangles do not
/// lock. Which elements share: `sharing_volumes`.
template <int Dim>
class SharedDilatation {
 public:
  SharedDilatation() = default;
  /// \param weight  per element: the volume of its soil, m3; 0: the element does not share
  SharedDilatation(const Grid<Dim>& grid, const std::vector<double>& weight);

  /// Whether any element shares its dilatation.
  [[nodiscard]] bool acts() const { return !patches_.empty(); }
  [[nodiscard]] bool is_shared(int element) const { return acts() && share_[element] > 0.0; }
  /// Sets the ratios of elements in a patch to that of the patch.
  void average(std::vector<double>& ratio) const;
  /// How much larger the total pressure of an element is than that of its patch, Pa: the weight of
  /// the soil of the patch times the way from the middle of the patch to that of the element. 0
  /// where nothing is shared.
  /// \param weight  of the soil and its water, per element, N/m3
  [[nodiscard]] std::vector<double> variation(const Mesh<Dim>& mesh,
                                              const std::vector<Vector<Dim>>& weight) const;
  /// The derivative of the work of mean stresses by J: w_e / sum w times the sum of m/Jm in the
  /// patch, Pa m3 per element; 0 where nothing is shared.
  /// \param mean  per element: m/Jm, Pa m3
  [[nodiscard]] std::vector<double> spread(const std::vector<double>& mean) const;

  /// Derivatives of an element by the displacements u of its nodes and by theta, dtheta = dJm/Jm.
  struct Tangent {
    using OfNodes = Eigen::Matrix<double, Dim, Dim + 1>;
    OfNodes of_ratio = OfNodes::Zero();   ///< dJ/du, 1/m
    OfNodes of_mean = OfNodes::Zero();    ///< dm/du of the mean stress m, Pa m2
    OfNodes of_forces = OfNodes::Zero();  ///< derivative of the forces on its nodes by theta, N
    double of_both = 0.0;                 ///< dm/dtheta - m, Pa m3
  };
  /// Sets the derivatives of an element that shares its dilatation.
  void set_tangent(int element, const Tangent& tangent) { tangent_[element] = tangent; }
  /// Nodes of each patch, whose unknowns are coupled.
  [[nodiscard]] std::vector<std::vector<int>> patch_nodes() const;
  /// Adds the derivative of the forces by the shared ratios to a matrix of this pattern, which has
  /// these patches.
  /// \param mean_ratio  Jm per element
  void add_tangent(const DisplacementUnknowns<Dim>& unknowns, const std::vector<double>& mean_ratio,
                   const StiffnessPattern<Dim>& pattern, Eigen::SparseMatrix<double>& matrix) const;
  /// Adds what `add_tangent` does, for elastic elements without stress and displacement.
  /// \param stiffness  of the mean stress against the dilatation, per element, Pa m3
  void add_elastic(const Grid<Dim>& grid, const DisplacementUnknowns<Dim>& unknowns,
                   const std::vector<double>& stiffness, const StiffnessPattern<Dim>& pattern,
                   Eigen::SparseMatrix<double>& matrix) const;

 private:
  /// Nodes of a patch, and per element the places of its nodes among them.
  struct Patch {
    std::vector<int> elements;
    std::vector<int> nodes;
    std::vector<std::array<int, Dim + 1>> places;
  };

  void add_patch(const Mesh<Dim>& mesh, const std::vector<double>& weight,
                 const std::vector<int>& elements);
  void add(const std::vector<Tangent>& tangent, const DisplacementUnknowns<Dim>& unknowns,
           const std::vector<double>& mean_ratio, const StiffnessPattern<Dim>& pattern,
           Eigen::SparseMatrix<double>& matrix) const;

  std::vector<Patch> patches_;    ///< of two elements or more
  std::vector<double> share_;     ///< per element: w_e / sum w in its patch; 0: not shared
  std::vector<Tangent> tangent_;  ///< per element
};

}  // namespace suffuse
