/// What the results hold of a double-point model.

#include <algorithm>
#include <cmath>

#include "formulation/double_point.hpp"
#include "formulation/observation.hpp"
#include "grid/face_flux.hpp"
#include "transport/concentration_fit.hpp"

namespace suffuse {
namespace {

/// Codes of the field `saturation_state`.
enum class Saturation { dry_soil, saturated_soil, free_liquid, empty };

}  // namespace

template <int Dim>
HistoryRow DoublePoint<Dim>::history_row(const State& state, const FlowState<Dim>& moment) const {
  HistoryRow row;
  row.t = state.time;
  row.porosity_mean = mean_porosity(skeleton_, state.porosity);
  flow_->describe(moment, row);
  const LiquidPoints<Dim>& liquid = state.liquid;
  const std::vector<int> begins = element_begins(liquid, grid_.mesh.element_count());
  row.liquid_points = liquid.size();
  row.empty_elements = empty_elements(begins);
  row.empty_elements_total = state.empty_total;

  const std::vector<double> volume = point_volumes(liquid, moment.pressure);
  const std::vector<double> concentration = concentrations(liquid, volume);
  if (!concentration.empty()) {
    const auto [least, most] = std::minmax_element(concentration.begin(), concentration.end());
    row.concentration_min = *least;
    row.concentration_max = *most;
  }
  const ElementField<Dim> fit = concentration_fit(grid_, liquid, begins, volume, concentration);
  CompensatedSum fines_out;
  for (int f = 0; f < grid_.face_count(); ++f) {
    const double flux = moment.face_flux[f];
    if (!grid_.is_outer(f) || flux <= 0.0) continue;
    const int e = grid_.face_left[f];
    const ElementValues<Dim> at_vertices = FieldNodes<Dim>::at_vertices(fit[e]);
    for (int a = 0; a <= Dim; ++a) {
      if (grid_.element_face[e][a] != f) fines_out.add(flux * at_vertices[a] / Dim);
    }
  }
  row.concentration_out = row.flux_out > 0.0 ? fines_out.value() / row.flux_out : 0.0;

  const std::vector<double> porosity = element_porosity(state.porosity);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    double filled = 0.0;
    for (int p = begins[e]; p < begins[e + 1]; ++p) filled += volume[p];
    row.volume_defect =
        std::max(row.volume_defect, std::abs(filled / (porosity[e] * grid_.volume[e]) - 1.0));
  }
  if (carried_flow_ != nullptr) {
    row.pressure_scatter = point_pressure_scatter(liquid, volume, moment.node_pressure);
  }
  return row;
}

