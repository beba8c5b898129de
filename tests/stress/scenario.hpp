#pragma once

/// One run of the stress study: a scene, its mesh, what is done to them, and what is expected.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "case/case_file.hpp"
#include "results/reader.hpp"

namespace suffuse::stress {

/// All transport and flow schemes.
enum class Scheme {
  sp_explicit,
  sp_implicit,
  sp_monotone,
  dp_mixed,
  dp_material_point,
  dp_implicit,
  dp_monotone
};
inline constexpr std::array all_schemes{
    Scheme::sp_explicit,       Scheme::sp_implicit, Scheme::sp_monotone, Scheme::dp_mixed,
    Scheme::dp_material_point, Scheme::dp_implicit, Scheme::dp_monotone};
std::string name_of(Scheme scheme);
bool is_double_point(Scheme scheme);
bool is_explicit(Scheme scheme);

/// What the changes of a scene may depend on: the end of the run and the largest step.
struct Span {
  double end = 0.0;    ///< s
  double limit = 0.0;  ///< s, stability limit of the explicit scheme; 0 if it is not known yet
};
/// `--set` arguments, in order.
using Changes = std::vector<std::string>;

enum class Expected {
  done,     ///< the method covers it: a refusal is a failure
  refused,  ///< the method does not cover it: a run is a failure
  either
};

/// Violated conditions, a sentence each.
using Complaints = std::vector<std::string>;

/// The run is a reduction of strength, not a run in time. The factor of safety is proportional to
/// the strength of all soils, so a second run with another strength has a known factor.
struct StrengthRun {
  Changes scaled;      ///< in addition to those of the scenario
  double ratio = 1.0;  ///< of strengths, tan(phi) and c, with `scaled` over those without
};

struct Scenario {
  Scheme scheme = Scheme::sp_implicit;
  std::string parameters;  ///< in words, for the table
  unsigned seed = 0;       ///< 0: nothing is random
  std::variant<std::function<Mesh<2>()>, std::function<Mesh<3>()>> mesh;
  /// Changes of the base scene (`scene_text`).
  std::function<Changes(const Span&)> changes = [](const Span&) { return Changes{}; };
  /// Changes mesh and points after seeding; in two dimensions.
  std::function<void(Case<2>&)> disturb;
  double end = 100.0;  ///< s; explicit runs end after `explicit_steps` steps if that is sooner
  double explicit_steps = 10000.0;
  Expected expected = Expected::done;
  /// Discharge at the end of implicit runs, m3/s (per metre); known exactly.
  std::optional<double> discharge;
  /// Conditions on a run that ends well, in addition to those on all runs.
  std::function<Complaints(const ResultsReader&)> demands;
  /// A message of refusal must also contain the time (s) and the place (x, y).
  bool refusal_says_where = false;
  std::optional<StrengthRun> strength;
};

struct Sweep {
  std::string name;
  std::string what;  ///< a line for the table
  std::vector<Scenario> scenarios;
};

/// All sweeps that run the programs.
std::vector<Sweep> all_sweeps();

/// Levees under floods and rain; their soils may be unsaturated.
Sweep seepage_sweep();
/// The mesh of one of these levees, of two soils: 1 m high, slopes of 0 to 2 m.
Mesh<2> levee_mesh(unsigned seed);
/// Soils, flood, landside and rain of one of these levees; water crosses the levee within the run.
Changes levee_changes(unsigned seed, double end);

/// Soils that move: levees under floods, and columns that consolidate.
Sweep motion_sweep();
Sweep space_motion_sweep();

/// Every way in which soils give fines away and catch them.
Sweep soils_sweep();
Sweep lengths_sweep();

/// Boxes and dams of tetrahedra.
Sweep space_sweep();

}  // namespace suffuse::stress
