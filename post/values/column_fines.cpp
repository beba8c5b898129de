#include "values/column_fines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/drag.hpp"

namespace suffuse {
namespace {

constexpr int intervals = 2000;

/// One end of the column as the scene prescribes it.
struct End {
  const BoundaryCondition* condition = nullptr;
  double porosity = unset;  ///< of the region at this end; unset where it exchanges fines
};

struct Ends {
  End low;
  End high;
};

bool has_flow(const BoundaryCondition& b) {
  return b.pressure || b.velocity || b.darcy_flux;
}

/// 1 for the lower end of the column, 2 for the upper end, 0 for other boundaries.
int end_of(const Mesh<2>& mesh, const BoundarySet<2>& boundary, double low, double high) {
  const double slack = 1e-9 * (high - low);
  bool at_low = true;
  bool at_high = true;
  for (const auto& face : boundary.faces) {
    for (const int node : face) {
      at_low = at_low && std::abs(mesh.nodes[node][1] - low) < slack;
      at_high = at_high && std::abs(mesh.nodes[node][1] - high) < slack;
    }
  }
  if (at_low) return 1;
  return at_high ? 2 : 0;
}

double porosity_behind(const Scene& scene, const Mesh<2>& mesh, const BoundarySet<2>& boundary) {
  const auto& face = boundary.faces.front();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& corners = mesh.elements[e];
    const auto has = [&](int node) { return std::ranges::find(corners, node) != corners.end(); };
    if (!has(face[0]) || !has(face[1])) continue;
    const auto& region = mesh.region_names[mesh.element_region[e]];
    if (scene.is_free_water(region)) return 1.0;
    const Soil* soil = scene.find_soil(region);
    if (soil == nullptr || soil->exchanges()) return unset;
    return soil->initial_porosity(element_centroid(mesh, e));
  }
  return unset;
}

/// The conditions of both ends, or nothing when the flow enters or leaves at other places too.
std::optional<Ends> find_ends(const Scene& scene, const Mesh<2>& mesh) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& node : mesh.nodes) {
    low = std::min(low, node[1]);
    high = std::max(high, node[1]);
  }
  Ends ends;
  for (const auto& condition : scene.boundaries) {
    // For these conditions, the place and the amount of the inflow depend on the flow itself.
    if (condition.head || condition.seepage_face || condition.rain || condition.rate) {
      return std::nullopt;
    }
    if (!has_flow(condition)) continue;
    const auto boundary = std::ranges::find(mesh.boundaries, condition.on, &BoundarySet<2>::name);
    if (boundary == mesh.boundaries.end() || boundary->faces.empty()) return std::nullopt;
    const int place = end_of(mesh, *boundary, low, high);
    if (place == 0) return std::nullopt;
    (place == 1 ? ends.low : ends.high) = {&condition, porosity_behind(scene, mesh, *boundary)};
  }
  if (ends.low.condition == nullptr || ends.high.condition == nullptr) return std::nullopt;
  return ends;
}

/// The value that holds at all times; not a number where none does.
double lasting(const std::optional<TimeFunction>& value) {
  return value && value->is_constant() ? value->value(0.0) : unset;
}

/// Darcy flux into the model that an end prescribes; not a number where it is not known.
double prescribed_flux(const End& end) {
  if (end.condition->darcy_flux) return lasting(end.condition->darcy_flux);
  return lasting(end.condition->velocity) * end.porosity;
}

/// Integral of 1/k through all soil along the column, s; not a number with drag that is not linear
/// or a conductivity or viscosity that does not last.
double resistance(const Scene& scene, const Mesh<2>& mesh, double width) {
  if (scene.liquid.viscosity_model.depends_on_concentration()) return unset;
  double total = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Soil* soil = scene.find_soil(mesh.region_names[mesh.element_region[e]]);
    if (soil == nullptr) continue;
    const bool lasts = !soil->conductivity_law->depends_on_porosity() || !soil->exchanges();
    if (soil->drag != SoilDrag::darcy || !lasts) return unset;
    const double conductivity = soil->conductivity / soil->resistance_along(Vector<2>(0.0, 1.0));
    total += element_volume(mesh, e) / (width * conductivity);
  }
  return total;
}

/// Flux from the lower end upwards.
double upward_flux(const Scene& scene, const Mesh<2>& mesh, const Ends& ends) {
  if (const double q = prescribed_flux(ends.low); std::isfinite(q)) return q;
  if (const double q = -prescribed_flux(ends.high); std::isfinite(q)) return q;
  if (scene.gravity != std::array<double, 3>{}) return unset;
  const double head =
      (lasting(ends.low.condition->pressure) - lasting(ends.high.condition->pressure)) /
      (scene.liquid.density * conductivity_gravity);
  return head / resistance(scene, mesh, scene.geometry.width);
}

/// Whether the rate of erosion depends only on the flux, which is constant, and on the solid.
bool lasts(const Soil& soil) {
  const ErosionModel model = soil.erosion_model();
  return !model.drive->depends_on_conductivity && !depends_on_concentration(model) &&
         !soil.deposition.deposits();
}

