#include "bounds/seepage_fields.hpp"

#include "grid/face_flux.hpp"

namespace suffuse {
namespace {

template <int Dim>
WallNodes<Dim> wall_nodes(const Grid<Dim>& grid, const LeakyFace& wall, double pressure_per_head) {
  const auto& x = grid.mesh.nodes;
  WallNodes<Dim> result{wall.face,
                        wall.partner,
                        grid.face_nodes[wall.face],
                        {},
                        wall.conductance * pressure_per_head};
  for (int i = 0; i < Dim; ++i) {
    const auto distance = [&](int node) { return (x[node] - x[result.near[i]]).squaredNorm(); };
    const auto& others = grid.face_nodes[wall.partner];
    result.far[i] = *std::ranges::min_element(others, {}, distance);
  }
  return result;
}

}  // namespace

template <int Dim>
SeepageEnergy<Dim>::SeepageEnergy(const Grid<Dim>& grid, std::vector<double> conductivity,
                                  std::vector<DirectionalFactor<Dim>> bedding,
                                  const std::vector<LeakyFace>& walls, double pressure_per_head)
    : grid_(grid), conductivity_(std::move(conductivity)), bedding_(std::move(bedding)) {
  for (const LeakyFace& wall : walls) walls_.push_back(wall_nodes(grid, wall, pressure_per_head));
}

template <int Dim>
Slopes<Dim> SeepageEnergy<Dim>::of_head(const std::vector<double>& node_head) const {
  Slopes<Dim> result;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const auto& nodes = grid_.mesh.elements[e];
    Vector<Dim> gradient = Vector<Dim>::Zero();
    for (int k = 1; k <= Dim; ++k) {
      gradient += (node_head[nodes[k]] - node_head[nodes[0]]) * grid_.shape_gradient[e][k];
    }
    result.element.push_back(gradient);
  }
  for (const WallNodes<Dim>& wall : walls_) {
    auto& jump = result.wall.emplace_back();
    for (int i = 0; i < Dim; ++i) jump[i] = node_head[wall.far[i]] - node_head[wall.near[i]];
  }
  return result;
}

template <int Dim>
Slopes<Dim> SeepageEnergy<Dim>::of_flux(const std::vector<double>& face_flux) const {
  Slopes<Dim> result{element_flux(grid_, face_flux), {}};
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    result.element[e] = -resist(e, result.element[e]);
  }
  for (const WallNodes<Dim>& wall : walls_) {
    result.wall.emplace_back().fill(-face_flux[wall.face] / wall.conductance);
  }
  return result;
}

template <int Dim>
std::vector<double> SeepageEnergy<Dim>::per_element(const Slopes<Dim>& a,
                                                    const Slopes<Dim>& b) const {
  std::vector<double> result;
  result.reserve(grid_.volume.size());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    result.push_back(grid_.volume[e] * a.element[e].dot(conduct(e, b.element[e])));
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const double whole = walls_[w].conductance * mean_product(a.wall[w], b.wall[w]);
    result[grid_.face_left[walls_[w].face]] += 0.5 * whole;
    result[grid_.face_left[walls_[w].partner]] += 0.5 * whole;
  }
  return result;
}

template <int Dim>
double SeepageEnergy<Dim>::inner(const Slopes<Dim>& a, const Slopes<Dim>& b) const {
  ExactSum total;
  for (const double of_element : per_element(a, b)) total.add(of_element);
  return total.value();
}

template <int Dim>
std::vector<Vector<Dim>> face_slopes(const Grid<Dim>& grid, const std::vector<double>& at_faces) {
  std::vector<Vector<Dim>> result(grid.volume.size(), Vector<Dim>::Zero());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const auto& faces = grid.element_face[e];
    for (int k = 1; k <= Dim; ++k) {
      result[e] +=
          (at_faces[faces[k]] - at_faces[faces[0]]) * grid.outward_normal(e, k) / grid.volume[e];
    }
  }
  return result;
}

template <int Dim>
Slopes<Dim> sum(const Slopes<Dim>& a, double factor, const Slopes<Dim>& b) {
  Slopes<Dim> result = a;
  for (std::size_t e = 0; e < a.element.size(); ++e) result.element[e] += factor * b.element[e];
  for (std::size_t w = 0; w < a.wall.size(); ++w) {
    for (int i = 0; i < Dim; ++i) result.wall[w][i] += factor * b.wall[w][i];
  }
  return result;
}

template class SeepageEnergy<2>;
template class SeepageEnergy<3>;
template std::vector<Vector<2>> face_slopes(const Grid<2>&, const std::vector<double>&);
template std::vector<Vector<3>> face_slopes(const Grid<3>&, const std::vector<double>&);
template Slopes<2> sum(const Slopes<2>&, double, const Slopes<2>&);
template Slopes<3> sum(const Slopes<3>&, double, const Slopes<3>&);

}  // namespace suffuse
