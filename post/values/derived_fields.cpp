#include "values/derived_fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "common/errors.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Saturation below 1 by no more than this is round-off.
constexpr double saturated = 1.0 - 1e-9;

bool is_stored(const ResultsReader& results, std::size_t index, const std::string& where,
               const std::string& name) {
  const auto names = results.field_names(index, where);
  return std::ranges::find(names, name) != names.end();
}

template <int Dim>
double head_of(const Scene& scene, double pressure, const Vector<Dim>& x) {
  return pressure / unit_weight(scene.liquid.density, scene.gravity) + height(x, scene.gravity);
}

std::vector<double> cell_head(const ResultsReader& results, std::size_t index) {
  std::vector<double> values = results.field(index, "cell", "pressure").values;
  with_mesh(results, [&](const auto& mesh) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      values[e] = head_of(results.scene().scene, values[e], element_centroid(mesh, e));
    }
  });
  return values;
}

std::vector<double> node_head(const ResultsReader& results, std::size_t index) {
  std::vector<double> values = results.field(index, "node", "pressure").values;
  with_mesh(results, [&](const auto& mesh) {
    for (int i = 0; i < mesh.node_count(); ++i) {
      values[i] = head_of(results.scene().scene, values[i], mesh.nodes[i]);
    }
  });
  return values;
}

std::vector<double> full_saturation(const ResultsReader& results, std::size_t index) {
  std::vector<double> values = results.field(index, "cell", "porosity").values;
  std::ranges::fill(values, 1.0);
  return values;
}

std::vector<double> conductivity(const ResultsReader& results, std::size_t index) {
  const std::vector<double> porosity = results.field(index, "cell", "porosity").values;
  std::vector<double> values(porosity.size(), std::numeric_limits<double>::quiet_NaN());
  with_mesh(results, [&](const auto& mesh) {
    for (const Soil& soil : results.scene().scene.soils) {
      const ConductivityModel model = soil.conductivity_model();
      const std::vector<double> factor = conductivity_factor(results, soil);
      for (int e = 0; e < mesh.element_count(); ++e) {
        if (mesh.region_names[mesh.element_region[e]] != soil.region) continue;
        const double initial = soil.initial_porosity(element_centroid(mesh, e));
        values[e] = factor[e] * model.at(initial, porosity[e]);
      }
    }
  });
  return values;
}

std::vector<double> fines_content(const ResultsReader& results, std::size_t index,
                                  const std::string& where) {
  std::vector<double> values = results.field(index, where, "erodible_fraction").values;
  const std::vector<double> porosity = results.field(index, where, "porosity").values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double solid = 1.0 - porosity[i];
    values[i] = solid > 0.0 ? values[i] / solid : 0.0;
  }
  return values;
}

/// Erodible fractions of rigid soil with the porosity of the scene, which all stages have in
/// common; not a number in cells without soil. Solid points are sorted by element.
template <int Dim>
std::vector<double> erodible_by_scene(const ResultsReader& results, const Mesh<Dim>& mesh,
                                      const std::string& where) {
  const Scene& scene = results.scene().scene;
  const bool of_points = where == "solid";
  const std::vector<Vector<Dim>> points =
      of_points ? results.point_positions<Dim>(0, where) : std::vector<Vector<Dim>>{};
  std::vector<double> values;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Soil* soil = scene.find_soil(mesh.region_names[mesh.element_region[e]]);
    const auto add = [&](const Vector<Dim>& x) {
      values.push_back(soil == nullptr ? unset : soil->porosity_max() - soil->initial_porosity(x));
    };
    if (!of_points) {
      add(element_centroid(mesh, e));
    } else if (soil != nullptr) {
      const std::size_t end = values.size() + scene.points.solid_per_element;
      while (values.size() < std::min(end, points.size())) add(points[values.size()]);
    }
  }
  if (of_points && values.size() != points.size()) {
    throw FileError(results.folder() + ": has other solid points than its scene says");
  }
  return values;
}

std::vector<double> fines_left(const ResultsReader& results, std::size_t index,
                               const std::string& where) {
  std::vector<double> values = results.field(index, where, "erodible_fraction").values;
  const std::vector<double> start = results.scene().scene.initial_from.empty()
                                        ? results.field(0, where, "erodible_fraction").values
                                        : with_mesh(results, [&](const auto& mesh) {
                                            return erodible_by_scene(results, mesh, where);
                                          });
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = start[i] > 0.0 ? values[i] / start[i] : std::numeric_limits<double>::quiet_NaN();
  }
  return values;
}

/// Volume fraction of water at the vertices of elements, n S - n_f.
std::vector<double> water_at_vertices(const ResultsReader& results, std::size_t index) {
  std::vector<double> values = results.field(index, "element_vertex", "porosity").values;
  const std::vector<double> fines = results.field(index, "element_vertex", "fines_fraction").values;
  const std::vector<double> saturation = any_field(results, index, "cell", "saturation").values;
  const auto corners = static_cast<std::size_t>(results.dimension()) + 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = values[i] * saturation[i / corners] - fines[i];
  }
  return values;
}

