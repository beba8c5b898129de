#include "explicit/steady_nodal.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/errors.hpp"

namespace suffuse {
namespace {

/// Velocity that balances a pressure against a drag per node, kg/s.
template <int Dim>
VectorField<Dim> balanced_velocity(const NodalOperator<Dim>& op, const std::vector<double>& drag,
                                   const std::vector<double>& pressure) {
  VectorField<Dim> velocity(op.grid().mesh.node_count());
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    velocity[i] = op.force(static_cast<int>(i), pressure) / drag[i];
  }
  op.constrain(velocity);
  return velocity;
}

/// Net outflow of every element, m3/s, and the largest flux through a face.
template <int Dim>
Eigen::VectorXd net_outflow(const NodalOperator<Dim>& op, const VectorField<Dim>& velocity,
                            double& largest_flux) {
  const Grid<Dim>& grid = op.grid();
  Eigen::VectorXd outflow = Eigen::VectorXd::Zero(grid.mesh.element_count());
  largest_flux = 0.0;
  for (int f = 0; f < grid.face_count(); ++f) {
    const double flux = op.face_flux(f, velocity);
    largest_flux = std::max(largest_flux, std::abs(flux));
    outflow[grid.face_left[f]] += flux;
    if (!grid.is_outer(f)) outflow[grid.face_right[f]] -= flux;
  }
  return outflow;
}

/// d(net outflow)/d(pressure): symmetric, positive semi-definite.
template <int Dim>
Eigen::SparseMatrix<double> pressure_matrix(const NodalOperator<Dim>& op,
                                            const std::vector<double>& drag) {
  const Grid<Dim>& grid = op.grid();
  const int nodes = grid.mesh.node_count();
  std::vector<Eigen::Matrix<double, Dim, Dim>> free(nodes,
                                                    Eigen::Matrix<double, Dim, Dim>::Identity());
  for (const auto& c : op.constraints()) free[c.node] = c.free;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < nodes; ++i) {
    const int first = grid.node_element_begin[i];
    const int last = grid.node_element_begin[i + 1];
    // Force on the node per pascal of each element around it.
    VectorField<Dim> gradient(last - first, Vector<Dim>::Zero());
    for (int a = first; a < last; ++a) {
      const int e = grid.node_element[a];
      for (int k = 0; k <= Dim; ++k) {
        const int f = grid.element_face[e][k];
        if (grid.mesh.elements[e][k] == i || op.conditions()[f].fixes_flux()) continue;
        gradient[a - first] += grid.element_face_sign[e][k] * grid.face_normal[f] / Dim;
      }
    }
    const double mobility = op.carried_porosity()[i] / drag[i];
    for (int a = first; a < last; ++a) {
      for (int b = first; b < last; ++b) {
        entries.emplace_back(grid.node_element[a], grid.node_element[b],
                             mobility * gradient[a - first].dot(free[i] * gradient[b - first]));
      }
    }
  }
  const int elements = grid.mesh.element_count();
  Eigen::SparseMatrix<double> matrix(elements, elements);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Steady flow against a linear drag per node.
template <int Dim>
NodalSteadyState<Dim> linear_steady_flow(const NodalOperator<Dim>& op,
                                         const std::vector<double>& drag) {
  constexpr double storage_share = 1e-7;  // of the matrix' own diagonal
  constexpr int max_solves = 60;
  constexpr double goal = 1e-14;

  Eigen::SparseMatrix<double> matrix = pressure_matrix(op, drag);
  const Eigen::VectorXd diagonal = matrix.diagonal();
  for (int e = 0; e < matrix.rows(); ++e) {
    // An element with all nodes held has a zero diagonal.
    matrix.coeffRef(e, e) +=
        storage_share * (diagonal[e] > 0.0 ? diagonal[e] : diagonal.maxCoeff());
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) {
    throw NumericalError("the steady initial flow could not be solved: the factorisation failed");
  }
  // Flux that the largest pressure could drive through a face; at rest, fluxes are its round-off.
  const auto drivable_flux = [&](const std::vector<double>& pressure) {
    double largest = 0.0;
    for (const double p : pressure) largest = std::max(largest, std::abs(p));
    return largest * diagonal.maxCoeff();
  };
  NodalSteadyState<Dim> state;
  state.pressure.assign(matrix.rows(), 0.0);
  double previous = std::numeric_limits<double>::infinity();
  for (int solve = 0; solve < max_solves; ++solve) {
    state.velocity = balanced_velocity(op, drag, state.pressure);
    double largest_flux = 0.0;
    const Eigen::VectorXd outflow = net_outflow(op, state.velocity, largest_flux);
    const double worst = outflow.cwiseAbs().maxCoeff();
    const double scale = std::max(largest_flux, 1e-9 * drivable_flux(state.pressure));
    state.imbalance = scale > 0.0 ? worst / scale : 0.0;
    if (state.imbalance <= goal || (solve > 2 && worst >= 0.5 * previous)) break;
    previous = worst;
    const Eigen::VectorXd correction = solver.solve(outflow);
    for (Eigen::Index e = 0; e < correction.size(); ++e) state.pressure[e] -= correction[e];
  }
  return state;
}

}  // namespace

template <int Dim>
NodalSteadyState<Dim> steady_flow(const NodalOperator<Dim>& op) {
  constexpr int max_iterations = 200;
  constexpr double goal = 1e-12;
  const std::vector<double>& quadratic = op.node_quadratic_drag();
  NodalSteadyState<Dim> state = linear_steady_flow(op, op.node_drag());
  if (quadratic.empty()) return state;
  // Average of the last drag and the new secant, as the secant alone overshoots.
  std::vector<double> drag = op.node_drag();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    double change = 0.0;
    for (std::size_t i = 0; i < drag.size(); ++i) {
      const double secant = op.node_drag()[i] + quadratic[i] * state.velocity[i].norm();
      change = std::max(change, std::abs(secant - drag[i]) / drag[i]);
      drag[i] = 0.5 * (drag[i] + secant);
    }
    if (change <= goal) return state;
    state = linear_steady_flow(op, drag);
  }
  throw NumericalError(
      "the steady initial flow with Ergun's drag was not found: its drag still changes");
}

template NodalSteadyState<2> steady_flow(const NodalOperator<2>&);

}  // namespace suffuse
