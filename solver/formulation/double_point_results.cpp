/// Results of a double-point model.

#include <algorithm>
#include <cmath>
#include <limits>

#include "formulation/double_point.hpp"
#include "formulation/element_snapshot.hpp"
#include "grid/face_flux.hpp"
#include "points/concentration_fit.hpp"

namespace suffuse {
namespace {

/// Codes of the field `saturation_state`.
enum class Saturation { dry_soil, saturated_soil, free_liquid, empty };

/// Flux of fines out of the outer boundary, m3/s, for the values `concentration` at field nodes.
template <int Dim>
double fines_outflow(const Grid<Dim>& grid, const std::vector<double>& face_flux,
                     const ElementField<Dim>& concentration) {
  ExactSum result;
  for (const int f : grid.own_faces()) {
    const double flux = face_flux[f];
    if (!grid.is_outer(f) || flux <= 0.0) continue;
    const int e = grid.face_left[f];
    const ElementValues<Dim> at_vertices = FieldNodes<Dim>::at_vertices(concentration[e]);
    for (int a = 0; a <= Dim; ++a) {
      if (grid.element_face[e][a] != f) result.add(flux * at_vertices[a] / Dim);
    }
  }
  grid.ranks().sum({&result});
  return result.value();
}

/// Writes the largest relative difference between the volume of an element's points and its pores,
/// and its place.
template <int Dim>
void describe_volume_defect(const Grid<Dim>& grid, const LiquidPoints<Dim>& points,
                            const std::vector<double>& volume, const std::vector<double>& porosity,
                            HistoryRow& row) {
  std::vector<double> filled(grid.mesh.elements.size(), 0.0);
  for (int p = 0; p < points.size(); ++p) filled[points.element[p]] += volume[p];
  int worst = -1;
  double largest = 0.0;
  for (const int e : grid.own_elements()) {
    const double defect = std::abs(filled[e] / (porosity[e] * grid.volume[e]) - 1.0);
    if (!(defect > largest)) continue;
    largest = defect;
    worst = e;
  }
  const auto [defect, at] = largest_of_all(grid, largest, worst);
  row.volume_defect = defect;
  row.volume_defect_at = at;
}

}  // namespace

template <int Dim>
HistoryRow DoublePoint<Dim>::history_row(const FlowState<Dim>& flow) const {
  HistoryRow row = this->common_history(flow);
  const LiquidPoints<Dim>& points = liquid_->points();
  row.liquid_points = static_cast<double>(liquid_->size());
  row.empty_elements = liquid_->empty_elements();
  row.empty_elements_total = liquid_->empty_elements_total();

  const std::vector<double> volume = liquid_->point_volume(points, flow.pressure);
  const std::vector<double> concentration = concentrations(points, volume);
  if (liquid_->size() > 0) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    int at = -1;
    for (int p = 0; p < points.size(); ++p) {
      least = std::min(least, concentration[p]);
      if (!(concentration[p] > most)) continue;
      most = concentration[p];
      at = points.element[p];
    }
    row.concentration_min = smallest_of_all(this->grid_.ranks(), least);
    const auto [highest, place] = largest_of_all(this->grid_, most, at);
    row.concentration_max = highest;
    row.concentration_max_at = place;
  }
  this->describe_outflow(fines_outflow(this->grid_, flow.face_flux, fitted(flow)), row);
  describe_volume_defect(this->grid_, points, volume, this->solid_->element_porosity(), row);
  liquid_->describe(flow, row);
  return row;
}

