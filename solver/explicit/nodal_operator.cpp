#include "explicit/nodal_operator.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace suffuse {

template <int Dim>
NodalOperator<Dim>::NodalOperator(const Grid<Dim>& grid, std::vector<FaceCondition> conditions,
                                  Vector<Dim> gravity, bool porosity_gradient_term)
    : grid_(grid),
      conditions_(std::move(conditions)),
      gravity_(gravity),
      porosity_gradient_term_(porosity_gradient_term),
      fixed_flux_(grid.face_count(), 0.0),
      boundary_force_(grid.mesh.node_count(), Vector<Dim>::Zero()) {
  for (const FaceCondition& condition : conditions_) {
    flux_is_fixed_.push_back(condition.fixes_flux() ? 1 : 0);
  }
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (conditions_[f].fixes_flux()) fixed_faces_.push_back(f);
    if (conditions_[f].kind != FaceKind::pressure) continue;
    pressure_faces_.push_back(f);
    pressure_nodes_.insert(pressure_nodes_.end(), grid_.face_nodes[f].begin(),
                           grid_.face_nodes[f].end());
  }
  std::ranges::sort(pressure_nodes_);
  pressure_nodes_.erase(std::unique(pressure_nodes_.begin(), pressure_nodes_.end()),
                        pressure_nodes_.end());
  set_boundary_force();
  make_constraint_normals();
  set_held_values();
}

template <int Dim>
void NodalOperator<Dim>::set_boundary_force() {
  for (const int i : pressure_nodes_) boundary_force_[i].setZero();
  for (const int f : pressure_faces_) {
    for (const int i : grid_.face_nodes[f]) {
      boundary_force_[i] -= conditions_[f].value * grid_.face_normal[f] / Dim;
    }
  }
}

template <int Dim>
void NodalOperator<Dim>::set_boundary_values(const BoundaryValues<Dim>& values,
                                             double pressure_time, double flux_time) {
  values.update(pressure_time, conditions_);
  set_boundary_force();
  for (const int i : pressure_nodes_) {
    external_force_[i] = boundary_force_[i] + node_mass_[i] * gravity_;
  }
  values.update(flux_time, conditions_);
  set_held_values();
  set_fixed_fluxes();
  set_prescribed();
}

template <int Dim>
void NodalOperator<Dim>::archive(StateArchive& archive) {
  archive(on_faces(conditions_), on_nodes(boundary_force_));
  if (archive.restores()) set_held_values();
}

template <int Dim>
void NodalOperator<Dim>::make_constraint_normals() {
  // Faces at less than this angle belong to one smooth wall: the node slides along their mean
  // plane. At a sharper corner each plane holds it.
  const double one_wall = std::cos(20.0 * std::numbers::pi / 180.0);
  for (int i = 0; i < grid_.mesh.node_count(); ++i) {
    struct Plane {
      Vector<Dim> area_normal;
      std::vector<int> faces;
    };
    std::vector<Plane> planes;
    for (int k = grid_.node_face_begin[i]; k < grid_.node_face_begin[i + 1]; ++k) {
      const int f = grid_.node_face[k];
      if (!conditions_[f].fixes_flux()) continue;
      const Vector<Dim>& normal = grid_.face_normal[f];
      auto plane = std::find_if(planes.begin(), planes.end(), [&](const Plane& candidate) {
        return candidate.area_normal.normalized().dot(normal.normalized()) > one_wall;
      });
      if (plane == planes.end()) plane = planes.insert(plane, Plane{Vector<Dim>::Zero(), {}});
      plane->area_normal += normal;
      plane->faces.push_back(f);
    }
    for (Plane& plane : planes) {
      held_.push_back({i, plane.area_normal.normalized(), std::move(plane.faces)});
    }
  }
}

template <int Dim>
void NodalOperator<Dim>::set_held_values() {
  for (HeldNormal& held : held_) {
    double total = 0.0;
    double velocity = 0.0;
    double flux = 0.0;
    for (const int f : held.faces) {
      const double area = grid_.face_normal[f].norm();
      total += area;
      if (conditions_[f].kind == FaceKind::velocity) velocity -= area * conditions_[f].value;
      if (conditions_[f].kind == FaceKind::flux) flux -= area * conditions_[f].value;
    }
    held.velocity = velocity / total;
    held.flux = flux / total;
  }
}

