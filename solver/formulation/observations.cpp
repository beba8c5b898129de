#include "formulation/observations.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "common/errors.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

template <int Dim>
Vector<Dim> vector_of(const std::array<double, 3>& x) {
  Vector<Dim> result;
  for (int d = 0; d < Dim; ++d) result[d] = x[d];
  return result;
}

template <int Dim>
std::string text_of(const Vector<Dim>& x) {
  std::ostringstream text;
  text << '[' << x[0];
  for (int d = 1; d < Dim; ++d) text << ", " << x[d];
  text << ']';
  return text.str();
}

InputProblem problem(const SceneDocument& document, const std::string& key,
                     const std::string& found, const std::string& expected) {
  return {document.locate(key), key, found, expected, ""};
}

/// Pressure at a place `x` of an element, Pa: from the linear field of the element's face
/// pressures, or from node pressures if the flow has no face pressures. The former is limited to
/// the range of the pressures of the element's faces and nodes, each continued hydrostatically to
/// `x` with `weight` = rho g, Pa/m.
template <int Dim>
double pressure_at(const Grid<Dim>& grid, const FlowState<Dim>& flow, const PointPlace<Dim>& place,
                   const Vector<Dim>& x, const Vector<Dim>& weight) {
  if (flow.face_pressure.empty()) return interpolate(grid, place, flow.node_pressure);
  double result = 0.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int k = 0; k <= Dim; ++k) {
    const int f = grid.element_face[place.element][k];
    const int i = grid.mesh.elements[place.element][k];
    result += flow.face_pressure[f] * (1.0 - Dim * place.barycentric[k]);
    const double of_face = flow.face_pressure[f] + weight.dot(x - grid.face_centre(f));
    const double of_node = flow.node_pressure[i] + weight.dot(x - grid.mesh.nodes[i]);
    low = std::min({low, of_face, of_node});
    high = std::max({high, of_face, of_node});
  }
  return std::clamp(result, low, high);
}

void enter_means(const ProbeMeans& means, ProbeRow& row) {
  row.disc = means.radius;
  row.head_mean = means.head.middle();
  row.head_mean_estimate = means.head.half();
  row.head_mean_time_estimate = means.head_step.time;
  row.head_mean_transport_estimate = means.head_step.transport;
  row.gradient = means.gradient.middle();
  row.gradient_estimate = means.gradient.half();
  row.gradient_time_estimate = means.gradient_step.time;
  row.gradient_transport_estimate = means.gradient_step.transport;
}

}  // namespace

template <int Dim>
Observations<Dim>::Observations(const Case<Dim>& c, const Grid<Dim>& grid)
    : scene_(c.document.scene), grid_(grid) {
  std::vector<InputProblem> problems;
  const OutputSettings& output = scene_.output;
  for (std::size_t i = 0; i < output.probes.size(); ++i) {
    const Vector<Dim> at = vector_of<Dim>(output.probes[i].at);
    const std::optional<PointPlace<Dim>> place = find_place(grid, at);
    const double depth = place ? std::ranges::min(place->barycentric) : -infinity;
    const double deepest = largest_of_all(grid.ranks(), depth);
    if (is_first(grid.ranks(), depth == deepest)) {
      probes_.push_back(place);
    } else {
      probes_.emplace_back();
    }
    if (deepest == -infinity) {
      problems.push_back(problem(c.document, "output.probe[" + std::to_string(i) + "].at",
                                 text_of<Dim>(at), "a place in the mesh"));
    }
  }
  for (std::size_t i = 0; i < output.sections.size(); ++i) {
    const Vector<Dim> from = vector_of<Dim>(output.sections[i].from);
    const Vector<Dim> to = vector_of<Dim>(output.sections[i].to);
    const std::string key = "output.section[" + std::to_string(i) + "]";
    const std::string found = text_of<Dim>(from) + " to " + text_of<Dim>(to);
    if constexpr (Dim == 2) {
      sections_.emplace_back(grid, from, to);
      if (sections_.back().length() > 0.0) continue;
      problems.push_back(problem(c.document, key, found, "a line through the mesh"));
    } else {
      problems.push_back(problem(c.document, key, found, "no section in three dimensions"));
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  volumes_.resize(sections_.size());
}

template <int Dim>
void Observations<Dim>::book_liquid(const std::vector<double>& volumes) {
  for (std::size_t i = 0; i < sections_.size(); ++i) volumes_[i].add(sections_[i].across(volumes));
}

template <int Dim>
std::vector<ProbeRow> Observations<Dim>::probe_rows(const FlowState<Dim>& flow,
                                                    const FinesState<Dim>& liquid) const {
  const double weight = unit_weight(scene_.liquid.density, scene_.gravity);
  const Vector<Dim> density_times_gravity = scene_.liquid.density * vector_of<Dim>(scene_.gravity);
  std::vector<ProbeRow> rows;
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    if (!probes_[i]) continue;
    const PointPlace<Dim>& place = *probes_[i];
    const int e = place.element;
    // Exactly the place of the scene, without round-off.
    const auto x = vector_of<Dim>(scene_.output.probes[i].at);
    ElementValues<Dim> concentration;
    for (int j = 0; j <= Dim; ++j) {
      concentration[j] = liquid.concentration(e, j);
    }
    const Vector<Dim> flux = flux_at(grid_, flow.face_flux, e, x);
    ProbeRow row;
    row.t = flow.time;
    row.probe = static_cast<double>(i);
    row.x = x[0];
    row.y = x[1];
    row.pressure = pressure_at(grid_, flow, place, x, density_times_gravity);
    row.head = row.pressure / weight + height(x, scene_.gravity);
    row.saturation = flow.saturation.empty() ? 1.0 : flow.saturation[e];
    row.porosity = FieldNodes<Dim>::value(
        node_porosity(grid_, liquid.liquid_volume, flow.porosity, e), place.barycentric);
    row.concentration = FieldNodes<Dim>::value(concentration, place.barycentric);
    row.flux_x = flux[0];
    row.flux_y = flux[1];
    if constexpr (Dim == 3) {
      row.z = x[2];
      row.flux_z = flux[2];
    }
    if (flow.bounds && flow.bounds->probes[i]) enter_means(*flow.bounds->probes[i], row);
    rows.push_back(row);
  }
  rows = gather_values(grid_.ranks(), rows);
  std::ranges::sort(rows, {}, &ProbeRow::probe);
  return rows;
}

template <int Dim>
std::vector<SectionRow> Observations<Dim>::section_rows(const FlowState<Dim>& flow) const {
  std::vector<ExactSum> flux;
  for (const SectionLine& section : sections_) flux.push_back(section.across(flow.face_flux));
  const std::vector<double> fluxes = values_of_all(grid_.ranks(), std::move(flux));
  const std::vector<double> volumes = values_of_all(grid_.ranks(), volumes_);
  std::vector<SectionRow> rows;
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    rows.push_back({flow.time, static_cast<double>(i), fluxes[i], volumes[i]});
  }
  return rows;
}

template class Observations<2>;
template class Observations<3>;
}  // namespace suffuse
