#include "mesh/water_line.hpp"

#include <algorithm>

#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Error of coordinates relative to the largest one: products with `geometry.scale`, rotations and
/// points that Gmsh places along curves differ from the numbers in the scene by some units in the
/// last digit. Water of this height has a pressure of 1e-6 Pa in a model of 100 m.
constexpr double coordinate_error = 1e-12;

}  // namespace

template <int Dim>
WaterLine<Dim>::WaterLine(const Mesh<Dim>& mesh, const std::array<double, 3>& gravity,
                          double largest_coordinate)
    : mesh_(mesh), gravity_(gravity), round_off_(coordinate_error * largest_coordinate) {}

template <int Dim>
double WaterLine<Dim>::centre_height(const std::array<int, Dim>& face) const {
  Vector<Dim> centre = Vector<Dim>::Zero();
  for (const int node : face) centre += mesh_.nodes[node];
  return height(Vector<Dim>(centre / Dim), gravity_);
}

template <int Dim>
double WaterLine<Dim>::wet_above(const std::array<int, Dim>& face) const {
  const double middle = centre_height(face);
  const bool is_level = std::ranges::all_of(face, [&](int node) {
    return std::abs(height(mesh_.nodes[node], gravity_) - middle) <= round_off_;
  });
  return is_level ? middle - round_off_ : middle;
}

template class WaterLine<2>;
template class WaterLine<3>;

}  // namespace suffuse
