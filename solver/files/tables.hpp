#pragma once

/// The tables of a run: history, ledger, regions and boundaries, and probes and sections if the
/// scene has any. Each row type lists its columns once, for writer, reader and the post stage.

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace suffuse {

/// A column of a table: its name in the CSV file, the member it holds and its unit. Units of
/// masses, volumes, discharges, power and energy are per metre of thickness in 2D.
template <class Row>
struct Column {
  std::string_view name;
  double Row::*member;
  std::string_view unit;
};

/// A run stops if `eos_error` exceeds this value: the masses then do not fit the pores.
inline constexpr double max_eos_error = 0.05;

/// One row of history.csv: the state of the flow at time t. Fluxes are liquid volumes per second
/// (m3/s per metre of thickness in 2D).
struct HistoryRow {
  double t = 0.0;
  double dt = 0.0;             ///< current step of the flow, s
  double porosity_mean = 0.0;  ///< mean over soil that exchanges fines, or over all soil
  double flux_in = 0.0;        ///< liquid that enters through all boundaries
  double flux_out = 0.0;       ///< liquid that leaves through all boundaries
  double liquid_points = 0.0;
  double empty_elements = 0.0;
  double empty_elements_total = 0.0;
  double concentration_out = 0.0;  ///< flux-weighted mean c of the outflow; 0 without outflow
  double concentration_min = 0.0;
  double concentration_max = 0.0;
  double pressure_min = 0.0;   ///< of the node pressures, Pa
  double pressure_max = 0.0;   ///< Pa
  double speed_max = 0.0;      ///< largest intrinsic liquid speed, m/s
  double volume_defect = 0.0;  ///< double-point: max |sum V_p / (n_L V_e) - 1| over elements
  /// Root mean square of the difference of the pressures of elements (or of liquid points that
  /// carry pressure) from the smooth field of the node pressures, Pa.
  double pressure_scatter = 0.0;
  /// Single-point, implicit: largest difference of an element's mass of water from that of the
  /// equation of state at its pressure, as a share of the pores. The next step corrects it.
  double eos_error = 0.0;
  /// Implicit: distance of the pressures from the range of their boundary and initial values, over
  /// that range; 0 if gravity or a prescribed flux makes these bounds invalid.
  double pressure_overshoot = 0.0;
  double turbidity_out = 0.0;      ///< mass of fines per volume of the leaving liquid, g/l
  double eroded = 0.0;             ///< grains eroded since the start, kg
  double fines_out = 0.0;          ///< grains that left through the boundaries since the start, kg
  double fines_out_percent = 0.0;  ///< `fines_out` in % of the fines at the start
  double solid_out_percent = 0.0;  ///< `fines_out` in % of the solid at the start, the dry mass
  /// Conductivity of all soil over that at the start (SeepagePower); 0 without flow.
  double conductivity_ratio = 0.0;
  double power = 0.0;   ///< dissipated by the water in the soil, W
  double energy = 0.0;  ///< integral of `power` from the start, J; linear between rows
  // Motion of the skeleton; 0 if it is rigid.
  double settlement_max = 0.0;  ///< largest displacement along gravity, or down in y without it, m
  double displacement_max = 0.0;  ///< m
  /// Correction that fits the solid's flux to its volumes, over its flux, in the last step.
  double solid_correction = 0.0;
  double newton_iterations = 0.0;  ///< of the solid's equilibrium, since the start
  double inertia = 0.0;  ///< forces of inertia over the loads, in the last step; 0 in equilibrium
  double failure_time = 0.0;  ///< last loss of equilibrium, s; 0: never, or at t = 0
  // Not in the table:
  bool has_failed = false;   ///< the soil has lost its equilibrium
  bool has_inertia = false;  ///< the soil moves with its inertia
  // Bounds of `flux_out` where mesh.error is given, m3/s. Where there are none: half the interval
  // that the mesh is estimated to leave, or 0 without an estimate.
  double flux_out_low = 0.0;
  double flux_out_high = 0.0;
  double flux_out_estimate = 0.0;
  // Where mesh.error is given: estimates of the errors of the last step, m3/s.
  double flux_out_time_estimate = 0.0;
  double flux_out_transport_estimate = 0.0;

  // Values that are no columns; the checks of the run use them.
  std::string concentration_max_at;  ///< the element of `concentration_max`
  std::string volume_defect_at;      ///< the element of `volume_defect`; may be empty
  /// Share of the driving power of the flow that the weight of the fluidised fines supplies.
  double fines_weight_share = 0.0;
};

inline constexpr std::array<Column<HistoryRow>, 37> history_columns{{
    {"t", &HistoryRow::t, "s"},
    {"dt", &HistoryRow::dt, "s"},
    {"porosity_mean", &HistoryRow::porosity_mean, "1"},
    {"flux_in", &HistoryRow::flux_in, "m3/s"},
    {"flux_out", &HistoryRow::flux_out, "m3/s"},
    {"liquid_points", &HistoryRow::liquid_points, "1"},
    {"empty_elements", &HistoryRow::empty_elements, "1"},
    {"empty_elements_total", &HistoryRow::empty_elements_total, "1"},
    {"concentration_out", &HistoryRow::concentration_out, "1"},
    {"concentration_min", &HistoryRow::concentration_min, "1"},
    {"concentration_max", &HistoryRow::concentration_max, "1"},
    {"pressure_min", &HistoryRow::pressure_min, "Pa"},
    {"pressure_max", &HistoryRow::pressure_max, "Pa"},
    {"speed_max", &HistoryRow::speed_max, "m/s"},
    {"volume_defect", &HistoryRow::volume_defect, "1"},
    {"pressure_scatter", &HistoryRow::pressure_scatter, "Pa"},
    {"eos_error", &HistoryRow::eos_error, "1"},
    {"pressure_overshoot", &HistoryRow::pressure_overshoot, "1"},
    {"turbidity_out", &HistoryRow::turbidity_out, "g/l"},
    {"eroded", &HistoryRow::eroded, "kg"},
    {"fines_out", &HistoryRow::fines_out, "kg"},
    {"fines_out_percent", &HistoryRow::fines_out_percent, "%"},
    {"solid_out_percent", &HistoryRow::solid_out_percent, "%"},
    {"conductivity_ratio", &HistoryRow::conductivity_ratio, "1"},
    {"power", &HistoryRow::power, "W"},
    {"energy", &HistoryRow::energy, "J"},
    {"settlement_max", &HistoryRow::settlement_max, "m"},
    {"displacement_max", &HistoryRow::displacement_max, "m"},
    {"solid_correction", &HistoryRow::solid_correction, "1"},
    {"newton_iterations", &HistoryRow::newton_iterations, "1"},
    {"inertia", &HistoryRow::inertia, "1"},
    {"failure_time", &HistoryRow::failure_time, "s"},
    {"flux_out_low", &HistoryRow::flux_out_low, "m3/s"},
    {"flux_out_high", &HistoryRow::flux_out_high, "m3/s"},
    {"flux_out_estimate", &HistoryRow::flux_out_estimate, "m3/s"},
    {"flux_out_time_estimate", &HistoryRow::flux_out_time_estimate, "m3/s"},
    {"flux_out_transport_estimate", &HistoryRow::flux_out_transport_estimate, "m3/s"},
}};

/// Former and present names of columns of history.csv. `left` now means what remains (`fines_left`
/// of solid points); these columns contain what left the model.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 3> renamed_columns{{
    {"fines_left", "fines_out"},
    {"fines_left_percent", "fines_out_percent"},
    {"solid_left_percent", "solid_out_percent"},
}};

