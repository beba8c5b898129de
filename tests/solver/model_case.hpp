#pragma once

/// Small cases made in memory for tests of the solver: a column of the paper's soil, no files.

#include <functional>
#include <random>
#include <type_traits>

#include "case/case_file.hpp"
#include "grid/grid.hpp"
#include "mixed/flow.hpp"
#include "physics/drag.hpp"
#include "physics/liquid.hpp"
#include "physics/retention/retention_law.hpp"
#include "seeding.hpp"

namespace suffuse::model {

/// The paper's scene (Table 1) with a clean pressure boundary above, without layers.
inline Scene paper_scene() {
  Scene scene;
  scene.name = "model";
  scene.liquid = {1000.0, 2.0e7, 1.0e-3};
  Soil soil;
  soil.region = "specimen";
  soil.porosity = 0.3;
  soil.skeleton_fraction = 0.6;
  soil.grain_density = 2700.0;
  soil.conductivity = 2.0e-2;
  scene.soils = {soil};
  scene.time.end = 120.0;
  scene.time.scheme = FlowScheme::explicit_nodal;
  scene.output.every = 1.0;
  scene.output.snapshot_every = 1.0;
  return scene;
}

inline BoundaryCondition pressure_on(const std::string& name, double pressure) {
  BoundaryCondition b;
  b.on = name;
  b.pressure = pressure;
  return b;
}

inline BoundaryCondition flux_on(const std::string& name, double flux) {
  BoundaryCondition b;
  b.on = name;
  b.darcy_flux = flux;
  b.concentration = 0.0;
  return b;
}

inline BoundaryCondition seepage_on(const std::string& name) {
  BoundaryCondition b;
  b.on = name;
  b.seepage_face = true;
  return b;
}

/// \param alpha 1/m
inline RetentionModel gardner(double alpha, double residual_saturation = 0.1) {
  return {retention_law("gardner"), residual_saturation, {.alpha = alpha}};
}

inline RetentionModel van_genuchten(double alpha, double n, double residual_saturation = 0.1) {
  return {retention_law("van-genuchten"), residual_saturation, {.alpha = alpha, .n = n}};
}

/// [0, width] x [0, height] in nx x ny cells of two right triangles; boundaries top, bottom, left,
/// right; `move` displaces nodes (the identity by default).
inline Mesh<2> column_mesh(
    int nx, int ny, double width = 1.0, double height = 1.0,
    const std::function<Vector<2>(const Vector<2>&)>& move = [](const Vector<2>& x) { return x; }) {
  Mesh<2> mesh;
  const auto node = [&](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) mesh.nodes.push_back(move({width * i / nx, height * j / ny}));
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      mesh.elements.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      mesh.elements.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"specimen"};
  BoundarySet<2> top{"top", {}};
  BoundarySet<2> bottom{"bottom", {}};
  BoundarySet<2> left{"left", {}};
  BoundarySet<2> right{"right", {}};
  for (int i = 0; i < nx; ++i) {
    bottom.faces.push_back({node(i, 0), node(i + 1, 0)});
    top.faces.push_back({node(i, ny), node(i + 1, ny)});
  }
  for (int j = 0; j < ny; ++j) {
    left.faces.push_back({node(0, j), node(0, j + 1)});
    right.faces.push_back({node(nx, j), node(nx, j + 1)});
  }
  mesh.boundaries = {top, bottom, left, right};
  return mesh;
}

/// Displaces inner nodes of the unit square at random by up to `amount`; the same for the same
/// seed.
inline std::function<Vector<2>(const Vector<2>&)> jittered(double amount, unsigned seed) {
  return [amount, random = std::mt19937_64(seed)](const Vector<2>& x) mutable {
    const auto uniform = [&] { return 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0; };
    Vector<2> moved = x;
    if (x[0] > 0.0 && x[0] < 1.0) moved[0] += amount * uniform();
    if (x[1] > 0.0 && x[1] < 1.0) moved[1] += amount * uniform();
    return moved;
  };
}

/// Clean water of 1000 kg/m3 in soil whose porosity depends on the place.
template <int Dim>
FlowCoefficients<Dim> flow_coefficients(
    const Grid<Dim>& grid, double conductivity,
    const std::type_identity_t<std::function<double(const Vector<Dim>&)>>& porosity =
        [](const Vector<Dim>&) { return 0.3; }) {
  FlowCoefficients<Dim> c;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double n = porosity(element_centroid(grid.mesh, e));
    c.porosity.push_back(n);
    c.water_volume.push_back(n * grid.volume[e]);
    c.mixture_density.push_back(1000.0);
    c.drag.push_back(darcy_drag(n, 1000.0, conductivity));
  }
  c.face_concentration.assign(grid.face_count(), 0.0);
  return c;
}

inline Case<2> make_case(Mesh<2> mesh, Scene scene) {
  Case<2> c;
  c.mesh = std::move(mesh);
  c.document.path = "model.toml";
  c.document.scene = std::move(scene);
  const Scene& of = c.document.scene;
  c.solid_points = seed_solid_points(c.mesh, of);
  if (of.formulation == Formulation::double_point) {
    c.liquid_points = seed_liquid_points(c.mesh, of);
  }
  return c;
}

}  // namespace suffuse::model
