#include "checks/column_checks.hpp"

#include <algorithm>
#include <map>

#include "checks/eurocode.hpp"
#include "checks/vertical_lines.hpp"
#include "physics/head.hpp"
#include "values/derived_fields.hpp"

namespace suffuse {
namespace {

/// Share of the hydrostatic pressure that is round-off: of what pressures exceed it by, and of the
/// effect of a column.
constexpr double negligible_excess = 1e-6;

/// The fields of a snapshot that load the columns.
struct ColumnState {
  ColumnState(const ResultsReader& results, std::size_t index)
      : time(results.times()[index]),
        node_pressure(results.field(index, "node", "pressure").values),
        porosity(results.field(index, "cell", "porosity").values),
        saturation(any_field(results, index, "cell", "saturation").values),
        flux(results.field(index, "cell", "darcy_flux").values) {}

  double time;
  std::vector<double> node_pressure;  ///< Pa
  std::vector<double> porosity;
  std::vector<double> saturation;
  std::vector<double> flux;  ///< m/s
};

template <int Dim>
class ColumnChecks {
 public:
  ColumnChecks(const Mesh<Dim>& mesh, const Scene& scene, const CheckSettings& settings)
      : mesh_(mesh),
        scene_(scene),
        settings_(settings),
        lines_(mesh, scene),
        unit_weight_(unit_weight(scene.liquid.density, scene.gravity)),
        has_gravity_(has_gravity(scene.gravity)) {}

  void look_at(const ColumnState& state) {
    for (const GroundPlace<Dim>& place : lines_.ground()) {
      // Air leaves through ground that is not saturated, not water.
      const bool is_exit = place.lets_water_out && is_saturated(state, place.element) &&
                           flux_through(state, place) > 0.0;
      const bool is_cover = lines_.region_of(place.element) == settings_.uplift.cover;
      // Without gravity pressures below ground that no water leaves have no datum.
      const bool is_open = place.lets_water_out && has_gravity_;
      if (is_exit || is_cover || is_open) look_below(state, place, is_exit, is_cover);
    }
  }

  [[nodiscard]] std::vector<CheckRow> rows() const {
    std::vector<CheckRow> rows;
    rows.reserve(worst_.size());
    for (const auto& [key, row] : worst_) rows.push_back(*row);
    return rows;
  }

 private:
  [[nodiscard]] static bool is_saturated(const ColumnState& state, int element) {
    return state.saturation[element] > 1.0 - 1e-9;
  }

  [[nodiscard]] double flux_through(const ColumnState& state, const GroundPlace<Dim>& place) const {
    double sum = 0.0;
    for (int d = 0; d < Dim; ++d) sum += state.flux[Dim * place.element + d] * place.outward[d];
    return sum;
  }

  [[nodiscard]] double pressure_at(const ColumnState& state, int element,
                                   const std::array<double, Dim + 1>& weights) const {
    double pressure = 0.0;
    for (int a = 0; a <= Dim; ++a) {
      pressure += weights[a] * state.node_pressure[mesh_.elements[element][a]];
    }
    return pressure;
  }

  /// Pressure of the free water on the ground, which presses on soil and pores alike; without
  /// gravity its datum.
  [[nodiscard]] double pressure_on(const ColumnState& state, const GroundPlace<Dim>& place) const {
    if (!place.bears_water) return 0.0;
    const double pressure = pressure_at(state, place.element, place.weights);
    return has_gravity_ ? std::max(0.0, pressure) : pressure;
  }

  /// Pressure at the base of a segment. Both sides of a wall have one of their own: a column lifts
  /// off together with a wall at its base, and the larger one acts on it.
  [[nodiscard]] double pressure_below(const ColumnState& state,
                                      const std::vector<LineSegment<Dim>>& line,
                                      std::size_t i) const {
    const double above = pressure_at(state, line[i].element, line[i].base_weights);
    if (i + 1 == line.size()) return above;
    return std::max(above, pressure_at(state, line[i + 1].element, line[i + 1].top_weights));
  }

  /// Weight of soil and water in an element, N/m3.
  [[nodiscard]] double bulk_weight(const ColumnState& state, int element) const {
    const Soil& soil = *scene_.find_soil(lines_.region_of(element));
    const double n = state.porosity[element];
    const double density =
        n * state.saturation[element] * scene_.liquid.density + (1.0 - n) * soil.grain_density;
    return unit_weight_ / scene_.liquid.density * density;
  }

