#pragma once

/// Forces of the solid on the nodes and their tangent, as functions of the displacement over a
/// step.

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "equilibrium/force_balance.hpp"
#include "equilibrium/shared_dilatation.hpp"
#include "physics/skeleton/skeleton_response.hpp"
#include "solid/element_classes.hpp"
#include "solid/supports.hpp"

namespace suffuse {

/// Present law and parameters of the skeleton at a point.
struct PointSkeleton {
  const SkeletonLaw* law;
  SkeletonParameters parameters;
};

/// Law and parameters of a soil with this share of its erodible fines left. Rigid soil is held at
/// its nodes: its law only has to return zero stress.
PointSkeleton skeleton_at(const SkeletonModel& model, double fines_left);

/// Stiffness of partial elements against the displacement of a step, in Young's moduli. It does not
/// act on earlier displacements, so it does not carry the soil.
struct SoftStiffness {
  /// Against the gradient: without it a piece of soil connected by one node can rotate freely, and
  /// Newton's method stalls.
  double gradient = 0.01;
  /// Stiffness against strain, per node. An element takes the largest of its nodes. Without it
  /// little holds the nodes of a surface that sinks through elements. It does not act on soil that
  /// yields, which would stand where it fails. Empty: none.
  std::vector<double> strain = {};
};
/// Inertia holds what one node connects.
inline SoftStiffness soft_with_inertia() {
  return {.gradient = 0.0};
}

/// The solid at the start of a step. Keeps references.
template <int Dim>
struct SolidBody {
  const Grid<Dim>& grid;
  const SolidPoints<Dim>& points;
  const PointsByElement& sorted;
  const std::vector<PointSkeleton>& skeleton;  ///< per point
  const ElementClasses& classes;
  SoftStiffness soft = {};
  /// Unit weight of soil with its water per element, N/m3; empty: none.
  std::vector<Vector<Dim>> weight = {};
};

/// Elements with points, ascending.
template <int Dim>
std::vector<int> elements_with_points(const SolidBody<Dim>& body);

/// Hooke's law: the derivative of the stress by the gradient of a small displacement.
template <int Dim>
DeformationTangent<Dim> hooke_tangent(double lame, double shear);

/// Increments F = I + grad du of the deformation gradient, per element.
template <int Dim>
using Increments = std::vector<Eigen::Matrix<double, Dim, Dim>>;

/// Those of a displacement of the nodes, m.
template <int Dim>
Increments<Dim> increments_of(const Grid<Dim>& grid, const NodeVectors<Dim>& displacement);

/// Equilibrium over one step about the places at its start (updated Lagrangian), with linear
/// displacements, F = I + grad du:
///
///     R_u = sum_e [scale sum_p V_0 tau F^-T + S_e - p V_e J F^-T] grad N - loads
///           + M (du - dt v*)/dt^2 where inertia counts (backward Euler)
///
/// tau is the Kirchhoff stress of a point by its law, S_e the stress of the soft stiffness (with
/// inertia, that of light nodes against the gradient of du - dt v*), p the pore pressure of the
/// element and J = det F (docs/theory/moving-soil.md, "Equilibrium of the solid"). Where elements
/// share their dilatation, laws see (Jm/J)^(1/d) F. Jm is the mean ratio of `SharedDilatation`; the
/// forces do the same work as the laws. Contributions of elements are added in the order of the
/// elements: the same bits on any number of threads.
template <int Dim>
class Equilibrium final : public ForceBalance<Dim> {
 public:
  using Gradient = Eigen::Matrix<double, Dim, Dim>;

  /// Keeps references to the body and the supports.
  Equilibrium(const SolidBody<Dim>& body, const Supports<Dim>& supports, int threads);

  [[nodiscard]] const DisplacementUnknowns<Dim>& unknowns() const override { return unknowns_; }
  /// Pore pressure per element, Pa; empty: none.
  /// \param stiffness  the pressure falls by this times J - 1, per element, Pa; empty: by nothing
  void set_pressure(std::vector<double> pressure, std::vector<double> stiffness = {});
  /// Unit weight of soil with its water, N/m3 per element, for `set_pressure`. A patch has one mean
  /// effective stress; about that the total stress varies within the patch as below level ground.
  /// Without this variation the patches of level soil bear their weight by shear stresses, which
  /// weak soil does not have.
  void set_weight(const std::vector<Vector<Dim>>& weight) {
    if (dilatation_.acts()) variation_ = dilatation_.variation(body_.grid.mesh, weight);
  }

  /// Inertia over a step of `dt`, s: the mass of each node, kg, and its velocity at the start, m/s.
  /// The inertia of light nodes replaces the soft stiffness against the gradient.
  void set_inertia(const std::vector<double>& mass, const NodeVectors<Dim>& velocity, double dt);

  /// Whether a displacement leaves each element with soil more than `min_ratio` of its volume.
  [[nodiscard]] bool is_possible(const NodeVectors<Dim>& displacement) const override;
  void displace(const NodeVectors<Dim>& displacement, bool with_tangents) override;
  void find_tangents() override {
    if (!has_tangents_) displace(NodeVectors<Dim>(displacement_), true);
  }
  /// To be called after the stress of the points has changed.
  void forget_displacement() { displacement_.clear(); }

