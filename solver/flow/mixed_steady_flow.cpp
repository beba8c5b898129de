#include "flow/mixed_steady_flow.hpp"

#include <Eigen/SparseCholesky>

#include "case/errors.hpp"

namespace suffuse {

template <int Dim>
std::vector<Vector<Dim>> mixed_steady_flux(const Grid<Dim>& grid,
                                           const std::vector<FaceCondition>& conditions,
                                           const FlowCoefficients<Dim>& coefficients,
                                           const Vector<Dim>& gravity) {
  const int elements = grid.mesh.element_count();
  const int faces = grid.face_count();
  // Unknown pressures are those of faces where none is prescribed. Without any prescribed pressure
  // the level is free: the first face holds it.
  std::vector<int> unknown(faces, -1);
  int unknowns = 0;
  bool level_known = false;
  for (int f = 0; f < faces; ++f) level_known |= conditions[f].kind == FaceKind::pressure;
  for (int f = level_known ? 0 : 1; f < faces; ++f) {
    if (conditions[f].kind != FaceKind::pressure) unknown[f] = unknowns++;
  }
  const auto pressure_at = [&](int f, const Eigen::VectorXd& solution) {
    if (unknown[f] >= 0) return solution[unknown[f]];
    return conditions[f].kind == FaceKind::pressure ? conditions[f].value : 0.0;
  };

  // Basis function 1 - Dim lambda_k of face k has the gradient -Dim grad lambda_k. With drag
  // divided by n_L, q = (n / drag) (rho g - grad p) in drag's units.
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns);
  for (int e = 0; e < elements; ++e) {
    const double mobility = coefficients.porosity[e] / coefficients.drag[e];
    for (int a = 0; a <= Dim; ++a) {
      const int row = unknown[grid.element_face[e][a]];
      if (row < 0) continue;
      const Vector<Dim> gradient_a = -Dim * grid.shape_gradient[e][a];
      load[row] +=
          grid.volume[e] * mobility * coefficients.mixture_density[e] * gradient_a.dot(gravity);
      for (int b = 0; b <= Dim; ++b) {
        const int f = grid.element_face[e][b];
        const double entry =
            grid.volume[e] * mobility * gradient_a.dot(-Dim * grid.shape_gradient[e][b]);
        if (unknown[f] >= 0) {
          entries.emplace_back(row, unknown[f], entry);
        } else if (conditions[f].kind == FaceKind::pressure) {
          load[row] -= entry * conditions[f].value;
        }
      }
    }
  }
  for (int f = 0; f < faces; ++f) {
    if (unknown[f] < 0 || !conditions[f].fixes_flux()) continue;
    double inward = conditions[f].value;
    if (conditions[f].kind == FaceKind::velocity) {
      inward *= coefficients.porosity[grid.face_left[f]];
    }
    load[unknown[f]] += grid.face_normal[f].norm() * inward;
  }

  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) {
    throw NumericalError("the steady flow could not be solved: the factorisation failed");
  }
  const Eigen::VectorXd solution = solver.solve(load);

  std::vector<Vector<Dim>> flux(elements);
  for (int e = 0; e < elements; ++e) {
    Vector<Dim> gradient = Vector<Dim>::Zero();
    for (int k = 0; k <= Dim; ++k) {
      gradient -= Dim * pressure_at(grid.element_face[e][k], solution) * grid.shape_gradient[e][k];
    }
    flux[e] = coefficients.porosity[e] / coefficients.drag[e] *
              (coefficients.mixture_density[e] * gravity - gradient);
  }
  return flux;
}

template std::vector<Vector<2>> mixed_steady_flux(const Grid<2>&, const std::vector<FaceCondition>&,
                                                  const FlowCoefficients<2>&, const Vector<2>&);

}  // namespace suffuse