template <int Dim>
void NodalOperator<Dim>::update_constraints() {
  constraints_.clear();
  prescriptions_.clear();
  for (auto first = held_.begin(); first != held_.end();) {
    const int node = first->node;
    const auto last =
        std::find_if(first, held_.end(), [&](const HeldNormal& h) { return h.node != node; });
    const auto rows = static_cast<int>(last - first);
    const auto index = static_cast<int>(first - held_.begin());
    Eigen::Matrix<double, Eigen::Dynamic, Dim> normals(rows, Dim);
    for (int r = 0; r < rows; ++r, ++first) normals.row(r) = first->normal.transpose();
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition{
        Eigen::MatrixXd(normals)};
    const Eigen::MatrixXd inverse = decomposition.pseudoInverse();
    NodeConstraint<Dim> c;
    c.node = node;
    c.prescribed.setZero();
    c.free = Eigen::Matrix<double, Dim, Dim>::Identity() - inverse * normals;
    // Exactly zero where nothing is free: walls must not leak by round-off.
    if (decomposition.rank() == Dim) c.free.setZero();
    constraints_.push_back(c);
    prescriptions_.push_back({index, inverse});
  }
  set_prescribed();
}

template <int Dim>
void NodalOperator<Dim>::set_prescribed() {
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    NodeConstraint<Dim>& c = constraints_[k];
    const auto& inverse = prescriptions_[k].inverse;
    c.prescribed.setZero();
    for (int r = 0; r < inverse.cols(); ++r) {
      const HeldNormal& held = held_[prescriptions_[k].first + r];
      c.prescribed += inverse.col(r) * (held.velocity + held.flux / node_porosity_[c.node]);
    }
  }
}

template <int Dim>
void NodalOperator<Dim>::update(const FlowCoefficients<Dim>& coefficients) {
  const int nodes = grid_.mesh.node_count();
  node_porosity_.assign(nodes, 0.0);
  node_mass_.assign(nodes, 0.0);
  node_drag_.assign(nodes, 0.0);
  const bool quadratic = !coefficients.quadratic_drag.empty();
  node_quadratic_drag_.assign(quadratic ? nodes : 0, 0.0);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const double share = grid_.volume[e] / (Dim + 1);
    for (const int i : grid_.mesh.elements[e]) {
      node_porosity_[i] += share / coefficients.porosity[e];
      node_mass_[i] += share * coefficients.mixture_density[e];
      node_drag_[i] += share * coefficients.drag[e] / coefficients.porosity[e];
      if (quadratic) node_quadratic_drag_[i] += share * coefficients.quadratic_drag[e];
    }
  }
  // Elements of nodes at the fringe are not all here.
  for (std::vector<double>* values :
       {&node_porosity_, &node_mass_, &node_drag_, &node_quadratic_drag_}) {
    if (!values->empty()) grid_.node_rows().exchange(*values);
  }
  external_force_ = boundary_force_;
  for (int i = 0; i < nodes; ++i) {
    node_porosity_[i] = grid_.node_volume[i] / node_porosity_[i];
    node_drag_[i] *= node_porosity_[i];
    if (quadratic) node_quadratic_drag_[i] *= node_porosity_[i] * node_porosity_[i];
    external_force_[i] += node_mass_[i] * gravity_;
  }
  carried_porosity_ =
      porosity_gradient_term_ ? node_porosity_ : std::vector<double>(node_porosity_.size(), 1.0);
  set_fixed_fluxes();
  update_constraints();
}

template <int Dim>
void NodalOperator<Dim>::set_fixed_fluxes() {
  for (const int f : fixed_faces_) {
    double porosity = 0.0;
    for (const int i : grid_.face_nodes[f]) porosity += node_porosity_[i] / Dim;
    double inward = conditions_[f].value;
    if (conditions_[f].kind == FaceKind::velocity) inward *= porosity;
    if (!porosity_gradient_term_) inward /= porosity;
    fixed_flux_[f] = -grid_.face_normal[f].norm() * inward;
  }
}

template class NodalOperator<2>;

}  // namespace suffuse
