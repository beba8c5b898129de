#include "explicit/stability_limit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace suffuse {
namespace {

/// M^-1 A as a symmetric operator on sqrt(n_i m_i) v_i, without the directions that walls and
/// prescribed fluxes hold.
template <int Dim>
class Compression {
 public:
  Compression(const NodalOperator<Dim>& op, const FlowCoefficients<Dim>& coefficients,
              double bulk_modulus, double mass_scaling)
      : op_(op),
        no_pressure_(coefficients.water_volume.size(), 0.0),
        weight_(op.grid().mesh.node_count()) {
    for (const double volume : coefficients.water_volume)
      stiffness_.push_back(bulk_modulus / volume);
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      weight_[i] = std::sqrt(op.carried_porosity()[i] / (mass_scaling * op.node_mass()[i]));
    }
  }

  [[nodiscard]] Eigen::Index size() const {
    return static_cast<Eigen::Index>(weight_.size()) * Dim;
  }

  /// Removes the held directions.
  void constrain(Eigen::VectorXd& u) const {
    for (const auto& c : op_.constraints()) {
      u.template segment<Dim>(Dim * c.node) = c.free * u.template segment<Dim>(Dim * c.node);
    }
  }

  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& u) const {
    const Grid<Dim>& grid = op_.grid();
    VectorField<Dim> velocity(weight_.size());
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      velocity[i] = weight_[i] / op_.carried_porosity()[i] * u.template segment<Dim>(Dim * i);
    }
    std::vector<double> pressure(stiffness_.size(), 0.0);
    for (int f = 0; f < grid.face_count(); ++f) {
      if (op_.conditions()[f].fixes_flux()) continue;
      const double flux = op_.face_flux(f, velocity);
      pressure[grid.face_left[f]] -= stiffness_[grid.face_left[f]] * flux;
      if (!grid.is_outer(f)) pressure[grid.face_right[f]] += stiffness_[grid.face_right[f]] * flux;
    }
    Eigen::VectorXd result(size());
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      const auto node = static_cast<int>(i);
      result.template segment<Dim>(Dim * i) =
          weight_[i] * (op_.force(node, no_pressure_) - op_.force(node, pressure));
    }
    constrain(result);
    return result;
  }

 private:
  const NodalOperator<Dim>& op_;
  std::vector<double> no_pressure_;
  std::vector<double> weight_;  ///< sqrt(n_i / m_i)
  std::vector<double> stiffness_;
};

/// Upper bound of the operator's largest eigenvalue, by the error estimate of Lanczos' method.
template <int Dim>
double largest_eigenvalue(const Compression<Dim>& compression) {
  constexpr int max_rounds = 200;
  constexpr double goal = 1e-4;
  const Eigen::Index size = compression.size();
  Eigen::VectorXd now(size);
  // A fixed sequence with a part of every mode: the answer is the same every time.
  for (Eigen::Index k = 0; k < size; ++k) {
    now[k] = std::sin(static_cast<double>(k + 1) * 12.9898);
  }
  compression.constrain(now);
  now.normalize();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(size);
  std::vector<double> diagonal;
  std::vector<double> off_diagonal;
  double bound = 0.0;
  for (int round = 0; round < max_rounds; ++round) {
    Eigen::VectorXd next = compression(now);
    diagonal.push_back(now.dot(next));
    next -= diagonal.back() * now;
    if (!off_diagonal.empty()) next -= off_diagonal.back() * before;
    const double norm = next.norm();
    const Eigen::Map<const Eigen::VectorXd> d(diagonal.data(),
                                              static_cast<Eigen::Index>(diagonal.size()));
    const Eigen::Map<const Eigen::VectorXd> b(off_diagonal.data(),
                                              static_cast<Eigen::Index>(off_diagonal.size()));
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(d, b);
    const Eigen::Index last = d.size() - 1;
    const double largest = solver.eigenvalues()[last];
    const double error = norm * std::abs(solver.eigenvectors()(last, last));
    bound = largest + error;
    if (error <= goal * largest || norm == 0.0) break;
    off_diagonal.push_back(norm);
    before = now;
    now = next / norm;
  }
  return bound;
}

}  // namespace

