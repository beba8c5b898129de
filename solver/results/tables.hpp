#pragma once

/// The tables of a run: history, ledger, regions and boundaries, and probes and sections where the
/// scene has any. Each row type lists its columns once, for writer, reader and the post stage.

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace suffuse {

/// A column of a table: its name in the CSV file and the member it holds.
template <class Row>
using Column = std::pair<std::string_view, double Row::*>;

/// One row of history.csv: the state of the flow at time t. Fluxes are liquid volumes per second
/// (m3/s per metre of thickness in 2D).
struct HistoryRow {
  double t = 0.0;
  double dt = 0.0;             ///< step of the flow in force, s
  double porosity_mean = 0.0;  ///< volume mean over eroding regions, or over all soil
  double flux_in = 0.0;        ///< liquid that enters through all boundaries
  double flux_out = 0.0;       ///< liquid that leaves through all boundaries
  double liquid_points = 0.0;
  double empty_elements = 0.0;
  double empty_elements_total = 0.0;
  double concentration_out =
      0.0;  ///< flux-weighted mean c of the leaving liquid; 0 when none leaves
  double concentration_min = 0.0;
  double concentration_max = 0.0;
  double pressure_min = 0.0;   ///< of the node pressures, Pa
  double pressure_max = 0.0;   ///< Pa
  double speed_max = 0.0;      ///< largest intrinsic liquid speed, m/s
  double volume_defect = 0.0;  ///< double-point: max |sum V_p / (n_L V_e) - 1| over elements
  /// Root mean square of the pressures (of elements, or of liquid points where they carry it) about
  /// the smooth field of the node pressures, Pa.
  double pressure_scatter = 0.0;
  /// Single-point, implicit: largest relative difference between an element's mass of water and
  /// what fits its pores at its pressure (equation of state); the next step corrects it.
  double eos_error = 0.0;
  /// Implicit: how far pressures lie outside the range of their boundary and initial values, over
  /// that range; 0 where gravity or a prescribed flux leaves them without such bounds.
  double pressure_overshoot = 0.0;
  double turbidity_out = 0.0;  ///< mass of fines per volume of the leaving liquid, g/l

  // No columns: what the checks of the run ask for besides.
  std::string volume_defect_at;  ///< the element of `volume_defect`; empty where there is none
  /// Of the power that drives the flow, what the weight of the fines in the liquid gives.
  double fines_weight_share = 0.0;
};

inline constexpr std::array<Column<HistoryRow>, 19> history_columns{{
    {"t", &HistoryRow::t},
    {"dt", &HistoryRow::dt},
    {"porosity_mean", &HistoryRow::porosity_mean},
    {"flux_in", &HistoryRow::flux_in},
    {"flux_out", &HistoryRow::flux_out},
    {"liquid_points", &HistoryRow::liquid_points},
    {"empty_elements", &HistoryRow::empty_elements},
    {"empty_elements_total", &HistoryRow::empty_elements_total},
    {"concentration_out", &HistoryRow::concentration_out},
    {"concentration_min", &HistoryRow::concentration_min},
    {"concentration_max", &HistoryRow::concentration_max},
    {"pressure_min", &HistoryRow::pressure_min},
    {"pressure_max", &HistoryRow::pressure_max},
    {"speed_max", &HistoryRow::speed_max},
    {"volume_defect", &HistoryRow::volume_defect},
    {"pressure_scatter", &HistoryRow::pressure_scatter},
    {"eos_error", &HistoryRow::eos_error},
    {"pressure_overshoot", &HistoryRow::pressure_overshoot},
    {"turbidity_out", &HistoryRow::turbidity_out},
}};

/// One row of ledger.csv: masses in kg (per metre of thickness in 2D), cumulative where they cross
/// a boundary. Residual = (stored + out - in - initial) / initial, per constituent.
struct LedgerRow {
  double t = 0.0;
  double solid = 0.0;     ///< all solid in place: skeleton and erodible
  double erodible = 0.0;  ///< solid in place that can still erode
  double water = 0.0;
  double fines = 0.0;   ///< fluidised fines in the model
  double eroded = 0.0;  ///< fines eroded since the start
  double water_in = 0.0;
  double fines_in = 0.0;
  double water_out = 0.0;
  double fines_out = 0.0;
  double residual_water = 0.0;  ///< relative to the initial water and what came in
  /// Relative to the initial grains, solid and fluidised, and what came in.
  double residual_grains = 0.0;
  /// Double-point: fines eroded where no liquid point is near, waiting at nodes for one.
  double pending = 0.0;
  double points = 0.0;  ///< liquid points, and how many entered and left since the start
  double points_in = 0.0;
  double points_out = 0.0;
  double deposited = 0.0;  ///< fines deposited since the start
};

inline constexpr std::array<Column<LedgerRow>, 17> ledger_columns{{
    {"t", &LedgerRow::t},
    {"solid", &LedgerRow::solid},
    {"erodible", &LedgerRow::erodible},
    {"water", &LedgerRow::water},
    {"fines", &LedgerRow::fines},
    {"eroded", &LedgerRow::eroded},
    {"water_in", &LedgerRow::water_in},
    {"fines_in", &LedgerRow::fines_in},
    {"water_out", &LedgerRow::water_out},
    {"fines_out", &LedgerRow::fines_out},
    {"residual_water", &LedgerRow::residual_water},
    {"residual_grains", &LedgerRow::residual_grains},
    {"pending", &LedgerRow::pending},
    {"points", &LedgerRow::points},
    {"points_in", &LedgerRow::points_in},
    {"points_out", &LedgerRow::points_out},
    {"deposited", &LedgerRow::deposited},
}};

/// regions.csv: the ledger of one region, its boundary with other regions included in `*_in` and
/// `*_out`. Columns: those of the ledger with `region` (index into `regions` of run.json) and
/// `porosity_mean` behind `t`.
struct RegionRow {
  int region = 0;
  double porosity_mean = 0.0;
  LedgerRow ledger;
};

/// boundaries.csv: what crossed one entry of the scene's boundaries. Masses in kg and volumes in m3
/// since the start (per metre of thickness in 2D). `boundary`, its name, stands behind `t`.
struct BoundaryRow {
  double t = 0.0;
  std::string boundary;
  double water_in = 0.0;
  double water_out = 0.0;
  double fines_in = 0.0;
  double fines_out = 0.0;
  double liquid_in = 0.0;   ///< volume of liquid, as the flow moves it
  double liquid_out = 0.0;  ///< likewise
  double discharge = 0.0;   ///< liquid out minus in at this moment, m3/s
};

inline constexpr std::array<Column<BoundaryRow>, 8> boundary_columns{{
    {"t", &BoundaryRow::t},
    {"water_in", &BoundaryRow::water_in},
    {"water_out", &BoundaryRow::water_out},
    {"fines_in", &BoundaryRow::fines_in},
    {"fines_out", &BoundaryRow::fines_out},
    {"liquid_in", &BoundaryRow::liquid_in},
    {"liquid_out", &BoundaryRow::liquid_out},
    {"discharge", &BoundaryRow::discharge},
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
};

inline constexpr std::array<Column<ProbeRow>, 11> probe_columns{{
    {"t", &ProbeRow::t},
    {"probe", &ProbeRow::probe},
    {"x", &ProbeRow::x},
    {"y", &ProbeRow::y},
    {"pressure", &ProbeRow::pressure},
    {"head", &ProbeRow::head},
    {"saturation", &ProbeRow::saturation},
    {"porosity", &ProbeRow::porosity},
    {"concentration", &ProbeRow::concentration},
    {"flux_x", &ProbeRow::flux_x},
    {"flux_y", &ProbeRow::flux_y},
}};

/// sections.csv: the liquid that crosses a line that the scene names, positive from its left side
/// to its right side, looking from `from` to `to`.
struct SectionRow {
  double t = 0.0;
  double section = 0.0;    ///< its number in the scene, from zero
  double discharge = 0.0;  ///< at this moment, m3/s
  double volume = 0.0;     ///< of liquid since the start, m3
};

inline constexpr std::array<Column<SectionRow>, 4> section_columns{{
    {"t", &SectionRow::t},
    {"section", &SectionRow::section},
    {"discharge", &SectionRow::discharge},
    {"volume", &SectionRow::volume},
}};

}  // namespace suffuse
