#include "tools/strength_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <set>

#include "case/soil_height.hpp"
#include "common/errors.hpp"
#include "common/pending_file.hpp"
#include "driver/source_run.hpp"
#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "files/text_output.hpp"
#include "files/time_unit.hpp"
#include "physics/head.hpp"
#include "physics/skeleton/skeleton_law.hpp"
#include "results/reader.hpp"
#include "results/vtkhdf.hpp"
#include "scene/scene_schema.hpp"
#include "scene/stage_scenes.hpp"
#include "tools/strength_states.hpp"

namespace suffuse {
namespace {

/// Suction in soil without a retention law above which there is a warning, Pa.
constexpr double notable_suction = 1e3;

/// Difference of heads, over 1 m plus the head, from which on they differ.
constexpr double noticed_difference = 1e-3;

/// Depth of cracks, over the height of the soil, from which on there is a warning.
constexpr double noticed_crack = 0.25;

/// A body of fewer elements fails too late: its slip surface follows their sides.
constexpr std::size_t few_elements = 40;

bool has_strength(const Soil& soil) {
  return soil.skeleton.moves() && soil.skeleton.law->has_strength();
}

void refuse_without_strength(const SceneDocument& document) {
  if (std::ranges::any_of(document.scene.soils, has_strength)) return;
  std::vector<std::string> laws;
  for (const SkeletonLaw* law : skeleton_laws()) {
    if (law->has_strength()) laws.push_back(shown_value(std::string(law->word)));
  }
  throw InputError(document.path +
                   ": --strength-reduction: got no soil with a strength; expected law = " +
                   listed(laws) + " under [soil.NAME.skeleton]");
}

[[noreturn]] void refuse_option(const std::string& option, const std::string& found,
                                const std::string& expected) {
  throw InputError(InputProblem{"", option, found, expected});
}

/// Numbers of the requested snapshots.
std::vector<std::size_t> chosen_snapshots(const ResultsReader& results, const std::string& time) {
  const std::vector<double>& times = results.times();
  if (times.empty()) {
    refuse_option("--state", shown_value(results.folder()) + ", which has no snapshot",
                  "results with one at least");
  }
  if (time.empty()) return {times.size() - 1};
  std::vector<std::size_t> chosen;
  const std::optional<double> asked = read_time(time);
  if (!asked && time != "all")
    refuse_option("--time", shown_value(time), "all, or a time " + time_forms());
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!asked || std::abs(times[k] - *asked) <= 1e-9 * times.back()) chosen.push_back(k);
  }
  if (chosen.empty()) {
    refuse_option("--time",
                  shown_number(*asked) + ", at which " + results.folder() + " has no snapshot",
                  shown_times(times));
  }
  return chosen;
}

/// The head, m, of the water outside of a boundary at a time, s; `results`: of its run, which knows
/// the levels of reservoirs. None if the boundary has no head.
std::optional<double> head_outside(const Scene& scene, const std::string& boundary, double time,
                                   const ResultsReader& results) {
  const auto b = std::ranges::find(scene.boundaries, boundary, &BoundaryCondition::on);
  if (b == scene.boundaries.end() || !b->head) return {};
  if (!b->is_reservoir()) return b->head->value(time);
  for (const auto& [name, table] : results.boundaries()) {
    const std::vector<double>& times = table.column("t");
    const auto row = std::ranges::lower_bound(times, time * (1.0 - 1e-9));
    if (name == boundary && row != times.end()) return table.column("level")[row - times.begin()];
  }
  return {};
}