/// The present name of a renamed column; empty for any other name.
inline std::string renamed_column(std::string_view name) {
  for (const auto& [before, now] : renamed_columns) {
    if (name == before) return std::string(now);
  }
  return "";
}

/// One row of ledger.csv: masses in kg (per metre of thickness in 2D); those that cross a boundary
/// are cumulative. Residual = (stored + out - in - carried - initial) / (initial + in + |carried|),
/// per constituent.
struct LedgerRow {
  double t = 0.0;
  double solid = 0.0;     ///< solid in place, skeleton and erodible
  double erodible = 0.0;  ///< solid in place that can still erode
  double water = 0.0;
  double fines = 0.0;   ///< fluidised fines in the model
  double eroded = 0.0;  ///< fines eroded since the start
  double water_in = 0.0;
  double fines_in = 0.0;
  double water_out = 0.0;
  double fines_out = 0.0;
  double residual_water = 0.0;   ///< see `relative_residual`
  double residual_grains = 0.0;  ///< of solid and fluidised grains together
  /// Double-point: eroded fines kept at nodes until a liquid point comes near.
  double pending = 0.0;
  double points = 0.0;  ///< liquid points, and how many entered and left since the start
  double points_in = 0.0;
  double points_out = 0.0;
  double deposited = 0.0;  ///< fines deposited since the start
  double carried = 0.0;    ///< net solid that moving points carried in since the start
};