/// Whether the flow is steady from the start on and the same across the column: the porosity is the
/// scene's, no soil moves or drains, and none conducts better at some places or at an angle to the
/// column.
bool flows_evenly(const Scene& scene) {
  return scene.initial_from.empty() && std::ranges::none_of(scene.soils, [](const Soil& soil) {
           const bool tilted = soil.anisotropy() != 1.0 && std::fmod(soil.bedding, 90.0) != 0.0;
           return soil.skeleton.moves() || soil.drains() || soil.field.varies() || tilted;
         });
}

/// The only soil that erodes, if its porosity is uniform.
const Soil* eroding_soil(const Scene& scene, const Mesh<2>& mesh) {
  const Soil* found = nullptr;
  for (const auto& region : mesh.region_names) {
    const Soil* soil = scene.find_soil(region);
    if (soil == nullptr || !soil->erosion.law->erodes()) continue;
    if (found != nullptr || soil->porosity_gradient != std::array<double, 3>{}) return nullptr;
    found = soil;
  }
  return found;
}

}  // namespace

std::optional<ColumnFlow> column_flow(const ResultsReader& run) {
  const Scene& scene = run.scene().scene;
  if (scene.geometry.shape != "column" || !flows_evenly(scene)) return std::nullopt;
  const Mesh<2> mesh = run.mesh();
  const Soil* soil = eroding_soil(scene, mesh);
  const auto ends = find_ends(scene, mesh);
  if (soil == nullptr || !ends) return std::nullopt;
  const double upward = upward_flux(scene, mesh, *ends);
  const End& inlet = upward > 0.0 ? ends->low : ends->high;
  const TimeFunction entering = inlet.condition->concentration.value_or(0.0);
  const bool clean = entering.smallest() == 0.0 && entering.largest() == 0.0;
  if (!(std::abs(upward) > 0.0) || !clean) return std::nullopt;
  if (!lasts(*soil)) return std::nullopt;
  return ColumnFlow{*soil, soil->porosity, scene.geometry.height, scene.geometry.width,
                    std::abs(upward)};
}

ColumnFines::ColumnFines(const ColumnFlow& flow, double end) : flow_(flow) {
  const double start = flow.soil.erosion.start;
  const double exhausted = exhaustion_time(flow.soil.erosion_model(), flow.porosity);
  const auto add = [&](double from, double to) {
    for (int k = 1; k <= intervals && to > from; ++k) {
      const double t = from + (to - from) * k / intervals;
      paths_.push_back(paths_.back() + path_between(times_.back(), t));
      times_.push_back(t);
    }
  };
  times_.push_back(start);
  paths_.push_back(0.0);
  add(start, std::min(end, exhausted));
  add(times_.back(), end);
}

double ColumnFines::porosity(double t) const {
  return exact_porosity(flow_.soil.erosion_model(), flow_.porosity, t, flow_.flux);
}

double ColumnFines::path_between(double from, double to) const {
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  const double offset = half * std::sqrt(0.6);
  return flow_.flux * half / 9.0 *
         (5.0 / porosity(middle - offset) + 8.0 / porosity(middle) +
          5.0 / porosity(middle + offset));
}

double ColumnFines::path(double t) const {
  if (t <= times_.front()) return (t - times_.front()) * flow_.flux / flow_.porosity;
  const auto above = std::ranges::upper_bound(times_, t);
  const auto i = static_cast<std::size_t>(above - times_.begin()) - 1;
  return paths_[i] + path_between(times_[i], t);
}

double ColumnFines::entry(double x, double t) const {
  const double wanted = path(t) - x;
  if (wanted <= 0.0) return times_.front() + wanted * flow_.porosity / flow_.flux;
  const auto above = std::ranges::upper_bound(paths_, wanted);
  const auto i = static_cast<std::size_t>(above - paths_.begin()) - 1;
  double entered = times_[i];
  for (int iteration = 0; iteration < 50; ++iteration) {  // Newton: the slope hardly changes
    const double change =
        (wanted - paths_[i] - path_between(times_[i], entered)) * porosity(entered) / flow_.flux;
    entered += change;
    if (std::abs(change) <= 1e-14 * std::max(1.0, std::abs(entered))) break;
  }
  return entered;
}

double ColumnFines::concentration(double x, double t) const {
  return 1.0 - porosity(entry(x, t)) / porosity(t);
}

/// While the liquid that leaves now crossed the specimen, liquid entered at q, so the integral of
/// n_L(t_in) along the specimen is q (t - t_in), with the t_in of the liquid that leaves now.
double ColumnFines::fines(double t) const {
  const double volume = porosity(t) * flow_.length - flow_.flux * (t - entry(flow_.length, t));
  return flow_.soil.grain_density * flow_.width * volume;
}

double ColumnFines::fines_out(double t) const {
  const double eroded = (porosity(t) - flow_.porosity) * flow_.length * flow_.width;
  return flow_.soil.grain_density * eroded - fines(t);
}

}  // namespace suffuse