/// Warns of boundaries whose head in the case, which loads the soil, is not that of the run at a
/// time, s, which decides the pore pressures.
void warn_of_other_heads(const Scene& scene, const Scene& of_run, double time,
                         const ResultsReader& results) {
  std::set<std::string> names;
  for (const auto* of : {&scene, &of_run})
    for (const BoundaryCondition& b : of->boundaries) names.insert(b.on);
  const auto place = [](std::optional<double> head) {
    return head ? "at " + shown_number(*head) + " m" : "at no level";
  };
  for (const std::string& name : names) {
    const std::optional<double> head = head_outside(scene, name, time, results);
    const std::optional<double> there = head_outside(of_run, name, time, results);
    if (head && there ? std::abs(*head - *there) <= noticed_difference * (1.0 + std::abs(*head))
                      : head == there)
      continue;
    std::fprintf(stderr,
                 "suffuse-solver: warning: t = %s s: the water outside of boundary %s stands %s in "
                 "the case, and %s in the run that the pore pressures are from: the factor is of "
                 "soil with two levels at once\n",
                 shown_number(time).c_str(), shown_value(name).c_str(), place(head).c_str(),
                 place(there).c_str());
  }
}

/// Checks that the states have the same points, and that their numbers mean the same soil.
template <int Dim>
void refuse_other_soil(const Case<Dim>& c, const ResultsReader& results, const Case<Dim>& other) {
  if (!have_same_points(c, other)) {
    refuse_option("--state", shown_value(results.folder()) + ", whose mesh or solid points differ",
                  "a run on those of " + c.document.path +
                      ": the keys of [geometry], [mesh] and points.solid_per_element as there");
  }
  const std::string key = key_of_other_state(c.document.scene, other.document.scene);
  if (key.empty()) return;
  refuse_option("--state", shown_value(results.folder()) + ", whose " + key + " is another one",
                "a run with that of " + c.document.path);
}

template <int Dim>
void refuse_failing_soil(const Case<Dim>& c, const FailingSoil& failing) {
  std::vector<std::string> strong;
  for (const Soil& soil : c.document.scene.soils) {
    if (has_strength(soil)) strong.push_back(soil.region);
  }
  for (const std::string& region : failing.regions) {
    if (std::ranges::count(strong, region) > 0) continue;
    refuse_option("--region", shown_value(region), "a soil with a strength: " + listed(strong));
  }
  for (const Soil& soil : c.document.scene.soils) {
    if (!soil.skeleton.moves() || has_strength(soil)) continue;
    if (soil.skeleton.law == skeleton_law("elastic")) continue;
    std::fprintf(stderr,
                 "suffuse-solver: warning: soil %s is elastic in all trials and does not fail: its "
                 "law, %s, has no strength to divide\n",
                 shown_value(soil.region).c_str(), std::string(soil.skeleton.law->word).c_str());
  }
  const auto warn_of_cut = [](const char* kind, const std::string& name) {
    std::fprintf(stderr,
                 "suffuse-solver: warning: the %s %s stands still in all trials: soil slides along "
                 "it, and no slip surface crosses it\n",
                 kind, shown_value(name).c_str());
  };
  for (const Wall& wall : c.document.scene.walls) warn_of_cut("wall", wall.on);
  for (const BoundaryCondition& b : c.document.scene.boundaries) {
    if (b.is_well()) warn_of_cut("well", b.on);
  }
  if (failing.depth > 0.0 && c.document.scene.gravity == std::array<double, 3>{}) {
    refuse_option("--deeper", shown_number(failing.depth), "a scene with gravity");
  }
}

/// Cohesion bears tension, down to 2 c tan(45 + phi/2) / gamma below level ground (Terzaghi 1943).
template <int Dim>
void warn_of_tension(const Case<Dim>& c, const FailingSoil& failing) {
  const Scene& scene = c.document.scene;
  const double height = height_that_yields(c);
  for (const Soil& soil : scene.soils) {
    if (!has_strength(soil) || !failing.includes(soil.region) ||
        !(acceleration(scene.gravity) > 0.0)) {
      continue;
    }
    const SkeletonParameters strength = skeleton_at(soil.skeleton, 1.0).parameters;
    const double density = (1.0 - soil.porosity) * soil.grain_density +
                           (soil.drains() ? 0.0 : soil.porosity * scene.liquid.density);
    const double depth = 2.0 * strength.cohesion *
                         std::tan(0.25 * std::numbers::pi + 0.5 * strength.friction) /
                         (density * acceleration(scene.gravity));
    if (depth <= noticed_crack * height) continue;
    std::fprintf(stderr,
                 "suffuse-solver: warning: soil %s bears tension: its cohesion holds up to %s m "
                 "below the ground, of %s m of soil, where cracks may open; the factor takes none "
                 "into account\n",
                 shown_value(soil.region).c_str(), short_text(depth).c_str(),
                 short_text(height).c_str());
  }
}

