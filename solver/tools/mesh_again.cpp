#include "tools/mesh_again.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "bounds/element_sizes.hpp"
#include "case/mesh_sizes.hpp"
#include "common/errors.hpp"
#include "common/short_number.hpp"
#include "driver/plan.hpp"
#include "driver/starting_point.hpp"
#include "formulation/element_snapshot.hpp"
#include "results/earlier_run.hpp"
#include "results/reader.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

constexpr double default_error = 0.01;
/// Meshes have somewhat more or fewer elements than asked for.
constexpr double as_large = 0.8;
/// Share of the error allowed at which the next mesh aims, as meshes are not quite what was asked.
constexpr double aim = 0.7;
/// One mesh is to have at least this share of the error of the last: where it sits is known only
/// once the elements beside it are small.
constexpr double least_share = 1.0 / 3.0;

/// Discharges below this share of what the heads could drive are round-off.
constexpr double no_flow = 1e-12;
/// Half an interval is this many times the discharge only where both are round-off.
constexpr double round_off_alone = 1e6;

/// What is known of the discharge of a flow, or of a run.
struct KnownDischarge {
  DischargeRecord record;      ///< at the moment at which least is known
  std::optional<double> time;  ///< that moment, where it is one of a run, s
  double largest = 0.0;        ///< discharge, m3/s
  double largest_flux = 0.0;   ///< that of the record, the largest of a run
  std::vector<double> error;   ///< of each element, the largest of a run, m3/s

  [[nodiscard]] Interval interval() const { return {record.low, record.high}; }
};

/// What is known of the steady flow at the start.
template <int Dim>
KnownDischarge known_at_start(Case<Dim> c, int threads) {
  c.document.scene.initial_flow = InitialFlow::steady;
  c.document.scene.output.probes.clear();  // bounds at probes are not needed here
  const Plan plan = make_plan(c, {.threads = threads});
  DischargeBounds bounds = make_model(c, plan)->flow().discharge_bounds().value();
  KnownDischarge known;
  known.error = std::move(bounds.error);
  const std::optional<DischargeRecord> record = discharge_record(bounds);
  if (!record) return known;
  known.record = *record;
  known.largest = std::abs(known.interval().middle());
  known.largest_flux = known.record.largest_flux;
  return known;
}

[[noreturn]] void refuse_run(const std::string& folder, const std::string& found,
                             const std::string& expected) {
  throw InputError(InputProblem{"", "--from", shown_value(folder) + found, expected});
}

/// Whether this difference of two scenes changes no flow: what is written of it, and how well it is
/// to be known. A run without mesh.error has not written it.
bool is_of_results_alone(const std::string& difference) {
  const auto is_of = [&](const char* key) { return difference.starts_with(key); };
  return is_of("output.") || is_of("mesh.max_elements:") ||
         (is_of("mesh.error:") && !difference.starts_with("mesh.error: nothing there"));
}

/// Throws InputError unless the folder has results of a run of the case that is done.
template <int Dim>
void refuse_other_run(const Case<Dim>& c, const ResultsReader& results) {
  std::vector<std::string> differences = lasting_differences(results.folder(), c);
  std::erase_if(differences, is_of_results_alone);
  if (!differences.empty()) {
    refuse_run(results.folder(), ", the results of another case",
               "those of a run of this case. " + listed_differences(differences));
  }
  if (results.status() != "done") {
    refuse_run(results.folder(), ", whose run is " + shown_value(results.status()),
               "a run that is done: let it go on with --resume");
  }
}

/// What is known of a run, from its snapshots.
template <int Dim>
KnownDischarge known_from_run(const Case<Dim>& c, const std::string& folder) {
  const ResultsReader results(folder);
  refuse_other_run(c, results);
  if (!c.document.scene.mesh.error) {
    refuse_run(folder, ", whose snapshots have no field error", "a run of a scene with mesh.error");
  }
  KnownDischarge known;
  known.error.assign(c.mesh.elements.size(), 0.0);
  for (std::size_t k = 0; k < results.times().size(); ++k) {
    const std::optional<DischargeRecord> record = results.discharge(k);
    if (!record) continue;  // nothing flowed from one head to another
    const Interval interval{record->low, record->high};
    const std::vector<double> shares = results.field(k, "cell", "error").values;
    for (std::size_t e = 0; e < known.error.size(); ++e) {
      known.error[e] = std::max(known.error[e], shares[e] * interval.half());
    }
    known.largest = std::max(known.largest, std::abs(interval.middle()));
    known.largest_flux = std::max(known.largest_flux, record->largest_flux);
    // The first of moments that differ by round-off.
    if (known.time && interval.half() <= (1.0 + 1e-9) * known.interval().half()) continue;
    known.record = *record;
    known.time = results.times()[k];
  }
  return known;
}

