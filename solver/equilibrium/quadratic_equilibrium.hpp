#pragma once

/// Forces of the solid for quadratic displacements that are small.

#include <vector>

#include "equilibrium/equilibrium.hpp"
#include "solid/quadratic_shapes.hpp"

namespace suffuse {

/// Equilibrium with quadratic displacements (6 nodes per triangle, 10 per tetrahedron):
///
///     R_u = sum_e sum_q w_q [tau_q F^-T - p_q I] grad N - loads,  F = I + grad du
///
/// Linear displacements cannot follow a slip surface and carry more than the limit load on coarse
/// meshes; quadratic ones do not lock (Sloan and Randolph, Int. J. Numer. Anal. Meth. Geomech. 6
/// (1982) 47). The stress is that at the Dim + 1 points q of the quadrature of degree two, with the
/// law, the parameters and the state of the solid point nearest to each. w_q is an equal share of
/// the volume that counts as soil. The pore pressure is linear in each element, with the gradient
/// that fits the elements around it best. Contributions of elements are added in the order of the
/// elements: the same bits on any number of threads.
template <int Dim>
class QuadraticEquilibrium final : public ForceBalance<Dim> {
 public:
  /// Keeps references to the body and the shapes.
  QuadraticEquilibrium(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                       const QuadraticShapes<Dim>& shapes, int threads);

  /// Pore pressure per element, Pa; empty: none.
  void set_pressure(const std::vector<double>& pressure);

  [[nodiscard]] const DisplacementUnknowns<Dim>& unknowns() const override { return unknowns_; }
  [[nodiscard]] bool is_possible(const NodeVectors<Dim>& displacement) const override;
  void displace(const NodeVectors<Dim>& displacement, bool with_tangents) override;
  void find_tangents() override {
    if (!has_tangents_) displace(NodeVectors<Dim>(displacement_), true);
  }
  [[nodiscard]] NodeVectors<Dim> forces() const override;
  [[nodiscard]] double force_scale() const override;
  [[nodiscard]] bool has_inertia() const override { return false; }
  using typename ForceBalance<Dim>::Pattern;
  bool share_pattern(Pattern& pattern) override;
  void assemble(Eigen::SparseMatrix<double>& tangent) override;
  void assemble_elastic(Eigen::SparseMatrix<double>& stiffness) override;

 private:
  static constexpr int points = Dim + 1;  ///< of the quadrature in an element
  static constexpr int count = QuadraticShapes<Dim>::count;
  using Gradient = Eigen::Matrix<double, Dim, Dim>;
  using Gradients = typename QuadraticShapes<Dim>::Gradients;
  using Tangent = DeformationTangent<Dim>;

  /// What an element has at a point of the quadrature.
  struct QuadraturePoint {
    int solid_point = -1;               ///< the nearest one
    double pressure = 0.0;              ///< of the pores, Pa
    Tangent tangent = Tangent::Zero();  ///< of the laws, Pa
  };

  [[nodiscard]] Gradients gradients_at(int element, int point) const;
  [[nodiscard]] Gradient displacement_gradient(int element, const Gradients& shapes,
                                               const NodeVectors<Dim>& displacement) const;
  /// Calls a function with each element that has points, on several threads.
  void for_each_element(const auto& call) const;
  void respond(int element);
  void scatter(const auto& tangent_of, Eigen::SparseMatrix<double>& matrix);

  SolidBody<Dim> body_;
  const QuadraticShapes<Dim>& shapes_;
  int threads_;
  std::vector<int> elements_;  ///< those with points
  Supports<Dim> supports_;     ///< of nodes and edges
  DisplacementUnknowns<Dim> unknowns_;
  std::vector<double> soil_volume_;  ///< per element, m3
  std::vector<double> soft_;         ///< per element: stiffness against grad du, Pa m3
  std::vector<std::array<QuadraturePoint, points>> quadrature_;  ///< per element
  std::vector<Gradients> force_;                                 ///< per element, N
  NodeVectors<Dim> displacement_;                                ///< the last displacement, m
  bool has_tangents_ = false;
  double least_force_ = 0.0;  ///< part of `force_scale`, N
  Pattern pattern_;           ///< set when a matrix is first needed
};

}  // namespace suffuse
