#include "formulation/element_snapshot.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "formulation/seepage_measures.hpp"
#include "grid/face_flux.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

Field scalar(const char* name, const char* unit, int components = 1) {
  return {name, unit, components, {}};
}

std::vector<Field> pore_fields(int components) {
  std::vector<Field> fields;
  for (const char* name : {"porosity", "concentration", "fines_fraction"}) {
    fields.push_back(scalar(name, "1", components));
  }
  return fields;
}

/// Adds the values of one element or vertex to `pore_fields`.
void add_values(std::vector<Field>& fields, double n, double c, double n_f) {
  fields[0].values.push_back(n);
  fields[1].values.push_back(c);
  fields[2].values.push_back(n_f);
}

/// Fines of an element that can erode, over its volume. Points carry those of soil that moves.
template <int Dim>
double erodible_fraction(const Grid<Dim>& grid, const Skeleton<Dim>& solid, int e, double n) {
  const SoilMap<Dim>& soils = solid.soils();
  const Soil& soil = soils.soil_of_element(e);
  const bool is_rigid = !solid.moves() || (soils.is_soil(e) && !soil.skeleton.moves());
  if (is_rigid) return soil.porosity_max() - n;
  const auto begin = solid.state().erodible_volume.begin() + soils.points_begin(e);
  const int count = soils.points_begin(e + 1) - soils.points_begin(e);
  return std::accumulate(begin, begin + count, 0.0) / grid.volume[e];
}

/// Means of elements, and their linear functions at the vertices.
template <int Dim>
void add_pores(const Grid<Dim>& grid, const Skeleton<Dim>& solid, const FinesState<Dim>& liquid,
               const std::vector<double>& porosity, Snapshot& result) {
  using Nodes = FieldNodes<Dim>;
  result.cell = pore_fields(1);
  result.element_vertex = pore_fields(Dim + 1);
  // At vertices it follows from the other fields, so it is left out.
  Field water = scalar("water_fraction", "1");
  Field erodible = scalar("erodible_fraction", "1");
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const ElementValues<Dim>& wet = liquid.liquid_volume[e];
    const ElementValues<Dim>& volume = liquid.fines_volume[e];
    const double wet_sum = element_sum<Dim>(wet);
    const double fines_sum = element_sum<Dim>(volume);
    const double n_wet = wet_sum / grid.volume[e];
    const double n = porosity.empty() ? n_wet : porosity[e];
    add_values(result.cell, n, fines_sum / wet_sum, fines_sum / grid.volume[e]);
    water.values.push_back(n_wet - fines_sum / grid.volume[e]);
    erodible.values.push_back(erodible_fraction(grid, solid, e, n));

    ElementValues<Dim> f_node;
    ElementValues<Dim> c_node;
    for (int j = 0; j <= Dim; ++j) {
      f_node[j] = volume[j] / (grid.volume[e] / (Dim + 1));
      c_node[j] = volume[j] / wet[j];
    }
    const auto n_vertex =
        Nodes::at_vertices(node_porosity(grid, liquid.liquid_volume, porosity, e));
    const auto f_vertex = Nodes::at_vertices(f_node);
    const auto c_vertex = Nodes::at_vertices(c_node);
    for (int k = 0; k <= Dim; ++k) {
      add_values(result.element_vertex, n_vertex[k], c_vertex[k], f_vertex[k]);
    }
  }
  result.cell.push_back(std::move(water));
  result.cell.push_back(std::move(erodible));
}

/// Each value over the sum of all, or 0.
std::vector<double> shares(std::vector<double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  for (double& value : values) value = sum > 0.0 ? value / sum : 0.0;
  return values;
}

template <int Dim>
void add_flow(const Grid<Dim>& grid, const FlowState<Dim>& flow, const Scene& scene,
              Snapshot& result) {
  const auto vectors = [](const char* name, const char* unit, const VectorField<Dim>& from) {
    Field field{name, unit, Dim, {}};
    for (const Vector<Dim>& v : from) field.values.insert(field.values.end(), v.begin(), v.end());
    return field;
  };
  result.cell.insert(result.cell.begin() + 1, {"pressure", "Pa", 1, flow.pressure});
  result.cell.push_back(vectors("darcy_flux", "m/s", element_flux(grid, flow.face_flux)));
  result.cell.push_back(vectors("hydraulic_gradient", "1", hydraulic_gradient(grid, flow, scene)));
  result.node = {vectors("liquid_velocity", "m/s", flow.velocity),
                 {"pressure", "Pa", 1, flow.node_pressure}};
  if (!flow.saturation.empty()) result.cell.push_back({"saturation", "1", 1, flow.saturation});
  if (flow.bounds) {
    result.cell.push_back({"error", "1", 1, shares(flow.bounds->error)});
    result.discharge = discharge_record(*flow.bounds);
  }
  if (!has_gravity(scene.gravity)) return;
  Field head = scalar("head", "m");
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    head.values.push_back(flow.node_pressure[i] / weight +
                          height(grid.mesh.nodes[i], scene.gravity));
  }
  result.node.push_back(std::move(head));
}

