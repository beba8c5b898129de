#include "points/concentration_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

constexpr int max_rounds = 4;
/// Smallest ratio of the eigenvalues of the normal matrix, with lengths relative to the element,
/// for a fit of slopes: a few points spread over a tenth of the element.
constexpr double min_spread = 1e-3;

template <int Dim>
using Row = Eigen::Matrix<double, Dim + 1, 1>;

/// A row of the fit: 1 and the place relative to the element's centroid and size.
template <int Dim>
Row<Dim> row_at(const Vector<Dim>& x, const Vector<Dim>& centre, double size) {
  Row<Dim> row;
  row[0] = 1.0;
  row.template tail<Dim>() = (x - centre) / size;
  return row;
}

/// Adds to `patch` the neighbours in the same region of its elements from `begin` on.
template <int Dim>
void add_neighbours(const Grid<Dim>& grid, std::vector<int>& patch, std::size_t begin) {
  const std::size_t end = patch.size();
  for (std::size_t i = begin; i < end; ++i) {
    const int e = patch[i];
    for (int k = 0; k <= Dim; ++k) {
      const int next = grid.across(e, k);
      if (next < 0) continue;
      const auto& region = grid.mesh.element_region;
      const bool known = std::find(patch.begin(), patch.end(), next) != patch.end();
      if (!known && region[next] == region[e]) patch.push_back(next);
    }
  }
}

}  // namespace

template <int Dim>
ElementField<Dim> concentration_fit(const Grid<Dim>& grid, const LiquidPoints<Dim>& points,
                                    const std::vector<int>& begins,
                                    const std::vector<double>& volume,
                                    const std::vector<double>& concentration) {
  ElementField<Dim> result(grid.mesh.element_count());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const Vector<Dim> centre = element_centroid(grid.mesh, e);
    const double size = std::pow(grid.volume[e], 1.0 / Dim);
    Eigen::Matrix<double, Dim + 1, Dim + 1> normal;
    normal.setZero();
    Row<Dim> load = Row<Dim>::Zero();
    Row<Dim> function = Row<Dim>::Zero();
    std::vector<int> patch{e};
    std::size_t taken = 0;
    std::size_t ring = 0;
    for (int round = 0; round < max_rounds; ++round) {
      const std::size_t ring_begin = ring;
      ring = patch.size();
      add_neighbours(grid, patch, ring_begin);
      for (; taken < patch.size(); ++taken) {
        for (int p = begins[patch[taken]]; p < begins[patch[taken] + 1]; ++p) {
          const Row<Dim> row = row_at<Dim>(points.place(p).position(grid.mesh), centre, size);
          normal += volume[p] * row * row.transpose();
          load += volume[p] * concentration[p] * row;
        }
      }
      if (normal(0, 0) <= 0.0) continue;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim + 1, Dim + 1>> solver(normal);
      if (solver.eigenvalues()[0] > min_spread * solver.eigenvalues()[Dim]) {
        function = normal.ldlt().solve(load);
        break;
      }
      function[0] = load[0] / normal(0, 0);
    }
    for (int j = 0; j <= Dim; ++j) {
      const Vector<Dim> x = FieldNodes<Dim>::position(grid.mesh, e, j);
      result[e][j] = function.dot(row_at<Dim>(x, centre, size));
    }
  }
  return result;
}

template ElementField<2> concentration_fit(const Grid<2>&, const LiquidPoints<2>&,
                                           const std::vector<int>&, const std::vector<double>&,
                                           const std::vector<double>&);

template ElementField<3> concentration_fit(const Grid<3>&, const LiquidPoints<3>&,
                                           const std::vector<int>&, const std::vector<double>&,
                                           const std::vector<double>&);

}  // namespace suffuse