template <int Dim>
ElementField<Dim> DoublePoint<Dim>::fitted(const FlowState<Dim>& flow) const {
  const bool is_alone = this->grid_.ranks().count() == 1;
  const LiquidPoints<Dim> around = is_alone ? LiquidPoints<Dim>() : liquid_->points_around();
  const LiquidPoints<Dim>& points = is_alone ? liquid_->points() : around;
  const std::vector<double> volume = liquid_->point_volume(points, flow.pressure);
  ElementField<Dim> result = concentration_fit(
      this->grid_, points, element_begins(points, this->grid_.mesh.element_count()), volume,
      concentrations(points, volume));
  this->grid_.element_rows().exchange(result);
  return result;
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::concentrations(const LiquidPoints<Dim>& points,
                                                     const std::vector<double>& volume) const {
  std::vector<double> result(points.size());
  for (int p = 0; p < points.size(); ++p) {
    result[p] = points.fines_mass[p] / (densities_.grain * volume[p]);
  }
  return result;
}

template <int Dim>
std::vector<Stored> DoublePoint<Dim>::stored() const {
  std::vector<StoredSums> sums = this->solid_masses();
  const LiquidPoints<Dim>& points = liquid_->points();
  for (int p = 0; p < points.size(); ++p) {
    const int region = this->grid_.mesh.element_region[points.element[p]];
    sums[region + 1].water.add(points.water_mass[p]);
    sums[region + 1].fines.add(points.fines_mass[p]);
    sums[region + 1].points.add(1.0);
  }
  for (const int i : this->grid_.node_rows().own()) {
    sums[0].pending.add(densities_.grain * liquid_->pending()[i]);
  }
  return totals(this->grid_.ranks(), std::move(sums));
}

template <int Dim>
FinesState<Dim> DoublePoint<Dim>::fines_state(const FlowState<Dim>& flow) const {
  FinesState<Dim> result{pore_field(this->grid_, *this->solid_), fitted(flow)};
  for (std::size_t e = 0; e < result.fines_volume.size(); ++e) {
    for (int j = 0; j <= Dim; ++j) result.fines_volume[e][j] *= result.liquid_volume[e][j];
  }
  return result;
}

template <int Dim>
Snapshot DoublePoint<Dim>::snapshot(const FlowState<Dim>& flow) const {
  const Grid<Dim>& grid = this->grid_;
  const LiquidPoints<Dim>& points = liquid_->points();
  const std::vector<int> begins = element_begins(points, grid.mesh.element_count());
  std::vector<double> volume = liquid_->point_volume(points, flow.pressure);
  std::vector<double> concentration = concentrations(points, volume);

  Field saturation{"saturation_state", "1", 1, {}, true};
  Field count{"liquid_points", "1", 1, {}, true};
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const bool filled = begins[e + 1] > begins[e];
    const Saturation s = this->soils_.is_soil(e)
                             ? (filled ? Saturation::saturated_soil : Saturation::dry_soil)
                             : (filled ? Saturation::free_liquid : Saturation::empty);
    saturation.values.push_back(static_cast<double>(s));
    count.values.push_back(begins[e + 1] - begins[e]);
  }
  Snapshot result =
      element_snapshot(grid, *this->solid_, fines_state(flow), flow, this->scene(), this->steps(),
                       liquid_->element_concentration(), {std::move(saturation), std::move(count)});

  const std::vector<double> porosity = this->solid_->element_porosity();
  Field velocity{"liquid_velocity", "m/s", Dim, {}};
  velocity.values.reserve(static_cast<std::size_t>(Dim) * points.element.size());
  result.liquid_positions.reserve(3 * points.element.size());
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const Vector<Dim> x = points.place(p).position(grid.mesh);
    for (int d = 0; d < 3; ++d) result.liquid_positions.push_back(d < Dim ? x[d] : 0.0);
    const Vector<Dim> flux = flux_at(grid, flow.face_flux, e, x);
    for (int d = 0; d < Dim; ++d) velocity.values.push_back(flux[d] / porosity[e]);
  }

  result.liquid.reserve(8);
  // Values are moved, because copies of many points would take much memory.
  const Ranks& ranks = grid.ranks();
  const auto of_all = [&](std::vector<double> values) {
    return ranks.count() == 1 ? std::move(values) : gather_values(ranks, values);
  };
  const auto add = [&](const char* name, const char* unit, std::vector<double> values) {
    result.liquid.push_back({name, unit, 1, of_all(std::move(values))});
  };
  velocity.values = of_all(std::move(velocity.values));
  result.liquid_positions = of_all(std::move(result.liquid_positions));
  add("concentration", "1", std::move(concentration));
  add("pressure", "Pa", liquid_->point_pressure(points, flow));
  result.liquid.push_back(std::move(velocity));
  add("volume", Dim == 2 ? "m3/m" : "m3", std::move(volume));
  add("water_mass", Dim == 2 ? "kg/m" : "kg", points.water_mass);
  add("fines_mass", Dim == 2 ? "kg/m" : "kg", points.fines_mass);
  std::vector<double> elements;
  elements.reserve(points.element.size());
  for (const int e : points.element)
    elements.push_back(static_cast<double>(grid.element_number(e)));
  add("element", "1", std::move(elements));
  result.liquid.back().is_whole = true;
  add("id", "1", {points.id.begin(), points.id.end()});
  result.liquid.back().is_whole = true;
  return result;
}

template HistoryRow DoublePoint<2>::history_row(const FlowState<2>&) const;
template ElementField<2> DoublePoint<2>::fitted(const FlowState<2>&) const;
template ElementField<3> DoublePoint<3>::fitted(const FlowState<3>&) const;
template std::vector<Stored> DoublePoint<2>::stored() const;
template FinesState<2> DoublePoint<2>::fines_state(const FlowState<2>&) const;
template Snapshot DoublePoint<2>::snapshot(const FlowState<2>&) const;
template HistoryRow DoublePoint<3>::history_row(const FlowState<3>&) const;
template std::vector<Stored> DoublePoint<3>::stored() const;
template FinesState<3> DoublePoint<3>::fines_state(const FlowState<3>&) const;
template Snapshot DoublePoint<3>::snapshot(const FlowState<3>&) const;

}  // namespace suffuse
