#include "coupling/construction_stage.hpp"

#include <algorithm>

#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Points of one run in the order of those of the next.
template <int Dim>
struct ChosenPoint {
  const MovedSoil<Dim>* from;
  int point;
};

template <class Value>
void add_value(const std::vector<Value>& from, int point, std::vector<Value>& to) {
  to.push_back(from[point]);
}

/// Adds all data of a point.
template <int Dim>
void add_point(const ChosenPoint<Dim>& chosen, MovedSoil<Dim>& to) {
  const MovedSoil<Dim>* from = chosen.from;
  const int p = chosen.point;
  const auto add_each = [&](auto member) { add_value(from->*member, p, to.*member); };
  const auto add_solid = [&](auto member) { add_value(from->state.*member, p, to.state.*member); };
  const auto add_place = [&](auto member) {
    add_value(from->points.*member, p, to.points.*member);
  };
  add_each(&MovedSoil<Dim>::region);
  add_each(&MovedSoil<Dim>::skeleton);
  add_each(&MovedSoil<Dim>::initial_porosity);
  add_each(&MovedSoil<Dim>::initial_erodible);
  add_solid(&SolidState::skeleton_volume);
  add_solid(&SolidState::erodible_volume);
  const std::vector<double>& deposited = from->state.deposited_volume;
  to.state.deposited_volume.push_back(deposited.empty() ? 0.0 : deposited[p]);
  add_place(&SolidPoints<Dim>::position);
  add_place(&SolidPoints<Dim>::element);
  add_place(&SolidPoints<Dim>::reference_volume);
  add_place(&SolidPoints<Dim>::volume);
  add_place(&SolidPoints<Dim>::skeleton);
  add_place(&SolidPoints<Dim>::plastic_strain);
}

/// Volume of solid of the points in each element, m3.
template <int Dim>
std::vector<double> solid_of_points(const MovedSoil<Dim>& soil, std::size_t elements) {
  std::vector<double> result(elements, 0.0);
  for (int p = 0; p < soil.points.size(); ++p) {
    result[soil.points.element[p]] += soil.state.solid_volume(p);
  }
  return result;
}

/// The elastic strains of the points with which they keep their stresses under the laws of `scene`.
template <int Dim>
void keep_stresses(const Scene& scene, const Mesh<Dim>& mesh, MovedSoil<Dim>& soil) {
  for (int p = 0; p < soil.points.size(); ++p) {
    const Soil* given = scene.find_soil(mesh.region_names[soil.region[p]]);
    const auto& [law, then] = soil.skeleton[p];
    if (!law || !given || !given->skeleton.moves()) continue;
    const double erodible = soil.initial_erodible[p];
    const double left = erodible > 0.0 ? soil.state.erodible_volume[p] / erodible : 1.0;
    const SkeletonParameters now = given->skeleton.at(left);
    if (now.young == then.young && now.poisson == then.poisson) continue;
    SkeletonState& state = soil.points.skeleton[p];
    const auto response =
        skeleton_response<Dim>(*law, then, state, Eigen::Matrix<double, Dim, Dim>::Identity());
    state.elastic_b = elastic_b_under(now, response.stress);
  }
}

}  // namespace

template <int Dim>
NextStage<Dim> next_stage(const Scene& scene, const Mesh<Dim>& mesh, const MovedSoil<Dim>& fresh,
                          const MovedSoil<Dim>& earlier) {
  NextStage<Dim> stage;
  if (fresh.has_soil == earlier.has_soil) {
    stage.soil = earlier;
    keep_stresses(scene, mesh, stage.soil);
    return stage;
  }
  const auto changes = [&](int region) {
    return fresh.has_soil[region] != earlier.has_soil[region];
  };
  std::vector<char> loses(mesh.element_count(), 0);
  std::vector<ChosenPoint<Dim>> chosen;
  for (int p = 0; p < earlier.points.size(); ++p) {
    const int e = earlier.points.element[p];
    const bool stays = !changes(mesh.element_region[e]) && fresh.has_soil[earlier.region[p]] != 0;
    if (stays) chosen.push_back({&earlier, p});
    if (!stays) loses[e] = 1;
  }
  for (int p = 0; p < fresh.points.size(); ++p) {
    if (changes(mesh.element_region[fresh.points.element[p]])) chosen.push_back({&fresh, p});
  }
  std::ranges::stable_sort(
      chosen, {}, [](const ChosenPoint<Dim>& c) { return c.from->points.element[c.point]; });
  for (const ChosenPoint<Dim>& point : chosen) add_point(point, stage.soil);
  keep_stresses(scene, mesh, stage.soil);
  const std::vector<double> left = solid_of_points(stage.soil, loses.size());
  stage.soil.has_soil = fresh.has_soil;
  stage.soil.pressure = earlier.pressure;
  stage.soil.element_solid = earlier.element_solid;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    if (!changes(region) && loses[e] == 0) continue;
    stage.changed.push_back(e);
    const bool is_filled = changes(region) && fresh.has_soil[region] != 0;
    stage.soil.element_solid[e] = is_filled ? fresh.element_solid[e] : left[e];
  }
  stage.soil.surfaces = earlier.surfaces;
  return stage;
}

template <int Dim>
void fill_pores(const Grid<Dim>& grid, const FlowSoils<Dim>& soils, const LiquidProperties& liquid,
                const std::vector<double>& porosity, const EarlierFlow<Dim>& earlier,
                const std::vector<int>& elements, PoreContent<Dim> content) {
  const std::vector<double> face_pressure = earlier.face_pressure(grid);
  for (const int e : elements) {
    const double share = porosity[e] * grid.volume[e] / (Dim + 1);
    ElementValues<Dim>& room = content.liquid[e];
    room.fill(share);
    for (int k = 0; k <= Dim && !soils.saturated(); ++k) {
      const double pressure = face_pressure[grid.element_face[e][k]];
      content.air[e][k] = share * (1.0 - soils.at(e, pressure).saturation);
      room[k] -= content.air[e][k];
    }
    content.fines[e].fill(0.0);
    content.water_mass[e] = liquid.density * element_sum<Dim>(room) *
                            density_ratio(earlier.state.pressure[e], liquid.bulk_modulus);
  }
}

template NextStage<2> next_stage(const Scene&, const Mesh<2>&, const MovedSoil<2>&,
                                 const MovedSoil<2>&);
template NextStage<3> next_stage(const Scene&, const Mesh<3>&, const MovedSoil<3>&,
                                 const MovedSoil<3>&);

template void fill_pores(const Grid<2>&, const FlowSoils<2>&, const LiquidProperties&,
                         const std::vector<double>&, const EarlierFlow<2>&, const std::vector<int>&,
                         PoreContent<2>);
template void fill_pores(const Grid<3>&, const FlowSoils<3>&, const LiquidProperties&,
                         const std::vector<double>&, const EarlierFlow<3>&, const std::vector<int>&,
                         PoreContent<3>);

}  // namespace suffuse