template <int Dim>
void add_solid_points(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                      const FinesState<Dim>& liquid, const FlowState<Dim>& flow,
                      const std::vector<double>& acting_concentration, Snapshot& result) {
  using Nodes = FieldNodes<Dim>;
  Field solid_fraction = scalar("solid_fraction", "1");
  Field erodible = scalar("erodible_fraction", "1");
  Field concentration = scalar("concentration", "1");
  Field fines = scalar("fines_fraction", "1");
  Field rate = scalar("erosion_rate", "1/s");
  Field pressure = scalar("pressure", "Pa");
  const MaterialPoints<Dim>& points = solid.soils().points();
  PointFlows flows =
      point_flows(grid, solid.soils(), flow.face_flux, std::numeric_limits<double>::infinity(), 1);
  solid.find_eroding_flux(flows);
  if (solid.soils().exchange_depends_on().surroundings) {
    result.cell.push_back(
        {"eroding_flux", "m/s", 1, element_means(solid.soils(), flows.eroding_flux)});
  }
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double n = solid.porosity()[p];
    ElementValues<Dim> c_node;
    ElementValues<Dim> f_node;
    for (int j = 0; j <= Dim; ++j) {
      c_node[j] = liquid.concentration(e, j);
      f_node[j] = liquid.fines_volume[e][j] / (grid.volume[e] / (Dim + 1));
    }
    solid_fraction.values.push_back(1.0 - n);
    erodible.values.push_back(solid.state().erodible_volume[p] / points.volume[p]);
    const double c = Nodes::value(c_node, points.barycentric[p]);
    concentration.values.push_back(c);
    fines.values.push_back(Nodes::value(f_node, points.barycentric[p]));
    const double acting = acting_concentration.empty() ? c : acting_concentration[e];
    rate.values.push_back(solid.exchange_rate_at(p, n, acting, flow.time, flows).eroded);
    pressure.values.push_back(flow.pressure[e]);
  }
  result.solid = {{"porosity", "1", 1, solid.porosity()},
                  std::move(solid_fraction),
                  std::move(erodible),
                  std::move(concentration),
                  std::move(fines),
                  std::move(rate),
                  std::move(pressure)};
}

/// Gives rank 0 the values of the whole model, and the other ranks none.
template <int Dim>
void gather(const Grid<Dim>& grid, const SoilMap<Dim>& soils, Snapshot& snapshot) {
  const Ranks& ranks = grid.ranks();
  if (ranks.count() == 1) return;
  const auto gather_own = [&](std::vector<Field>& fields, const NumberRange& own) {
    for (Field& field : fields) {
      const std::ptrdiff_t size = field.components;
      const auto begin = field.values.begin();
      field.values =
          gather_values(ranks, std::vector(begin + size * *own.begin(), begin + size * *own.end()));
    }
  };
  gather_own(snapshot.cell, grid.own_elements());
  gather_own(snapshot.element_vertex, grid.own_elements());
  gather_own(snapshot.node, grid.node_rows().own());
  gather_own(snapshot.solid, soils.points_of(grid.own_elements()));
}

}  // namespace

std::optional<DischargeRecord> discharge_record(const DischargeBounds& bounds) {
  if (!bounds.least_known) return std::nullopt;
  return DischargeRecord{bounds.least_known->low, bounds.least_known->high, bounds.largest_flux,
                         bounds.why_estimates};
}

template <int Dim>
Snapshot element_snapshot(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                          const FinesState<Dim>& liquid, const FlowState<Dim>& flow,
                          const Scene& scene, long step,
                          const std::vector<double>& acting_concentration,
                          std::vector<Field> of_elements) {
  Snapshot result;
  result.time = flow.time;
  result.step = step;
  add_pores(grid, solid, liquid, flow.porosity, result);
  add_flow(grid, flow, scene, result);
  add_solid_points(grid, solid, liquid, flow, acting_concentration, result);
  solid.describe(result);
  for (Field& field : of_elements) result.cell.push_back(std::move(field));
  gather(grid, solid.soils(), result);
  return result;
}

template Snapshot element_snapshot(const Grid<2>&, const Skeleton<2>&, const FinesState<2>&,
                                   const FlowState<2>&, const Scene&, long,
                                   const std::vector<double>&, std::vector<Field>);
template Snapshot element_snapshot(const Grid<3>&, const Skeleton<3>&, const FinesState<3>&,
                                   const FlowState<3>&, const Scene&, long,
                                   const std::vector<double>&, std::vector<Field>);

}  // namespace suffuse