std::vector<double> safety(const ResultsReader& results, std::size_t index) {
  std::vector<double> values = critical_gradient(results, index);
  const std::vector<double> gradient = upward_gradient(results, index);
  for (std::size_t e = 0; e < values.size(); ++e) {
    values[e] =
        gradient[e] > 0.0 ? values[e] / gradient[e] : std::numeric_limits<double>::infinity();
  }
  return values;
}

/// A field that follows from stored ones, if `needs` is stored.
struct DerivedField {
  std::string where;
  std::string name;
  std::string unit;
  std::string needs;
  std::function<std::vector<double>(const ResultsReader&, std::size_t)> values;
  bool is_of_rigid_soil = false;

  [[nodiscard]] bool is_on(const std::string& place, const ResultsReader& results) const {
    return where == place && !(is_of_rigid_soil && results.scene().scene.moves());
  }
};

const std::vector<DerivedField>& derived_fields() {
  static const std::vector<DerivedField> fields{
      {"cell", "head", "m", "pressure", cell_head},
      {"node", "head", "m", "pressure", node_head},
      {"cell", "conductivity", "m/s", "porosity", conductivity},
      {"cell", "saturation", "1", "porosity", full_saturation},
      {"cell", "fines_content", "1", "erodible_fraction",
       [](const auto& results, auto index) { return fines_content(results, index, "cell"); }},
      {"solid", "fines_content", "1", "erodible_fraction",
       [](const auto& results, auto index) { return fines_content(results, index, "solid"); }},
      {"cell", "fines_left", "1", "erodible_fraction",
       [](const auto& results, auto index) { return fines_left(results, index, "cell"); }, true},
      {"solid", "fines_left", "1", "erodible_fraction",
       [](const auto& results, auto index) { return fines_left(results, index, "solid"); }, true},
      {"element_vertex", "water_fraction", "1", "fines_fraction", water_at_vertices},
      {"cell", "safety", "1", "hydraulic_gradient", safety}};
  return fields;
}

}  // namespace

std::vector<std::string> all_field_names(const ResultsReader& results, std::size_t index,
                                         const std::string& where) {
  std::vector<std::string> names = results.field_names(index, where);
  const std::vector<std::string> stored = names;
  const auto has = [&](const std::string& name) {
    return std::ranges::find(stored, name) != stored.end();
  };
  for (const DerivedField& field : derived_fields()) {
    if (!field.is_on(where, results) || !has(field.needs) || has(field.name)) continue;
    names.push_back(field.name);
  }
  return names;
}

Field any_field(const ResultsReader& results, std::size_t index, const std::string& where,
                const std::string& name) {
  if (!is_stored(results, index, where, name)) {
    for (const DerivedField& field : derived_fields()) {
      if (field.is_on(where, results) && field.name == name) {
        const int components = where == "element_vertex" ? results.dimension() + 1 : 1;
        return {name, field.unit, components, field.values(results, index)};
      }
    }
  }
  return results.field(index, where, name);
}

std::vector<double> critical_gradient(const ResultsReader& results, std::size_t index) {
  const Scene& scene = results.scene().scene;
  std::vector<double> values = results.field(index, "cell", "porosity").values;
  with_mesh(results, [&](const auto& mesh) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      const Soil* soil = scene.find_soil(mesh.region_names[mesh.element_region[e]]);
      values[e] = soil == nullptr
                      ? std::numeric_limits<double>::quiet_NaN()
                      : (1.0 - values[e]) * (soil->grain_density / scene.liquid.density - 1.0);
    }
  });
  return values;
}

std::vector<double> conductivity_factor(const ResultsReader& results, const Soil& soil) {
  return with_mesh(results, [&](const auto& mesh) {
    std::vector<double> factor(mesh.elements.size(), 1.0);
    if (!soil.field.varies()) return factor;
    const LognormalField field(soil.field, soil.bedding);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.region_names[mesh.element_region[e]] != soil.region) continue;
      factor[e] = field.at(element_centroid(mesh, e));
    }
    return factor;
  });
}

std::vector<double> upward_gradient(const ResultsReader& results, std::size_t index) {
  const auto width = static_cast<std::size_t>(results.dimension());
  const Scene& scene = results.scene().scene;
  std::vector<double> up(width);
  if (width == 3) {
    Vector<3>::Map(up.data()) = upward<3>(scene);
  } else {
    Vector<2>::Map(up.data()) = upward<2>(scene);
  }
  const std::vector<double> gradient = results.field(index, "cell", "hydraulic_gradient").values;
  const std::vector<double> saturation = any_field(results, index, "cell", "saturation").values;
  std::vector<double> values;
  for (std::size_t e = 0; e < saturation.size(); ++e) {
    double component = 0.0;
    for (std::size_t d = 0; d < width; ++d) component += gradient[width * e + d] * up[d];
    values.push_back(saturation[e] < saturated ? 0.0 : component);
  }
  return values;
}

template <int Dim>
Vector<Dim> upward(const Scene& scene) {
  if (!has_gravity(scene.gravity)) return Vector<Dim>::Unit(Dim - 1);
  Vector<Dim> up;
  for (int d = 0; d < Dim; ++d) up[d] = height(Vector<Dim>::Unit(d).eval(), scene.gravity);
  return up;
}
template Vector<2> upward(const Scene& scene);
template Vector<3> upward(const Scene& scene);

}  // namespace suffuse
