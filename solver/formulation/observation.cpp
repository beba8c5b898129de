#include "formulation/observation.hpp"

#include "grid/face_flux.hpp"

namespace suffuse {

template <int Dim>
double mean_porosity(const RigidSkeleton<Dim>& skeleton, const std::vector<double>& porosity) {
  const MaterialPoints<Dim>& points = skeleton.points();
  CompensatedSum pores;
  CompensatedSum volume;
  for (int p = 0; p < points.size(); ++p) {
    const bool erodes = skeleton.erosion_of_element(points.element[p]).law != ErosionLaw::none;
    if (skeleton.erodes() && !erodes) continue;
    pores.add(points.volume[p] * porosity[p]);
    volume.add(points.volume[p]);
  }
  return pores.value() / volume.value();
}

template <int Dim>
void book_solid(const RigidSkeleton<Dim>& skeleton, const Mesh<Dim>& mesh, double grain_density,
                const std::vector<double>& porosity, std::vector<StoredSums>& sums) {
  const MaterialPoints<Dim>& points = skeleton.points();
  for (int p = 0; p < points.size(); ++p) {
    const double mass = grain_density * points.volume[p];
    const double n = porosity[p];
    for (StoredSums* sum : {&sums[0], &sums[mesh.element_region[points.element[p]] + 1]}) {
      sum->solid.add(mass * (1.0 - n));
      sum->erodible.add(mass * (skeleton.soil_of_point(p).porosity_max() - n));
      sum->eroded.add(mass * (n - skeleton.initial_porosity()[p]));
    }
  }
}

template <int Dim>
std::vector<RegionRow> region_rows(const RigidSkeleton<Dim>& skeleton, const Grid<Dim>& grid,
                                   double grain_density, double time,
                                   const std::vector<Stored>& stored,
                                   const std::vector<Stored>& initial,
                                   const std::vector<CrossedSums>& crossed) {
  const MaterialPoints<Dim>& points = skeleton.points();
  std::vector<double> volume(grid.mesh.region_names.size(), 0.0);
  for (int p = 0; p < points.size(); ++p) {
    volume[grid.mesh.element_region[points.element[p]]] += points.volume[p];
  }
  std::vector<RegionRow> rows;
  for (std::size_t r = 0; r < volume.size(); ++r) {
    RegionRow row;
    row.region = static_cast<int>(r);
    const bool soil = volume[r] > 0.0;
    row.porosity_mean = soil ? 1.0 - stored[r + 1].solid / (grain_density * volume[r]) : 1.0;
    row.ledger = ledger_row(time, stored[r + 1], crossed[r + 1].totals(), initial[r + 1]);
    rows.push_back(row);
  }
  return rows;
}

template <int Dim>
Snapshot make_snapshot(const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
                       const std::vector<double>& porosity_of_points, const FinesState<Dim>& liquid,
                       const FlowState<Dim>& moment, long step) {
  using Nodes = FieldNodes<Dim>;
  const int elements = grid.mesh.element_count();
  Snapshot result;
  result.time = moment.time;
  result.step = step;

  Field porosity{"porosity", "1", 1, {}};
  Field concentration{"concentration", "1", 1, {}};
  Field fines{"fines_fraction", "1", 1, {}};
  Field water{"water_fraction", "1", 1, {}};
  Field erodible{"erodible_fraction", "1", 1, {}};
  Field darcy_flux{"darcy_flux", "m/s", Dim, {}};
  Field region{"region", "1", 1, {}};
  Field vertex_porosity{"porosity", "1", Dim + 1, {}};
  Field vertex_concentration{"concentration", "1", Dim + 1, {}};
  Field vertex_fines{"fines_fraction", "1", Dim + 1, {}};
  Field vertex_water{"water_fraction", "1", Dim + 1, {}};

  const VectorField<Dim> element_flux = suffuse::element_flux(grid, moment.face_flux);
  ElementField<Dim> concentration_at_nodes(elements);
  ElementField<Dim> fines_at_nodes(elements);
  for (int e = 0; e < elements; ++e) {
    const ElementValues<Dim>& pores = liquid.pore_volume[e];
    const ElementValues<Dim>& grains = liquid.fines_volume[e];
    const double pore_sum = element_sum<Dim>(pores);
    const double grain_sum = element_sum<Dim>(grains);
    const double n = pore_sum / grid.volume[e];
    const double n_f = grain_sum / grid.volume[e];
    porosity.values.push_back(n);
    concentration.values.push_back(grain_sum / pore_sum);
    fines.values.push_back(n_f);
    water.values.push_back(n - n_f);
    erodible.values.push_back(skeleton.soil_of_element(e).porosity_max() - n);
    region.values.push_back(grid.mesh.element_region[e]);

    const Vector<Dim>& q = element_flux[e];
    darcy_flux.values.insert(darcy_flux.values.end(), q.begin(), q.end());

    const double node_volume = grid.volume[e] / (Dim + 1);
    ElementValues<Dim> n_node;
    for (int j = 0; j <= Dim; ++j) {
      n_node[j] = pores[j] / node_volume;
      fines_at_nodes[e][j] = grains[j] / node_volume;
      concentration_at_nodes[e][j] = grains[j] / pores[j];
    }
    const auto n_vertex = Nodes::at_vertices(n_node);
    const auto f_vertex = Nodes::at_vertices(fines_at_nodes[e]);
    const auto c_vertex = Nodes::at_vertices(concentration_at_nodes[e]);
    for (int k = 0; k <= Dim; ++k) {
      vertex_porosity.values.push_back(n_vertex[k]);
      vertex_fines.values.push_back(f_vertex[k]);
      vertex_water.values.push_back(n_vertex[k] - f_vertex[k]);
      vertex_concentration.values.push_back(c_vertex[k]);
    }
  }
  result.cell = {std::move(porosity),      {"pressure", "Pa", 1, moment.pressure},
                 std::move(concentration), std::move(fines),
                 std::move(water),         std::move(erodible),
                 std::move(darcy_flux),    std::move(region)};
  result.element_vertex = {std::move(vertex_porosity), std::move(vertex_concentration),
                           std::move(vertex_fines), std::move(vertex_water)};

  Field velocity{"liquid_velocity", "m/s", Dim, {}};
  for (const Vector<Dim>& v : moment.velocity) {
    velocity.values.insert(velocity.values.end(), v.begin(), v.end());
  }
  result.node = {std::move(velocity), {"pressure", "Pa", 1, moment.node_pressure}};

  Field point_solid{"solid_fraction", "1", 1, {}};
  Field point_erodible{"erodible_fraction", "1", 1, {}};
  Field point_concentration{"concentration", "1", 1, {}};
  Field point_fines{"fines_fraction", "1", 1, {}};
  Field point_rate{"erosion_rate", "1/s", 1, {}};
  Field point_pressure{"pressure", "Pa", 1, {}};
  const MaterialPoints<Dim>& points = skeleton.points();
  const std::vector<double> point_flux = flux_magnitude_at(grid, moment.face_flux, points, 1.0);
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double n = porosity_of_points[p];
    point_solid.values.push_back(1.0 - n);
    point_erodible.values.push_back(skeleton.soil_of_point(p).porosity_max() - n);
    point_concentration.values.push_back(
        Nodes::value(concentration_at_nodes[e], points.barycentric[p]));
    point_fines.values.push_back(Nodes::value(fines_at_nodes[e], points.barycentric[p]));
    point_rate.values.push_back(
        erosion_rate(skeleton.erosion_of_element(e), n, moment.time, point_flux[p]));
    point_pressure.values.push_back(moment.pressure[e]);
  }
  result.solid = {{"porosity", "1", 1, porosity_of_points},
                  std::move(point_solid),
                  std::move(point_erodible),
                  std::move(point_concentration),
                  std::move(point_fines),
                  std::move(point_rate),
                  std::move(point_pressure)};
  return result;
}

template double mean_porosity(const RigidSkeleton<2>&, const std::vector<double>&);
template void book_solid(const RigidSkeleton<2>&, const Mesh<2>&, double,
                         const std::vector<double>&, std::vector<StoredSums>&);
template std::vector<RegionRow> region_rows(const RigidSkeleton<2>&, const Grid<2>&, double, double,
                                            const std::vector<Stored>&, const std::vector<Stored>&,
                                            const std::vector<CrossedSums>&);
template Snapshot make_snapshot(const Grid<2>&, const RigidSkeleton<2>&, const std::vector<double>&,
                                const FinesState<2>&, const FlowState<2>&, long);

}  // namespace suffuse