template <int Dim>
class StrengthTable {
 public:
  StrengthTable(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                const StrengthReductionOptions& options)
      : options_(options), grid_(grid), soils_(soils) {}

  /// Adds a row if there is a factor, and returns it. Otherwise adds the reason to `without`.
  /// \param where  name of the state in sentences
  std::optional<double> add(const SoilState<Dim>& state, const std::string& where) {
    warn_of_suction(state, where);
    SafetyFactor found = find_safety_factor(grid_, soils_, state, options_.failing,
                                            options_.displacements, options_.threads);
    mechanism_ = std::move(found.mechanism);
    factor_ = found.factor;
    time_ = state.time;
    has_soil_.assign(grid_.mesh.elements.size(), 0.0);
    for (const int e : state.points.element) has_soil_[e] = 1.0;
    if (found.undecided_node >= 0) return leave_out(where + ": " + undecided(found, state));
    if (found.holds == 0.0) {
      return leave_out(
          where + ": there is no factor of safety: the soil fails, even with " +
          shown_number(1.0 / found.fails) + " times its strength; " + moving_body(state) +
          "; expected is soil that bears its loads with some strength: cohesion where water "
          "pulls at soil or flows out of it, supports where it hangs. --region and --deeper "
          "leave out soil that fails by itself");
    }
    add_row(found, state);
    if (!options_.quiet) std::fprintf(stderr, "%s\n", sentence(found, state, where).c_str());
    return factor_;
  }
  /// Writes the mechanism of the last row.
  void write_mechanism(PendingFile& pending) const {
    double largest = 0.0;
    for (int i = 0; i < grid_.mesh.node_count() && !mechanism_.empty(); ++i) {
      largest = std::max(largest, displacement(i).norm());
    }
    if (largest == 0.0) {
      std::fprintf(stderr, "suffuse-solver: warning: %s: not written, as no soil failed\n",
                   options_.mechanism.c_str());
      return;
    }
    Field motion{"mechanism", "1", Dim, mechanism_};
    for (double& v : motion.values) v /= largest;
    Field shear{"mechanism_shear", "1/m", 1, {}};
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      shear.values.push_back(shear_strain(e) / largest);
    }
    const std::vector<int>& regions = grid_.mesh.element_region;
    const Field region{"region", "1", 1, {regions.begin(), regions.end()}, true};
    {
      Hdf5File file(pending.temporary_path(), Hdf5File::Mode::create);
      write_vtkhdf(file, vtk_grid(grid_.mesh),
                   {.cell = {shear, {"soil", "1", 1, has_soil_, true}, region}, .point = {motion}});
      write_region_names(file, grid_.mesh.region_names);
      file.write_texts(layout::region_names, grid_.mesh.region_names);
      file.write(std::string(layout::field_data_group) + "/factor", std::span(&factor_, 1), {1});
      file.write(std::string(layout::field_data_group) + "/t", std::span(&time_, 1), {1});
    }
    pending.commit();
  }

  /// Why states have no factor, a line each.
  [[nodiscard]] const std::string& without() const { return without_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool has_rows() const { return std::ranges::count(text_, '\n') > 1; }

 private:
  std::nullopt_t leave_out(const std::string& why) {
    without_ += (without_.empty() ? "" : "\n") + why;
    return std::nullopt;
  }

  void add_row(const SafetyFactor& found, const SoilState<Dim>& state) {
    long iterations = 0;
    double displacement = 0.0;
    for (const StrengthTrial& trial : found.trials) {
      iterations += trial.iterations;
      if (trial.factor == found.holds) displacement = trial.displacement_max;
    }
    text_ += number_text(state.time);
    for (const double value :
         {found.factor, found.holds, found.fails, static_cast<double>(found.trials.size()),
          static_cast<double>(iterations), mean_fines_left(state), displacement}) {
      text_ += ',' + number_text(value);
    }
    text_ += '\n';
  }

  [[nodiscard]] Vector<Dim> displacement(int node) const {
    return Eigen::Map<const Vector<Dim>>(&mechanism_[static_cast<std::size_t>(Dim) * node]);
  }

  /// sqrt(2 e : e) with the deviator e of the strain: gamma in simple shear.
  [[nodiscard]] double shear_strain(int element) const {
    using Matrix = Eigen::Matrix3d;
    Matrix gradient = Matrix::Zero();
    for (int a = 0; a <= Dim; ++a) {
      gradient.template topLeftCorner<Dim, Dim>() += displacement(grid_.mesh.elements[element][a]) *
                                                     grid_.shape_gradient[element][a].transpose();
    }
    const Matrix strain = 0.5 * (gradient + gradient.transpose());
    return std::sqrt(2.0) * (strain - strain.trace() / 3.0 * Matrix::Identity()).norm();
  }

  [[nodiscard]] std::string sentence(const SafetyFactor& found, const SoilState<Dim>& state,
                                     const std::string& where) const {
    if (std::isinf(found.fails)) {
      return where + ": the soil holds, even with its strength over " + shown_number(found.holds);
    }
    return where + ": factor of safety " + short_text(found.factor) + " (holds at " +
           short_text(found.holds) + ", fails at " + short_text(found.fails) + "); " +
           moving_body(state);
  }

  /// Describes why the last trial is undecided.
  [[nodiscard]] std::string undecided(const SafetyFactor& found,
                                      const SoilState<Dim>& state) const {
    const StrengthTrial& trial = found.trials.back();
    const Vector<Dim>& node = grid_.mesh.nodes[found.undecided_node];
    const std::vector<Vector<Dim>>& places = state.points.position;
    const auto nearest = std::ranges::min_element(
        places, {}, [&](const Vector<Dim>& place) { return (place - node).squaredNorm(); });
    std::string text = "there is no factor of safety: with its strength over " +
                       short_text(trial.factor) + " the soil neither came to rest nor failed in " +
                       std::to_string(trial.iterations) + " iterations; " +
                       short_text(trial.residual) + " of all forces are out of balance, most in " +
                       soil_at(state, static_cast<int>(nearest - places.begin()));
    if (found.holds > 0.0) text += "; it holds with its strength over " + short_text(found.holds);
    if (std::isfinite(found.fails)) text += "; it fails with it over " + short_text(found.fails);
    return text +
           "; expected are displacements that stay or grow without bound: another mesh.size "
           "or a dilation nearer to the friction may give them";
  }

  /// Text such as: soil "fill" at (1.5, 2)
  [[nodiscard]] std::string soil_at(const SoilState<Dim>& state, int point) const {
    std::string text =
        "soil " + shown_value(soils_.soil_of_region(state.region[point]).region) + " at (";
    for (int k = 0; k < Dim; ++k)
      text += (k > 0 ? ", " : "") + short_text(state.points.position[point][k]);
    return text + ')';
  }

  /// Describes the failing soil: where it moves most, and how much moves at least half as far.
  [[nodiscard]] std::string moving_body(const SoilState<Dim>& state) const {
    std::vector<double> moved;
    for (const int e : state.points.element) {
      Vector<Dim> sum = Vector<Dim>::Zero();
      for (const int i : grid_.mesh.elements[e]) sum += displacement(i);
      moved.push_back(sum.norm());
    }
    const auto most = std::ranges::max_element(moved);
    double volume = 0.0;
    std::set<int> elements;
    for (std::size_t p = 0; p < moved.size(); ++p) {
      if (moved[p] < 0.5 * *most) continue;
      volume += state.points.volume[p];
      elements.insert(state.points.element[p]);
    }
    return "what fails moves most in " + soil_at(state, static_cast<int>(most - moved.begin())) +
           ", and half as far or farther in " + short_text(volume) + " m3 (" +
           std::to_string(elements.size()) + (elements.size() == 1 ? " element" : " elements") +
           (elements.size() < few_elements ? ", so few that a finer mesh may give a "
                                             "lower factor; --deeper leaves such bodies out)"
                                           : ")");
  }

  /// Remaining share of the erodible fines in soils with a strength; 1 if there were none.
  [[nodiscard]] double mean_fines_left(const SoilState<Dim>& state) const {
    double left = 0.0;
    double start = 0.0;
    for (int p = 0; p < state.points.size(); ++p) {
      if (!has_strength(soils_.soil_of_region(state.region[p]))) continue;
      start += state.erodible[p];
      left += state.fines_left[p] * state.erodible[p];
    }
    return start > 0.0 ? left / start : 1.0;
  }

  void warn_of_suction(const SoilState<Dim>& state, const std::string& where) const {
    double lowest = 0.0;
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      if (!soils_.is_soil(e)) continue;
      const Soil& soil = soils_.soil_of_element(e);
      if (has_strength(soil) && !soil.drains()) lowest = std::min(lowest, state.pressure[e]);
    }
    if (lowest > -notable_suction) return;
    std::fprintf(stderr,
                 "suffuse-solver: warning: %s: suction up to %s Pa holds soil together that has no "
                 "[soil.NAME.retention]: the factor is too large where air would enter\n",
                 where.c_str(), short_text(-lowest).c_str());
  }

  const StrengthReductionOptions& options_;
  const Grid<Dim>& grid_;
  const SoilMap<Dim>& soils_;
  std::vector<double> mechanism_;  ///< Dim values per node, m
  std::vector<double> has_soil_;   ///< 1 or 0 per element
  double factor_ = 0.0;
  double time_ = 0.0;  ///< s
  std::string without_;
  std::string text_ = "t,factor,holds,fails,trials,iterations,fines_left,displacement_max\n";
};

}  // namespace