void refuse_explicit(const SceneDocument& document) {
  if (document.scene.time.scheme != FlowScheme::explicit_nodal) return;
  throw InputError(InputProblem{document.locate("time.scheme"), "time.scheme", "\"explicit\"",
                                "\"implicit\": only its fluxes bound the discharge"});
}

/// The flow at the start would be that of soil that no earlier run has changed.
void refuse_later_stage(const SceneDocument& document) {
  const std::string& from = document.scene.initial_from;
  if (from.empty()) return;
  throw InputError(InputProblem{document.locate("initial.from"), "initial.from", shown_value(from),
                                "none, or --from with the results of a run of this case"});
}

void refuse_without_flow(const SceneDocument& document, const KnownDischarge& known, bool of_run) {
  if (known.largest > no_flow * known.largest_flux &&
      known.interval().half() < round_off_alone * known.largest) {
    return;
  }
  throw InputError(
      document.locate("boundary") + ": got no flow that heads drive, " +
      (of_run
           ? "at any snapshot of the run; expected boundaries with heads that differ at some time"
           : "at t = 0; expected boundaries with heads that differ at the start") +
      ", for a discharge that is not given");
}

/// "Q = 1.408e-4 m3/s, between 1.407e-4 and 1.410e-4 (+- 0.11 %)".
std::string sentence(const KnownDischarge& known, int dimension) {
  const Interval q = known.interval();
  std::ostringstream text;
  text << "Q = " << q.middle() << (dimension == 2 ? " m3/s per m" : " m3/s");
  if (known.time) text << " at t = " << *known.time << " s, when least is known of it";
  text << (known.record.why_estimate.empty() ? ", between " : ", estimated between ") << q.low
       << " and " << q.high << " (+- ";
  std::ostringstream percent;
  percent << std::setprecision(2) << 100.0 * q.half() / known.largest << " %";
  text << percent.str();
  if (known.time) text << " of the largest of the run, " << known.largest;
  text << ')';
  return text.str();
}

}  // namespace

template <int Dim>
void write_sizes(Case<Dim> c, const SizesOptions& options) {
  const SceneDocument& document = c.document;
  const bool of_run = !options.run.empty();
  refuse_explicit(document);
  if (!of_run) refuse_later_stage(document);
  const KnownDischarge known =
      of_run ? known_from_run(c, options.run) : known_at_start(c, options.threads);
  refuse_without_flow(document, known, of_run);
  const MeshSettings& mesh = document.scene.mesh;
  const double allowed = mesh.error.value_or(default_error);
  const double whole = allowed * known.largest;
  const double now = known.interval().half();
  // Elements may have their largest errors at different times: these add up to more than `now`.
  const double sum = std::accumulate(known.error.begin(), known.error.end(), 0.0);
  const WantedError wanted{.whole = sum * std::max(aim * whole / now, least_share),
                           .max_elements = 1.0 * mesh.max_elements};
  write_mesh_sizes(options.output, c.mesh, next_sizes(Grid<Dim>(c.mesh), known.error, wanted));
  const int count = c.mesh.element_count();
  std::cout << sentence(known, Dim) << ", " << count << " elements\n";
  if (!known.record.why_estimate.empty()) {
    std::cout << "an estimate, no bound: " << known.record.why_estimate << '\n';
  }
  std::cout << "mesh.error = " << short_number(allowed);
  if (now <= whole) {
    std::cout << " is met\n";
  } else if (count < as_large * mesh.max_elements) {
    std::cout << " is not met: mesh again with suffuse-mesher --sizes " << options.output << '\n';
  } else {
    std::cout << " is not met within mesh.max_elements = " << mesh.max_elements
              << "; raise one of the two\n";
  }
}

template void write_sizes(Case<2>, const SizesOptions&);
template void write_sizes(Case<3>, const SizesOptions&);

}  // namespace suffuse