/// A residual over the mass that was there at the start, has entered, or came or left with soil
/// that moved; in kg if all of these are 0.
inline double relative_residual(double residual, double initial, double entered, double carried) {
  const double scale = initial + entered + std::abs(carried);
  return scale > 0.0 ? residual / scale : residual;
}

inline constexpr std::array<Column<LedgerRow>, 18> ledger_columns{{
    {"t", &LedgerRow::t, "s"},
    {"solid", &LedgerRow::solid, "kg"},
    {"erodible", &LedgerRow::erodible, "kg"},
    {"water", &LedgerRow::water, "kg"},
    {"fines", &LedgerRow::fines, "kg"},
    {"eroded", &LedgerRow::eroded, "kg"},
    {"water_in", &LedgerRow::water_in, "kg"},
    {"fines_in", &LedgerRow::fines_in, "kg"},
    {"water_out", &LedgerRow::water_out, "kg"},
    {"fines_out", &LedgerRow::fines_out, "kg"},
    {"residual_water", &LedgerRow::residual_water, "1"},
    {"residual_grains", &LedgerRow::residual_grains, "1"},
    {"pending", &LedgerRow::pending, "kg"},
    {"points", &LedgerRow::points, "1"},
    {"points_in", &LedgerRow::points_in, "1"},
    {"points_out", &LedgerRow::points_out, "1"},
    {"deposited", &LedgerRow::deposited, "kg"},
    {"carried", &LedgerRow::carried, "kg"},
}};

/// regions.csv: the ledger of one region; `*_in` and `*_out` include its borders with other
/// regions. Columns: those of the ledger, with `region` (index into `regions` of run.json) and
/// `porosity_mean` after `t`.
struct RegionRow {
  int region = 0;
  double porosity_mean = 0.0;
  LedgerRow ledger;
};

/// boundaries.csv: what crossed one entry of the scene's boundaries. Masses in kg and volumes in m3
/// since the start (per metre of thickness in 2D). The column `boundary`, its name, follows `t`.
struct BoundaryRow {
  double t = 0.0;
  std::string boundary;
  double water_in = 0.0;
  double water_out = 0.0;
  double fines_in = 0.0;
  double fines_out = 0.0;
  double liquid_in = 0.0;   ///< volume of liquid that flowed in
  double liquid_out = 0.0;  ///< volume of liquid that flowed out
  double discharge = 0.0;   ///< net outflow of liquid at this time, m3/s
  double level = 0.0;       ///< head outside, m; 0 where the scene gives none
  // Bounds and estimates of `discharge`, as those of `flux_out` in the history.
  double discharge_low = 0.0;
  double discharge_high = 0.0;
  double discharge_estimate = 0.0;
  double discharge_time_estimate = 0.0;
  double discharge_transport_estimate = 0.0;
};

inline constexpr std::array<Column<BoundaryRow>, 14> boundary_columns{{
    {"t", &BoundaryRow::t, "s"},
    {"water_in", &BoundaryRow::water_in, "kg"},
    {"water_out", &BoundaryRow::water_out, "kg"},
    {"fines_in", &BoundaryRow::fines_in, "kg"},
    {"fines_out", &BoundaryRow::fines_out, "kg"},
    {"liquid_in", &BoundaryRow::liquid_in, "m3"},
    {"liquid_out", &BoundaryRow::liquid_out, "m3"},
    {"discharge", &BoundaryRow::discharge, "m3/s"},
    {"level", &BoundaryRow::level, "m"},
    {"discharge_low", &BoundaryRow::discharge_low, "m3/s"},
    {"discharge_high", &BoundaryRow::discharge_high, "m3/s"},
    {"discharge_estimate", &BoundaryRow::discharge_estimate, "m3/s"},
    {"discharge_time_estimate", &BoundaryRow::discharge_time_estimate, "m3/s"},
    {"discharge_transport_estimate", &BoundaryRow::discharge_transport_estimate, "m3/s"},
}};