template <int Dim>
double DoublePoint<Dim>::point_pressure_scatter(const LiquidPoints<Dim>& liquid,
                                                const std::vector<double>& volume,
                                                const std::vector<double>& smooth) const {
  double square = 0.0;
  double sum = 0.0;
  for (int p = 0; p < liquid.size(); ++p) {
    const double off = liquid.pressure[p] - interpolated(liquid, p, smooth);
    square += volume[p] * off * off;
    sum += volume[p];
  }
  return std::sqrt(square / sum);
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::concentrations(const LiquidPoints<Dim>& liquid,
                                                     const std::vector<double>& volume) const {
  std::vector<double> result(liquid.size());
  for (int p = 0; p < liquid.size(); ++p) {
    result[p] = liquid.fines_mass[p] / (densities_.grain * volume[p]);
  }
  return result;
}

template <int Dim>
double DoublePoint<Dim>::interpolated(const LiquidPoints<Dim>& liquid, int p,
                                      const std::vector<double>& at_nodes) const {
  double value = 0.0;
  for (int a = 0; a <= Dim; ++a) {
    value += liquid.barycentric[p][a] * at_nodes[grid_.mesh.elements[liquid.element[p]][a]];
  }
  return value;
}

template <int Dim>
std::vector<Stored> DoublePoint<Dim>::stored(const State& state) const {
  std::vector<StoredSums> sums(accounts_.count());
  book_solid(skeleton_, grid_.mesh, densities_.grain, state.porosity, sums);
  const LiquidPoints<Dim>& liquid = state.liquid;
  for (int p = 0; p < liquid.size(); ++p) {
    for (StoredSums* sum : {&sums[0], &sums[grid_.mesh.element_region[liquid.element[p]] + 1]}) {
      sum->water.add(liquid.water_mass[p]);
      sum->fines.add(liquid.fines_mass[p]);
      ++sum->points;
    }
  }
  for (const double volume : state.pending) sums[0].pending.add(densities_.grain * volume);
  std::vector<Stored> result;
  result.reserve(sums.size());
  for (const StoredSums& s : sums) result.push_back(s.totals());
  return result;
}

template <int Dim>
LedgerRow DoublePoint<Dim>::ledger(const State& state) const {
  return ledger_row(state.time, stored(state)[0], state.crossed[0].totals(), initial_[0]);
}

template <int Dim>
std::vector<RegionRow> DoublePoint<Dim>::region_rows(const State& state) const {
  return suffuse::region_rows(skeleton_, grid_, densities_.grain, state.time, stored(state),
                              initial_, state.crossed);
}

template <int Dim>
Snapshot DoublePoint<Dim>::snapshot(const State& state, const FlowState<Dim>& moment,
                                    long step) const {
  const LiquidPoints<Dim>& liquid = state.liquid;
  const std::vector<int> begins = element_begins(liquid, grid_.mesh.element_count());
  std::vector<double> volume = point_volumes(liquid, moment.pressure);
  std::vector<double> concentration = concentrations(liquid, volume);

  FinesState<Dim> between_points;
  between_points.pore_volume = skeleton_.initial_pore_volume();
  between_points.fines_volume = concentration_fit(grid_, liquid, begins, volume, concentration);
  const ElementField<Dim> eroded =
      skeleton_.eroded_volume(skeleton_.initial_porosity(), state.porosity);
  for (std::size_t e = 0; e < eroded.size(); ++e) {
    for (int j = 0; j <= Dim; ++j) {
      between_points.pore_volume[e][j] += eroded[e][j];
      between_points.fines_volume[e][j] *= between_points.pore_volume[e][j];
    }
  }
  Snapshot result = make_snapshot(grid_, skeleton_, state.porosity, between_points, moment, step);

  Field saturation{"saturation_state", "1", 1, {}};
  Field count{"liquid_points", "1", 1, {}};
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const bool soil = skeleton_.is_soil(e);
    const bool filled = begins[e + 1] > begins[e];
    const Saturation s = soil ? (filled ? Saturation::saturated_soil : Saturation::dry_soil)
                              : (filled ? Saturation::free_liquid : Saturation::empty);
    saturation.values.push_back(static_cast<double>(s));
    count.values.push_back(begins[e + 1] - begins[e]);
  }
  result.cell.push_back(std::move(saturation));
  result.cell.push_back(std::move(count));

  result.liquid.reserve(8);
  // Moved, not copied: with many points this is most of the memory of a run.
  const auto add = [&](const char* name, const char* unit, std::vector<double> values) {
    result.liquid.push_back({name, unit, 1, std::move(values)});
  };
  add("concentration", "1", std::move(concentration));
  add_places(state, moment, result);
  add("volume", Dim == 2 ? "m3/m" : "m3", std::move(volume));
  add("water_mass", Dim == 2 ? "kg/m" : "kg", liquid.water_mass);
  add("fines_mass", Dim == 2 ? "kg/m" : "kg", liquid.fines_mass);
  add("element", "1", {liquid.element.begin(), liquid.element.end()});
  add("id", "1", {liquid.id.begin(), liquid.id.end()});
  return result;
}

template <int Dim>
void DoublePoint<Dim>::add_places(const State& state, const FlowState<Dim>& moment,
                                  Snapshot& result) const {
  const LiquidPoints<Dim>& liquid = state.liquid;
  const std::vector<double> porosity = element_porosity(state.porosity);
  Field pressure{"pressure", "Pa", 1, {}};
  Field velocity{"liquid_velocity", "m/s", Dim, {}};
  const auto points = static_cast<std::size_t>(liquid.size());
  result.liquid_positions.reserve(3 * points);
  pressure.values.reserve(points);
  velocity.values.reserve(Dim * points);
  for (int p = 0; p < liquid.size(); ++p) {
    const int e = liquid.element[p];
    const Vector<Dim> x = liquid.place(p).position(grid_.mesh);
    for (int d = 0; d < 3; ++d) result.liquid_positions.push_back(d < Dim ? x[d] : 0.0);
    pressure.values.push_back(carried_flow_ != nullptr
                                  ? liquid.pressure[p]
                                  : interpolated(liquid, p, moment.node_pressure));
    const Vector<Dim> flux = flux_at(grid_, moment.face_flux, e, x);
    for (int d = 0; d < Dim; ++d) velocity.values.push_back(flux[d] / porosity[e]);
  }
  result.liquid.push_back(std::move(pressure));
  result.liquid.push_back(std::move(velocity));
}

template HistoryRow DoublePoint<2>::history_row(const State&, const FlowState<2>&) const;
template std::vector<Stored> DoublePoint<2>::stored(const State&) const;
template LedgerRow DoublePoint<2>::ledger(const State&) const;
template std::vector<RegionRow> DoublePoint<2>::region_rows(const State&) const;
template Snapshot DoublePoint<2>::snapshot(const State&, const FlowState<2>&, long) const;

}  // namespace suffuse
