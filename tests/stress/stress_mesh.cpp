#include "stress/stress_mesh.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/model_case.hpp"

namespace suffuse::stress {
namespace {

constexpr int columns = 4;
constexpr int rows = 8;
constexpr double width = 0.5;

std::vector<bool> nodes_outside(const Mesh<2>& mesh) {
  std::vector<bool> outside(mesh.nodes.size(), false);
  for (const auto& set : mesh.boundaries) {
    for (const auto& face : set.faces) {
      for (const int node : face) outside[node] = true;
    }
  }
  return outside;
}

}  // namespace

double Random::decades(double low, double high) {
  return std::exp(between(std::log(low), std::log(high)));
}

Mesh<2> plain_column() {
  return model::column_mesh(columns, rows, width, 1.0);
}

Mesh<2> column_with_levels(const std::function<double(double)>& level) {
  return model::column_mesh(columns, rows, width, 1.0,
                            [&](const Vector<2>& x) { return Vector<2>(x[0], level(x[1])); });
}

void jitter_nodes(Mesh<2>& mesh, double amount, unsigned seed) {
  constexpr double min_left = 0.1;
  Random random(seed);
  const std::vector<bool> outside = nodes_outside(mesh);
  std::vector<double> before;
  std::vector<std::vector<int>> around(mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    before.push_back(element_volume(mesh, e));
    for (const int node : mesh.elements[e]) around[node].push_back(e);
  }
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (outside[i]) continue;
    Vector<2> step(random.between(-amount, amount), random.between(-amount, amount));
    const Vector<2> home = mesh.nodes[i];
    const auto is_flat = [&](int e) { return element_volume(mesh, e) < min_left * before[e]; };
    mesh.nodes[i] = home + step;
    while (std::ranges::any_of(around[i], is_flat) && step.norm() > 1e-6 * amount) {
      step *= 0.5;
      mesh.nodes[i] = home + step;
    }
  }
}

template <int Dim>
int obtuse_elements(const Mesh<Dim>& mesh) {
  int count = 0;
  for (const auto& nodes : mesh.elements) {
    Eigen::Matrix<double, Dim, Dim> edges;
    for (int k = 0; k < Dim; ++k) edges.col(k) = mesh.nodes[nodes[k + 1]] - mesh.nodes[nodes[0]];
    // Columns: gradients of the barycentric coordinates, normal to the sides.
    Eigen::Matrix<double, Dim, Dim + 1> gradients;
    gradients.template rightCols<Dim>() = edges.inverse().transpose();
    gradients.col(0) = -gradients.template rightCols<Dim>().rowwise().sum();
    gradients.colwise().normalize();
    Eigen::Matrix<double, Dim + 1, Dim + 1> cosines = gradients.transpose() * gradients;
    cosines.diagonal().setZero();
    if (cosines.maxCoeff() > 1e-9) ++count;
  }
  return count;
}

template int obtuse_elements(const Mesh<2>& mesh);
template int obtuse_elements(const Mesh<3>& mesh);

Mesh<2> flat_column(double aspect) {
  const double height = width / columns / aspect * rows;
  return model::column_mesh(columns, rows, width, height);
}

Mesh<2> obtuse_column(double degrees) {
  const double cell = width / columns;
  const double row = 1.5 * cell * std::tan(degrees * std::numbers::pi / 180.0);
  return model::column_mesh(columns, rows, width, row * rows, [&](const Vector<2>& x) {
    const auto level = std::lround(x[1] / row);
    return Vector<2>(x[0] + (level % 2 != 0 ? 0.5 * cell : 0.0), x[1]);
  });
}

void place(MaterialPoints<2>& points, Placement placement, unsigned seed) {
  Random random(seed);
  for (auto& at : points.barycentric) {
    const int corner = random.below(3);
    at = {0.0, 0.0, 0.0};
    switch (placement) {
      case Placement::anywhere: {
        const double first = random.share();
        const double second = random.share() * (1.0 - first);
        at = {first, second, 1.0 - first - second};
        break;
      }
      case Placement::on_edges:
        at[corner] = random.share();
        at[(corner + 1) % 3] = 1.0 - at[corner];
        break;
      case Placement::on_nodes:
        at[corner] = 1.0;
        break;
    }
  }
}

void duplicate(MaterialPoints<2>& points) {
  MaterialPoints<2> result;
  for (int p = 0; p < points.size(); ++p) {
    for (int copy = 0; copy < 2; ++copy) {
      result.element.push_back(points.element[p]);
      result.barycentric.push_back(points.barycentric[p]);
      result.volume.push_back(0.5 * points.volume[p]);
    }
  }
  points = std::move(result);
}

void join(MaterialPoints<2>& points) {
  MaterialPoints<2> result;
  for (int p = 0; p < points.size(); ++p) {
    if (result.size() > 0 && result.element.back() == points.element[p]) {
      result.volume.back() += points.volume[p];
      continue;
    }
    result.element.push_back(points.element[p]);
    result.barycentric.push_back(points.barycentric[p]);
    result.volume.push_back(points.volume[p]);
  }
  points = std::move(result);
}

void drop(MaterialPoints<2>& points, int every) {
  MaterialPoints<2> result;
  for (int p = 0; p < points.size(); ++p) {
    if (points.element[p] % every == 0) continue;
    result.element.push_back(points.element[p]);
    result.barycentric.push_back(points.barycentric[p]);
    result.volume.push_back(points.volume[p]);
  }
  points = std::move(result);
}

}  // namespace suffuse::stress