/// probes.csv: the state at a place that the scene names.
struct ProbeRow {
  double t = 0.0;
  double probe = 0.0;  ///< its number in the scene, from zero
  double x = 0.0;      ///< m
  double y = 0.0;      ///< m
  double pressure = 0.0;
  double head = 0.0;  ///< p / (rho_w g) + z; without gravity p / (rho_w 9.81), m
  double saturation = 1.0;
  double porosity = 0.0;
  double concentration = 0.0;
  double flux_x = 0.0;  ///< Darcy flux, m/s
  double flux_y = 0.0;
  double z = 0.0;       ///< m; 0 in 2D, like `flux_z`
  double flux_z = 0.0;  ///< m/s
  // Where mesh.error is given: means over a disc of radius `disc`, m, around the probe, and what
  // the mesh, the last step in time and what transport changed in it add to their errors. Otherwise
  // 0.
  double disc = 0.0;
  double head_mean = 0.0;  ///< m
  double head_mean_estimate = 0.0;
  double head_mean_time_estimate = 0.0;
  double head_mean_transport_estimate = 0.0;
  double gradient = 0.0;  ///< magnitude of the mean slope of the head, 1
  double gradient_estimate = 0.0;
  double gradient_time_estimate = 0.0;
  double gradient_transport_estimate = 0.0;
};

inline constexpr std::array<Column<ProbeRow>, 22> probe_columns{{
    {"t", &ProbeRow::t, "s"},
    {"probe", &ProbeRow::probe, "1"},
    {"x", &ProbeRow::x, "m"},
    {"y", &ProbeRow::y, "m"},
    {"pressure", &ProbeRow::pressure, "Pa"},
    {"head", &ProbeRow::head, "m"},
    {"saturation", &ProbeRow::saturation, "1"},
    {"porosity", &ProbeRow::porosity, "1"},
    {"concentration", &ProbeRow::concentration, "1"},
    {"flux_x", &ProbeRow::flux_x, "m/s"},
    {"flux_y", &ProbeRow::flux_y, "m/s"},
    {"z", &ProbeRow::z, "m"},
    {"flux_z", &ProbeRow::flux_z, "m/s"},
    {"disc", &ProbeRow::disc, "m"},
    {"head_mean", &ProbeRow::head_mean, "m"},
    {"head_mean_estimate", &ProbeRow::head_mean_estimate, "m"},
    {"head_mean_time_estimate", &ProbeRow::head_mean_time_estimate, "m"},
    {"head_mean_transport_estimate", &ProbeRow::head_mean_transport_estimate, "m"},
    {"gradient", &ProbeRow::gradient, "1"},
    {"gradient_estimate", &ProbeRow::gradient_estimate, "1"},
    {"gradient_time_estimate", &ProbeRow::gradient_time_estimate, "1"},
    {"gradient_transport_estimate", &ProbeRow::gradient_transport_estimate, "1"},
}};

/// sections.csv: the liquid that crosses a line of the scene, positive from its left side to its
/// right side, seen from `from` to `to`.
struct SectionRow {
  double t = 0.0;
  double section = 0.0;    ///< its number in the scene, from zero
  double discharge = 0.0;  ///< at this moment, m3/s
  double volume = 0.0;     ///< of liquid since the start, m3
};

inline constexpr std::array<Column<SectionRow>, 4> section_columns{{
    {"t", &SectionRow::t, "s"},
    {"section", &SectionRow::section, "1"},
    {"discharge", &SectionRow::discharge, "m3/s"},
    {"volume", &SectionRow::volume, "m3"},
}};

}  // namespace suffuse