double stable_step(double omega, double damping, DragIntegration drag) {
  const double root = std::sqrt(damping * damping + 4.0 * omega * omega);
  // 4 / (root + a) for explicit drag: the difference root - a cancels for strong drag.
  if (drag == DragIntegration::explicit_drag) return 4.0 / (root + damping);
  return (damping + root) / (omega * omega);
}

template <int Dim>
StabilityLimit stability_limit(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                               const std::vector<double>& carried_porosity, double bulk_modulus,
                               double mass_scaling, DragIntegration drag,
                               const std::vector<double>& node_speed) {
  StabilityLimit limit{std::numeric_limits<double>::infinity(), -1};
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const bool explicit_drag = drag == DragIntegration::explicit_drag;
    double sum = 0.0;
    double drag_at_worst = explicit_drag ? 0.0 : std::numeric_limits<double>::infinity();
    for (int k = 0; k <= Dim; ++k) {
      const int i = grid.mesh.elements[e][k];
      const double n = carried_porosity[i];
      sum += n * grid.shape_gradient[e][k].squaredNorm();
      double node_drag = n * coefficients.drag[e] / coefficients.porosity[e];
      if (!coefficients.quadratic_drag.empty() && !node_speed.empty()) {
        // The slope of b |q| q is twice its secant, which an implicit step uses.
        node_drag +=
            (explicit_drag ? 2.0 : 1.0) * coefficients.quadratic_drag[e] * n * n * node_speed[i];
      }
      drag_at_worst =
          explicit_drag ? std::max(drag_at_worst, node_drag) : std::min(drag_at_worst, node_drag);
    }
    const double mass = coefficients.mixture_density[e] * mass_scaling;
    const double water_fraction = coefficients.water_volume[e] / grid.volume[e];
    const double omega = std::sqrt((Dim + 1) * bulk_modulus / mass * sum / water_fraction);
    const double step = stable_step(omega, drag_at_worst / mass, drag);
    if (step < limit.step) limit = {step, e};
  }
  return limit;
}

template <int Dim>
double assembled_limit(const NodalOperator<Dim>& op, const FlowCoefficients<Dim>& coefficients,
                       double bulk_modulus, double mass_scaling, DragIntegration drag,
                       const std::vector<double>& node_speed, PressureIntegration integration) {
  double omega =
      std::sqrt(largest_eigenvalue(Compression<Dim>(op, coefficients, bulk_modulus, mass_scaling)));
  constexpr double min_passed_on = 1.0 / (2.0 * Dim);  // theta
  if (integration == PressureIntegration::material_point) {
    omega *= std::sqrt(2.0 - min_passed_on);
  }
  const bool explicit_drag = drag == DragIntegration::explicit_drag;
  double damping = explicit_drag ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < op.node_drag().size(); ++i) {
    double node_drag = op.node_drag()[i];
    if (!op.node_quadratic_drag().empty() && !node_speed.empty()) {
      node_drag += (explicit_drag ? 2.0 : 1.0) * op.node_quadratic_drag()[i] * node_speed[i];
    }
    const double rate = node_drag / (mass_scaling * op.node_mass()[i]);
    damping = explicit_drag ? std::max(damping, rate) : std::min(damping, rate);
  }
  return stable_step(omega, damping, drag);
}

template double assembled_limit(const NodalOperator<2>&, const FlowCoefficients<2>&, double, double,
                                DragIntegration, const std::vector<double>&, PressureIntegration);
template StabilityLimit stability_limit(const Grid<2>&, const FlowCoefficients<2>&,
                                        const std::vector<double>&, double, double, DragIntegration,
                                        const std::vector<double>&);

}  // namespace suffuse
