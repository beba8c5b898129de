#include <cmath>

#include "case/plausibility_base.hpp"
#include "common/short_number.hpp"

namespace suffuse {
namespace {

// Limits within which there is no warning.
/// Last time of a table over the end of the run, such as 48 for an hour of a flood of two days.
constexpr double longest_table = 50.0;
constexpr double shortest_table = 1e-3;
/// A table in a file, or in the scene, with at least this number of rows is a time series. With
/// fewer rows it is a value that may change at the start within any short time.
constexpr std::size_t course_in_file = 3;
constexpr std::size_t course_in_scene = 4;
constexpr double large_results = 1e9;  // bytes

// Size of a snapshot, to a factor of two (docs/reference/file-formats.md, "What it takes").
constexpr double bytes_per_number = 8.0 * 0.3;  // compressed
constexpr double bytes_per_file = 8e3;
constexpr double bytes_per_row = 1e3;  // of all tables together
constexpr double numbers_per_element = 12.0;
constexpr double numbers_per_vertex = 3.0;  // for each vertex of each element
constexpr double numbers_per_node = 5.0;
constexpr double numbers_per_solid_point = 7.0;
constexpr double numbers_per_moving_point = 23.0;
constexpr double numbers_per_liquid_point = 16.0;

template <int Dim>
class Times : private PlausibilityBase<Dim> {
 public:
  using PlausibilityBase<Dim>::PlausibilityBase;

  std::vector<std::string> run() {
    for (const BoundaryCondition& boundary : scene_.boundaries) check_boundary(boundary);
    check_comes("output.every", scene_.output.every, "no row between start and end is written");
    check_comes("output.snapshot_every", scene_.output.snapshot_every,
                "no snapshot between start and end is written");
    check_comes("output.failure_every", scene_.output.failure_every.value_or(0.0),
                "it adds no rows and snapshots");
    for (const Soil& soil : scene_.soils) {
      check_comes(joined(table_of(soil), "erosion.start"), soil.erosion.start, "nothing erodes");
    }
    check_disk();
    return std::move(warnings_);
  }

 private:
  using Base = PlausibilityBase<Dim>;
  using Base::given;
  using Base::mesh_;
  using Base::scene_;
  using Base::table_of;
  using Base::warn;
  using Base::warnings_;

  void check_boundary(const BoundaryCondition& b) {
    const bool from_file = given(joined(b.key, "file"));
    const std::vector<std::pair<std::string, const std::optional<TimeFunction>*>> functions = {
        {"pressure", &b.pressure},
        {"velocity", &b.velocity},
        {"darcy_flux", &b.darcy_flux},
        {from_file ? "file" : "head", &b.head},
        {"rain", &b.rain},
        {"rate", &b.rate},
        {"concentration", &b.concentration}};
    for (const auto& [name, function] : functions) {
      if (!*function) continue;
      check_table(joined(b.key, name), (*function)->knots,
                  name == "file" ? course_in_file : course_in_scene);
    }
    if (b.traction) check_table(joined(b.key, "traction"), b.traction->knots, course_in_scene);
  }

  /// Warns of a given time that the run does not reach.
  void check_comes(const std::string& key, double time, const std::string& so) {
    if (!given(key) || time <= scene_.time.end) return;
    warn(key, short_number(time) + " s, and the run ends at " + short_number(scene_.time.end) +
                  " s: " + so);
  }

  template <class Knots>
  void check_table(const std::string& key, const Knots& knots, std::size_t course) {
    if (knots.size() < 2) return;
    const double last = knots.back().first;
    const double end = scene_.time.end;
    check_comes(key, knots.front().first, "of this table only the first value counts");
    if (last <= 0.0) {
      warn(key, "the table ends at " + short_number(last) +
                    " s, and the run begins at 0 s: of this table only the last value counts");
    }
    const bool too_long = last > longest_table * end;
    const bool too_short = knots.size() >= course && last > 0.0 && last < shortest_table * end;
    if (!too_long && !too_short) return;
    warn(key, "the table ends at " + short_number(last) + " s, the run at " + short_number(end) +
                  " s; both are in seconds");
  }

  /// Approximate size of a snapshot, bytes.
  [[nodiscard]] double snapshot_size() const {
    const auto elements = static_cast<double>(mesh_.elements.size());
    const bool liquid = scene_.formulation == Formulation::double_point;
    const double solid = scene_.moves() ? numbers_per_moving_point : numbers_per_solid_point;
    double numbers = elements * (numbers_per_element + (Dim + 1) * numbers_per_vertex) +
                     numbers_per_node * mesh_.node_count() +
                     elements * scene_.points.solid_per_element * solid;
    if (liquid) numbers += elements * scene_.points.liquid_per_element * numbers_per_liquid_point;
    const double share = scene_.output.precision == FieldPrecision::float32 ? 0.5 : 1.0;
    return numbers * bytes_per_number * share + (liquid ? 3.0 : 2.0) * bytes_per_file;
  }

  void check_disk() {
    const OutputSettings& output = scene_.output;
    const double snapshots = std::floor(scene_.time.end / output.snapshot_every) + 1.0;
    const double rows = std::floor(scene_.time.end / output.every) + 1.0;
    const double bytes = snapshots * snapshot_size() + rows * bytes_per_row;
    if (bytes <= large_results) return;
    const std::string key = "output.snapshot_every";
    warn(given(key) ? key : "output.every",
         shown_number(snapshots) + " snapshots and " + shown_number(rows) +
             " rows of the tables take some " + short_number(std::round(bytes / 1e8) / 10.0) +
             " GB of disk; up to 1 GB is usual. A larger output.every writes fewer of both, "
             "output.snapshot_every fewer snapshots");
  }
};

}  // namespace

template <int Dim>
std::vector<std::string> time_warnings(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return Times<Dim>(document, mesh).run();
}

template std::vector<std::string> time_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> time_warnings(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse
