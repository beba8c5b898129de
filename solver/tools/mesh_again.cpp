#include "tools/mesh_again.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "bounds/element_sizes.hpp"
#include "case/mesh_sizes.hpp"
#include "common/errors.hpp"
#include "common/short_number.hpp"
#include "driver/plan.hpp"

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

/// "Q = 1.408e-4 m3/s, between 1.407e-4 and 1.410e-4".
std::string sentence(const DischargeBounds& bounds, int dimension) {
  const Interval& q = bounds.least_known;
  std::ostringstream text;
  text << "Q = " << q.middle() << (dimension == 2 ? " m3/s per m" : " m3/s")
       << (bounds.why_estimates.empty() ? ", between " : ", estimated between ") << q.low << " and "
       << q.high << " (+- " << std::setprecision(2) << 100.0 * q.half() / std::abs(q.middle())
       << " %)";
  return text.str();
}

}  // namespace

template <int Dim>
void write_sizes(Case<Dim> c, const SizesOptions& options) {
  c.document.scene.initial_flow = InitialFlow::steady;
  const Plan plan = make_plan(c, {.threads = options.threads});
  const auto model = make_model(c, plan);
  const std::optional<DischargeBounds> bounds = model->flow().discharge_bounds();
  if (!bounds) {
    throw InputError(InputProblem{c.document.locate("time.scheme"), "time.scheme", "\"explicit\"",
                                  "\"implicit\": only its fluxes bound the discharge"});
  }
  if (!(std::abs(bounds->least_known.middle()) > no_flow * bounds->largest_flux)) {
    throw InputError(
        c.document.locate("boundary") +
        ": got no flow that heads drive, at t = 0; expected boundaries with heads that "
        "differ at the start, for a discharge that is not given");
  }
  const Grid<Dim>& grid = model->grid();
  const MeshSettings& mesh = c.document.scene.mesh;
  const double allowed = mesh.error.value_or(default_error);
  const double whole = allowed * std::abs(bounds->least_known.middle());
  const WantedError wanted{.whole = std::max(aim * whole, least_share * bounds->least_known.half()),
                           .max_elements = 1.0 * mesh.max_elements};
  const std::vector<double> sizes = next_sizes(grid, bounds->error, wanted);
  write_mesh_sizes(options.output, c.mesh, sizes);
  std::cout << sentence(*bounds, Dim) << ", " << grid.mesh.element_count() << " elements\n";
  if (!bounds->why_estimates.empty()) {
    std::cout << "an estimate, no bound: " << bounds->why_estimates << '\n';
  }
  std::cout << "mesh.error = " << short_number(allowed);
  if (bounds->least_known.half() <= whole) {
    std::cout << " is met\n";
  } else if (grid.mesh.element_count() < as_large * mesh.max_elements) {
    std::cout << " is not met: mesh again with suffuse-mesher --sizes " << options.output << '\n';
  } else {
    std::cout << " is not met within mesh.max_elements = " << mesh.max_elements
              << "; raise one of the two\n";
  }
}

template void write_sizes(Case<2>, const SizesOptions&);
template void write_sizes(Case<3>, const SizesOptions&);

}  // namespace suffuse