  /// Whether the water below a column would rise above the ground and above the water there. This
  /// lifts tight or dry ground too, through which no water leaves.
  [[nodiscard]] bool is_artesian(const ColumnState& state, const GroundPlace<Dim>& place,
                                 const ColumnLoads& column) const {
    if (!place.lets_water_out || !has_gravity_) return false;
    const double at_ground = std::max(0.0, pressure_at(state, place.element, place.weights));
    const double hydrostatic = (1.0 + negligible_excess) * column.depth * unit_weight_;
    return column.pressure + pressure_on(state, place) > at_ground + hydrostatic;
  }

  void look_below(const ColumnState& state, const GroundPlace<Dim>& place, bool is_exit,
                  bool is_cover) {
    const double on_ground = pressure_on(state, place);
    ColumnLoads column;
    double hydrostatic = 0.0;
    const auto line = lines_.below(place);
    for (std::size_t i = 0; i < line.size(); ++i) {
      const LineSegment<Dim>& segment = line[i];
      column.depth += segment.length;
      column.total_stress += segment.length * bulk_weight(state, segment.element);
      if (is_saturated(state, segment.element)) hydrostatic += segment.length * unit_weight_;
      const double stored = pressure_below(state, line, i) - on_ground;
      // Without gravity pressures are those above the hydrostatic one, from any datum.
      column.pressure = has_gravity_ ? std::max(0.0, stored) : stored + hydrostatic;
      column.seepage_force = column.pressure - hydrostatic;
      column.weight = column.total_stress - hydrostatic;
      if (is_exit || is_artesian(state, place, column)) {
        add("hyd-stresses", "EN 1997-1, 2.9a", "Pa", heave_by_stresses(column, settings_.heave),
            column, state, place);
      }
      if (is_exit) {
        add("hyd-forces", "EN 1997-1, 2.9b", "N/m2", heave_by_forces(column, settings_.heave),
            column, state, place);
      }
      const bool ends =
          i + 1 == line.size() || lines_.region_of(line[i + 1].element) != settings_.uplift.cover;
      if (is_cover && ends) {
        if (i + 1 < line.size()) {
          add("uplift", "EN 1997-1, 2.8", "Pa", uplift(column, settings_.uplift.factors), column,
              state, place);
        }
        is_cover = false;
      }
    }
  }

  void add(const std::string& mechanism, const std::string& clause, const std::string& unit,
           const Utilisation& found, const ColumnLoads& column, const ColumnState& state,
           const GroundPlace<Dim>& place) {
    if (!(found.effect > negligible_excess * column.depth * unit_weight_)) return;
    const std::string where =
        place.boundary.empty() ? "ground of " + lines_.region_of(place.element) : place.boundary;
    std::optional<CheckRow>& worst = worst_[{mechanism, where}];
    if (worst) {
      // Where the factor does not depend on the depth, the deepest column counts, not round-off.
      const double change = found.factor() / *worst->factor - 1.0;
      if (change > 1e-9 || (change > -1e-9 && found.effect <= worst->effect)) return;
    }
    std::vector<double> base(place.position.data(), place.position.data() + Dim);
    const Vector<Dim> down = -column.depth * upward<Dim>(scene_);
    for (int d = 0; d < Dim; ++d) base[d] += down[d];
    CheckRow row{mechanism,        where, clause,         state.time, found.effect,
                 found.resistance, unit,  found.factor(), base};
    if (worst) row.first_below = worst->first_below;
    row.note_factor(found.factor(), state.time);
    worst = row;
  }

  const Mesh<Dim>& mesh_;
  const Scene& scene_;
  const CheckSettings& settings_;
  VerticalLines<Dim> lines_;
  double unit_weight_;
  bool has_gravity_;
  std::map<std::pair<std::string, std::string>, std::optional<CheckRow>> worst_;
};

}  // namespace

std::vector<CheckRow> column_checks(const ResultsReader& results, const CheckSettings& settings) {
  const Scene& scene = results.scene().scene;
  if (scene.moves()) return {};
  return with_mesh(results, [&]<int Dim>(const Mesh<Dim>& mesh) {
    ColumnChecks<Dim> checks(mesh, scene, settings);
    for (std::size_t i = 0; i < results.times().size(); ++i) {
      checks.look_at(ColumnState(results, i));
    }
    return checks.rows();
  });
}

}  // namespace suffuse