  [[nodiscard]] NodeVectors<Dim> forces() const override;
  /// Norm of the forces of inertia, N.
  [[nodiscard]] double inertia_norm() const;
  [[nodiscard]] bool has_inertia() const override { return !inertia_.empty(); }
  [[nodiscard]] double force_scale() const override;
  /// Increments that laws see at a possible displacement, m.
  [[nodiscard]] Increments<Dim> law_increments(const NodeVectors<Dim>& displacement) const;
  using typename ForceBalance<Dim>::Pattern;
  bool share_pattern(Pattern& pattern) override;
  void assemble(Eigen::SparseMatrix<double>& tangent) override;
  void assemble_elastic(Eigen::SparseMatrix<double>& stiffness) override;

  /// Mean effective stress sigma' of an element with soil, after the displacement, Pa; tension is
  /// positive. In two dimensions, the part in the plane. In a patch, the one that is in balance.
  [[nodiscard]] Gradient mean_stress(int element) const {
    return effective_[element] / (soil_volume_[element] * ratio_[element]);
  }
  /// Mean elastic parameters of an element with soil: Lame's first parameter and the shear modulus,
  /// Pa.
  struct Moduli {
    double lame = 0.0;
    double shear = 0.0;
  };
  [[nodiscard]] Moduli mean_moduli(int element) const;
  /// Volume of an element that counts as soil at the start of the step, m3.
  [[nodiscard]] double soil_volume(int element) const { return soil_volume_[element]; }
  [[nodiscard]] const std::vector<double>& soil_volumes() const { return soil_volume_; }

  /// Least det F after a step.
  static constexpr double min_ratio = 0.1;

 private:
  static constexpr int size = Dim * (Dim + 1);
  using Tangent = DeformationTangent<Dim>;
  using ElementMatrix = Eigen::Matrix<double, size, size>;

  void set_soft_stiffness(int element);
  [[nodiscard]] Gradient soft_stress(int element) const;
  [[nodiscard]] Tangent soft_tangent(int element) const;
  [[nodiscard]] Tangent elastic_tangent(int element) const;
  /// Calls a function with each element that has points, on several threads.
  void for_each_element(const auto& call) const;
  void respond(bool with_tangents, int element);
  /// Sets the forces, and their tangent, of an element that shares its dilatation, with what
  /// `SharedDilatation::spread` gives it, Pa m3.
  void share_stress(double spread, bool with_tangents, int element);
  void share_tangent(double mu, const Gradient& working, int element);
  /// Pore pressure of an element at its present volume, Pa.
  [[nodiscard]] double pressure_at(int e) const {
    return pressure_[e] - (stiffness_.empty() ? 0.0 : stiffness_[e] * (ratio_[e] - 1.0));
  }
  [[nodiscard]] Gradient total_stress(int element) const;
  [[nodiscard]] Tangent total_tangent(int element) const;
  [[nodiscard]] ElementMatrix element_matrix(int element, const Tangent& tangent) const;
  [[nodiscard]] Vector<Dim> inertia_force(int node) const {
    return inertia_[node] * (displacement_[node] - coasting_[node]);
  }
  void add_inertia(Eigen::SparseMatrix<double>& matrix) const;
  void scatter(const auto& tangent_of, Eigen::SparseMatrix<double>& matrix);

  SolidBody<Dim> body_;
  int threads_;
  std::vector<int> elements_;  ///< those with points
  DisplacementUnknowns<Dim> unknowns_;
  std::vector<double> pressure_;   ///< with the variation of the total stress in patches
  std::vector<double> variation_;  ///< of the total stress in patches, per element, Pa
  std::vector<double> stiffness_;
  std::vector<double> inertia_;    ///< M/dt^2 per node, N/m; empty: none
  NodeVectors<Dim> coasting_;      ///< dt v* per node, m
  NodeVectors<Dim> displacement_;  ///< the last displacement, m
  bool has_tangents_ = false;      ///< whether tangents are those of `displacement_`
  double least_force_ = 0.0;       ///< part of `force_scale`, N
  /// Per element: stiffness against grad du, or that of du - dt v* with inertia, Pa m3 ...
  std::vector<double> soft_;
  std::vector<double> soft_strain_;  ///< ... and against its symmetric part
  SharedDilatation<Dim> dilatation_;
  std::vector<Gradient> moved_;      ///< grad du per element
  std::vector<Gradient> inverse_;    ///< F^-1 per element
  std::vector<double> ratio_;        ///< det F per element
  std::vector<double> mean_ratio_;   ///< that laws see
  std::vector<Gradient> stress_;     ///< V_e P of the laws per element, Pa m3
  std::vector<Gradient> effective_;  ///< V_e J sigma' per element, Pa m3
  std::vector<double> soil_volume_;  ///< per element, m3
  std::vector<Tangent> tangent_;     ///< derivative of `stress_` by F
  Pattern pattern_;                  ///< set when a matrix is first needed
};

}  // namespace suffuse
