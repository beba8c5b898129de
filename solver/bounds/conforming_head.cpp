#include "bounds/conforming_head.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace suffuse {
namespace {

/// Means of elements are right but for what varies from node to node, which a few iterations
/// remove. Where conductivities differ by orders of magnitude it takes more of them.
constexpr int first_iterations = 20;
constexpr int most_iterations = 1280;
/// Iterations end when the last ones have gained less than this share of the squared gap.
constexpr double least_gain = 0.02;

template <int Dim>
std::vector<double> node_means(const SeepageEnergy<Dim>& energy,
                               const std::vector<double>& face_head,
                               const std::vector<std::optional<double>>& prescribed) {
  const Grid<Dim>& grid = energy.grid();
  std::vector<double> sum(prescribed.size(), 0.0);
  std::vector<double> weights(prescribed.size(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double weight = grid.volume[e] * energy.mean_conductivity(e);
    double all_faces = 0.0;
    for (const int f : grid.element_face[e]) all_faces += face_head[f];
    for (int k = 0; k <= Dim; ++k) {
      const int i = grid.mesh.elements[e][k];
      sum[i] += weight * (all_faces - Dim * face_head[grid.element_face[e][k]]);
      weights[i] += weight;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = prescribed[i].value_or(weights[i] > 0.0 ? sum[i] / weights[i] : 0.0);
  }
  return sum;
}

/// Gives each entry of the matrix of the energy to `add(i, j, value)`.
template <int Dim>
void for_each_entry(const SeepageEnergy<Dim>& energy, const auto& add) {
  const Grid<Dim>& grid = energy.grid();
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) {
      const Vector<Dim> conducted = grid.volume[e] * energy.conduct(e, grid.shape_gradient[e][a]);
      for (int b = 0; b <= Dim; ++b) {
        add(grid.mesh.elements[e][a], grid.mesh.elements[e][b],
            conducted.dot(grid.shape_gradient[e][b]));
      }
    }
  }
  for (const WallNodes<Dim>& wall : energy.walls()) {
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) {
        const double value = wall.conductance * (a == b ? 2.0 : 1.0) / (Dim * (Dim + 1));
        add(wall.near[a], wall.near[b], value);
        add(wall.far[a], wall.far[b], value);
        add(wall.near[a], wall.far[b], -value);
        add(wall.far[a], wall.near[b], -value);
      }
    }
  }
}

/// Gives `add(i, value)` the integral of slopes . K . gradient of each node's shape function.
template <int Dim>
void for_each_load(const SeepageEnergy<Dim>& energy, const Slopes<Dim>& slopes, const auto& add) {
  const Grid<Dim>& grid = energy.grid();
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const Vector<Dim> conducted = grid.volume[e] * energy.conduct(e, slopes.element[e]);
    for (int a = 0; a <= Dim; ++a) {
      add(grid.mesh.elements[e][a], conducted.dot(grid.shape_gradient[e][a]));
    }
  }
  for (std::size_t w = 0; w < energy.walls().size(); ++w) {
    const WallNodes<Dim>& wall = energy.walls()[w];
    for (int a = 0; a < Dim; ++a) {
      std::array<double, Dim> shape{};
      shape[a] = 1.0;
      const double value = wall.conductance * mean_product(slopes.wall[w], shape);
      add(wall.near[a], -value);
      add(wall.far[a], value);
    }
  }
}

/// Conjugate gradients while they gain: the energy x . matrix x / 2 - rhs . x only falls, and the
/// squared gap by twice as much. They use one triangle of the matrix: products with both would take
/// all cores, whatever the threads asked for.
Eigen::VectorXd improved(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                         Eigen::VectorXd x, double squared_gap) {
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower> solver(matrix);
  const auto energy = [&] {
    return 0.5 * x.dot(matrix.selfadjointView<Eigen::Lower>() * x) - rhs.dot(x);
  };
  double last = energy();
  // Each time it starts anew and goes on for longer: many short starts come to nothing where soils
  // conduct a million times more or less.
  for (int iterations = first_iterations; iterations <= most_iterations; iterations *= 2) {
    solver.setMaxIterations(iterations);
    x = solver.solveWithGuess(rhs, x);
    const double gain = 2.0 * (last - energy());
    squared_gap -= gain;
    last -= 0.5 * gain;
    if (!(gain > least_gain * squared_gap)) break;
  }
  return x;
}

}  // namespace

template <int Dim>
std::vector<double> conforming_head(const SeepageEnergy<Dim>& energy,
                                    const std::vector<double>& face_head,
                                    const Slopes<Dim>& of_flux,
                                    const std::vector<std::optional<double>>& prescribed) {
  const Grid<Dim>& grid = energy.grid();
  std::vector<double> head = node_means(energy, face_head, prescribed);
  const Slopes<Dim> gap = sum(energy.of_head(head), -1.0, of_flux);
  const double squared_gap = energy.inner(gap, gap);
  std::vector<int> unknown(head.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < head.size(); ++i) {
    const bool is_used = grid.node_element_begin[i] < grid.node_element_begin[i + 1];
    if (!prescribed[i] && is_used) unknown[i] = count++;
  }
  if (count == 0) return head;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(count);
  for_each_entry<Dim>(energy, [&](int i, int j, double value) {
    if (unknown[i] < 0) return;
    if (unknown[j] > unknown[i]) return;  // one triangle
    if (unknown[j] >= 0) {
      entries.emplace_back(unknown[i], unknown[j], value);
    } else {
      rhs[unknown[i]] -= value * head[j];
    }
  });
  for_each_load(energy, of_flux, [&](int i, double value) {
    if (unknown[i] >= 0) rhs[unknown[i]] += value;
  });
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::VectorXd guess(count);
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (unknown[i] >= 0) guess[unknown[i]] = head[i];
  }
  const Eigen::VectorXd better = improved(matrix, rhs, std::move(guess), squared_gap);
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (unknown[i] >= 0) head[i] = better[unknown[i]];
  }
  return head;
}

template std::vector<double> conforming_head(const SeepageEnergy<2>&, const std::vector<double>&,
                                             const Slopes<2>&,
                                             const std::vector<std::optional<double>>&);
template std::vector<double> conforming_head(const SeepageEnergy<3>&, const std::vector<double>&,
                                             const Slopes<3>&,
                                             const std::vector<std::optional<double>>&);

}  // namespace suffuse