template <int Dim>
void run_strength_reduction(const Case<Dim>& c, const StrengthReductionOptions& options) {
  refuse_without_strength(c.document);
  refuse_failing_soil(c, options.failing);
  std::optional<PendingFile> mechanism;
  if (!options.mechanism.empty()) {
    if (options.time == "all") refuse_option("--mechanism", "a file with --time all", "one time");
    mechanism.emplace(options.mechanism);
  }
  TextOutput output(options.output);
  const Grid<Dim> grid(c.mesh);
  const SoilMap<Dim> soils(c);
  StrengthTable<Dim> table(grid, soils, options);
  if (options.state.empty()) {
    table.add(start_state(c, grid, soils, options.threads), "at the start");
  } else {
    const ResultsReader results(options.state);
    const Case<Dim> of_run = read_case<Dim>(layout::in_folder(options.state, layout::case_copy));
    refuse_other_soil(c, results, of_run);
    std::string last;  // time with a factor of at least 1, s
    for (const std::size_t index : chosen_snapshots(results, options.time)) {
      const std::string time = shown_number(results.times()[index]);
      warn_of_other_heads(c.document.scene, of_run.document.scene, results.times()[index], results);
      const std::optional<double> factor =
          table.add(run_state(results, of_run, index, grid, soils, options.threads),
                    options.state + " at t = " + time + " s");
      if (!factor) continue;
      if (*factor < 1.0 && !last.empty() && !options.quiet) {
        std::fprintf(stderr, "%s: the factor falls below 1 between t = %s and %s s\n",
                     options.state.c_str(), last.c_str(), time.c_str());
      }
      last = *factor < 1.0 ? "" : time;
    }
  }
  if (table.has_rows()) warn_of_tension(c, options.failing);
  if (mechanism) table.write_mechanism(*mechanism);
  if (table.without().empty() || table.has_rows()) output.write(table.text());
  if (table.without().empty()) return;
  throw NumericalError(table.without() +
                       (table.has_rows() ? "\nThe table has the other states" : ""));
}

template void run_strength_reduction(const Case<2>&, const StrengthReductionOptions&);
template void run_strength_reduction(const Case<3>&, const StrengthReductionOptions&);

}  // namespace suffuse
