#pragma once

/// Flow without a scene, for tests of flow schemes.

#include <random>
#include <string>

#include "mixed/implicit_mixed.hpp"
#include "solver/model_case.hpp"

namespace suffuse::model {

/// Random numbers, the same for the same seed.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : random_(seed) {}
  /// A number in [-1, 1).
  double operator()() { return 2.0 * static_cast<double>(random_() >> 11) * 0x1p-53 - 1.0; }

 private:
  std::mt19937_64 random_;
};

/// Flow alone on a mesh: walls by default, soil of 0.02 m/s.
template <int Dim>
struct FlowModelOf {
  explicit FlowModelOf(const Mesh<Dim>& mesh_in) : mesh(mesh_in), grid(mesh) {
    forcing.coefficients = model::flow_coefficients(grid, 0.02);
    forcing.conditions.resize(grid.face_count());
    for (int f = 0; f < grid.face_count(); ++f) {
      if (grid.is_outer(f)) forcing.conditions[f].kind = FaceKind::wall;
    }
  }
  void set(const std::string& boundary, FaceKind kind, double value) {
    for (const auto& set : mesh.boundaries) {
      if (set.name != boundary) continue;
      for (const auto& nodes : set.faces) {
        FaceCondition& c = forcing.conditions[grid.find_face(nodes)];
        c.kind = kind;
        c.value = value;
      }
    }
  }
  template <class OfPlace>
  void set_conductivity(const OfPlace& conductivity) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      forcing.coefficients.drag[e] = darcy_drag(forcing.coefficients.porosity[e], 1000.0,
                                                conductivity(element_centroid(mesh, e)));
    }
  }
  /// The forcing at each stage of a step; it is constant.
  [[nodiscard]] std::vector<const FlowForcing<Dim>*> constant(
      const ImplicitMixed<Dim>& flow) const {
    std::vector<const FlowForcing<Dim>*> result(flow.stages().size(), &forcing);
    return result;
  }
  [[nodiscard]] MixedState<Dim> rest(double pressure = 0.0) const {
    return {std::vector<double>(grid.face_count(), pressure),
            std::vector<Vector<Dim>>(mesh.element_count(), Vector<Dim>::Zero())};
  }
  /// Volume per pressure that an element stores at each of its faces, m3/Pa.
  [[nodiscard]] double capacity(int e, double modulus) const {
    return forcing.coefficients.water_volume[e] / ((Dim + 1) * modulus);
  }

  FlowModelOf(const FlowModelOf&) = delete;
  FlowModelOf& operator=(const FlowModelOf&) = delete;

  Mesh<Dim> mesh;
  Grid<Dim> grid;
  FlowForcing<Dim> forcing;
};
using FlowModel = FlowModelOf<2>;

/// Largest |net outflow of an element - expected one| over the largest flux through a face.
template <int Dim>
double imbalance(const Grid<Dim>& grid, const std::vector<double>& flux,
                 const std::vector<double>& net_outflow) {
  double worst = 0.0;
  double largest = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    double outflow = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      outflow += grid.element_face_sign[e][k] * flux[grid.element_face[e][k]];
    }
    worst = std::max(worst, std::abs(outflow - net_outflow[e]));
  }
  for (const double f : flux) largest = std::max(largest, std::abs(f));
  return worst / largest;
}

}  // namespace suffuse::model
