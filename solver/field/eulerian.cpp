#include "field/eulerian.hpp"
#include "physics/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/errors.hpp"
#include "field/linear_fines.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

void include(ConcentrationRange& range, double value) {
  range.low = std::min(range.low, value);
  range.high = std::max(range.high, value);
}

/// Widens a range a little. In a flat field round-off alone would otherwise decide which elements
/// are extrema, and the limiter would not be continuous.
ConcentrationRange with_slack(const ConcentrationRange& range) {
  constexpr double slack = 1e-12;
  return {std::max(std::min(range.low, 0.0), range.low - slack), range.high + slack};
}

/// Whether the values at the vertices of an element are within the allowed ranges.
template <int Dim>
bool are_allowed(const double* at_vertices, const std::array<int, Dim + 1>& vertices,
                 const std::vector<ConcentrationRange>& allowed) {
  bool all = true;
  for (int k = 0; k <= Dim; ++k) {
    const ConcentrationRange& range = allowed[vertices[k]];
    all &= (at_vertices[k] >= range.low) & (at_vertices[k] <= range.high);
  }
  return all;
}

/// Largest share of the deviations from the mean that stays within the allowed ranges.
template <int Dim>
double share_kept(const double* at_vertices, double mean, const std::array<int, Dim + 1>& vertices,
                  const std::vector<ConcentrationRange>& allowed) {
  double kept = 1.0;
  for (int k = 0; k <= Dim; ++k) {
    const ConcentrationRange& range = allowed[vertices[k]];
    const double deviation = at_vertices[k] - mean;
    const double room = deviation > 0.0 ? range.high - mean : mean - range.low;
    if (std::abs(deviation) > room) {
      kept = std::min(kept, std::max(room, 0.0) / std::abs(deviation));
    }
  }
  return kept;
}

}  // namespace

template <int Dim>
EulerianTransport<Dim>::EulerianTransport(const Grid<Dim>& grid, const ElementSides<Dim>& sides,
                                          const std::vector<FaceCondition>& conditions, int threads)
    : grid_(grid), sides_(sides), conditions_(conditions), threads_(threads) {
  find_nodes_of_sides();
}

template <int Dim>
void EulerianTransport<Dim>::find_nodes_of_sides() {
  std::vector<int> place(grid_.mesh.node_count(), -1);
  const auto outer_node = [&](int i) -> OuterNode& {
    if (place[i] < 0) {
      place[i] = static_cast<int>(outer_nodes_.size());
      outer_nodes_.push_back({i, {}, {}});
    }
    return outer_nodes_[place[i]];
  };
  for (const int f : sides_.outer_faces()) {
    for (const int i : grid_.face_nodes[f]) outer_node(i).faces.push_back(f);
  }
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (grid_.face_partner[f] < 0) continue;
    leaky_faces_.push_back(f);
    for (const int i : grid_.face_nodes[f]) {
      const int partner = node_beyond<Dim>(grid_, f, i);
      std::vector<int>& partners = outer_node(i).partners;
      // Both sides of a wall share the node at its tip.
      if (partner != i && std::ranges::find(partners, partner) == partners.end()) {
        partners.push_back(partner);
      }
    }
  }
}

template <int Dim>
double EulerianTransport<Dim>::steps_allowed(const FinesState<Dim>& state,
                                             const std::vector<double>& face_volume) const {
  // An element's mean is a weighted sum of its face means. The outflow through a face must not
  // exceed its weight, or the mean could become negative (Zhang & Shu 2010).
  const double here = smallest_of(grid_.mesh.element_count(), threads_, infinity, [&](int e) {
    const ElementValues<Dim>& pores = state.liquid_volume[e];
    const double total = element_sum<Dim>(pores);
    const double smallest = *std::min_element(pores.begin(), pores.end());
    ElementValues<Dim> share;
    for (int k = 0; k <= Dim; ++k) {
      share[k] =
          total - Dim * (FieldNodes<Dim>::far_vertex * total + FieldNodes<Dim>::spread * pores[k]);
    }
    // If the pore volumes of an element differ too much, every face gets the smallest one as
    // weight.
    if (*std::min_element(share.begin(), share.end()) < 0.25 * smallest) share.fill(smallest);
    double allowed = infinity;
    for (int k = 0; k <= Dim; ++k) {
      const double outflow = grid_.element_face_sign[e][k] * face_volume[grid_.element_face[e][k]];
      if (outflow > 0.0) allowed = std::min(allowed, share[k] / outflow);
    }
    return allowed;
  });
  return smallest_of_all(grid_.ranks(), here);
}

template <int Dim>
void EulerianTransport<Dim>::start(const FinesState<Dim>& state,
                                   const std::vector<double>& face_volume,
                                   TransportScratch<Dim>& scratch) const {
  constexpr int vertices = Dim + 1;
  const int elements = grid_.mesh.element_count();
  scratch.at_vertices.resize(sides_.value_count());
  scratch.next_at_vertices.resize(sides_.value_count());
  scratch.outflow.resize(elements);
  scratch.upwind.resize(elements);
  scratch.stage_fines.resize(elements);
  scratch.fines_out.resize(elements);
  scratch.mean.resize(elements);
  scratch.allowed.resize(grid_.mesh.node_count());
  sides_.set_entering(conditions_, scratch.at_vertices);
  sides_.set_entering(conditions_, scratch.next_at_vertices);
  for_each_index(elements, threads_, [&](int e) {
    find_concentration<Dim>(state.fines_volume[e], state.liquid_volume[e],
                            &scratch.at_vertices[vertices * static_cast<std::size_t>(e)]);
    scratch.fines_out[e] = {};
    scratch.outflow[e] = sides_.outflow(e, face_volume);
    scratch.upwind[e] = sides_.upwind_places(e, scratch.outflow[e]);
  });
}

template <int Dim>
std::vector<double> EulerianTransport<Dim>::face_concentration(
    const FinesState<Dim>& state, const std::vector<double>& face_volume) const {
  constexpr int vertices = Dim + 1;
  const int elements = grid_.mesh.element_count();
  std::vector<double> at_vertices(sides_.value_count());
  sides_.set_entering(conditions_, at_vertices);
  for_each_index(elements, threads_, [&](int e) {
    find_concentration<Dim>(state.fines_volume[e], state.liquid_volume[e],
                            &at_vertices[vertices * static_cast<std::size_t>(e)]);
  });
  std::vector<double> result(grid_.face_count());
  for_each_index(elements, threads_, [&](int e) {
    const UpwindPlaces<Dim> upwind = sides_.upwind_places(e, sides_.outflow(e, face_volume));
    for (int k = 0; k <= Dim; ++k) {
      if (grid_.element_face_sign[e][k] < 0.0) continue;
      double sum = 0.0;
      for (const int place : upwind[k]) sum += at_vertices[place];
      result[grid_.element_face[e][k]] = sum / Dim;
    }
  });
  agree_at_walls(result);
  grid_.face_rows().exchange(result);
  return result;
}

template <int Dim>
void EulerianTransport<Dim>::agree_at_walls(std::vector<double>& concentration) const {
  for (const int f : leaky_faces_) {
    const int partner = grid_.face_partner[f];
    if (partner > f) concentration[partner] = concentration[f];
  }
}

template <int Dim>
void EulerianTransport<Dim>::fines_crossed(const TransportScratch<Dim>& scratch,
                                           std::vector<double>& result) const {
  sides_.at_faces(scratch.fines_out, threads_, result);
}

template <int Dim>
ConcentrationRange EulerianTransport<Dim>::range_around(int node,
                                                        const std::vector<double>& mean) const {
  ConcentrationRange range{infinity, -infinity};
  for (int k = grid_.node_element_begin[node]; k < grid_.node_element_begin[node + 1]; ++k) {
    include(range, mean[grid_.node_element[k]]);
  }
  return range;
}

template <int Dim>
ConcentrationRange EulerianTransport<Dim>::range_at_boundary(
    const OuterNode& outer, const TransportScratch<Dim>& scratch) const {
  ConcentrationRange inside = range_around(outer.node, scratch.mean);
  for (const int i : outer.partners) {
    const ConcentrationRange across = range_around(i, scratch.mean);
    include(inside, across.low);
    include(inside, across.high);
  }
  ConcentrationRange range = inside;
  for (const int f : outer.faces) {
    const int e = grid_.face_left[f];
    const auto& faces = grid_.element_face[e];
    const auto k = std::find(faces.begin(), faces.end(), f) - faces.begin();
    if (scratch.outflow[e][k] < 0.0) include(range, conditions_[f].concentration);
    if (scratch.outflow[e][k] > 0.0) {
      // No downstream value bounds the vertices of an outlet: allow extrapolation.
      const double width = inside.high - inside.low;
      include(range, std::max(0.0, inside.low - width));
      include(range, std::min(1.0, inside.high + width));
    }
  }
  return range;
}

template <int Dim>
void EulerianTransport<Dim>::find_allowed(TransportScratch<Dim>& scratch) const {
  for_each_index(grid_.mesh.node_count(), threads_,
                 [&](int i) { scratch.allowed[i] = with_slack(range_around(i, scratch.mean)); });
  for (const OuterNode& outer : outer_nodes_) {
    scratch.allowed[outer.node] = with_slack(range_at_boundary(outer, scratch));
  }
}

template <int Dim>
void EulerianTransport<Dim>::limit_stage(const ElementField<Dim>& liquid, ElementField<Dim>& fines,
                                         TransportScratch<Dim>& scratch) const {
  grid_.element_rows().exchange(scratch.mean);
  refuse_impossible_concentrations(
      grid_, [&](int e) { return scratch.mean[e]; }, threads_);
  find_allowed(scratch);
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    const std::array<int, Dim + 1>& nodes = grid_.mesh.elements[e];
    double* at_vertices = &scratch.next_at_vertices[(Dim + 1) * static_cast<std::size_t>(e)];
    if (are_allowed<Dim>(at_vertices, nodes, scratch.allowed)) return;
    const double mean = scratch.mean[e];
    const double kept = share_kept<Dim>(at_vertices, mean, nodes, scratch.allowed);
    for (int j = 0; j <= Dim; ++j) {
      fines[e][j] = liquid[e][j] * (mean + kept * (fines[e][j] / liquid[e][j] - mean));
      at_vertices[j] = mean + kept * (at_vertices[j] - mean);
    }
  });
  grid_.element_rows().exchange(fines);
  grid_.element_rows().template exchange_blocks<Dim + 1>(scratch.next_at_vertices);
  scratch.at_vertices.swap(scratch.next_at_vertices);
}

template <int Dim>
void EulerianTransport<Dim>::advance(FinesState<Dim>& state, const ElementField<Dim>& eroded,
                                     const std::vector<double>& gained,
                                     TransportScratch<Dim>& scratch) const {
  const int elements = grid_.mesh.element_count();
  ElementField<Dim>& liquid = state.liquid_volume;
  ElementField<Dim>& fines = state.fines_volume;
  ElementField<Dim>& stage = scratch.stage_fines;
  const auto moved = [&](int e) {
    const double* c = &scratch.at_vertices[(Dim + 1) * static_cast<std::size_t>(e)];
    return gain<Dim>(c, scratch.outflow[e], scratch.at_vertices, scratch.upwind[e], 0.5,
                     scratch.fines_out[e]);
  };
  const auto update_at = [&](int e, const ElementValues<Dim>& volume) {
    find_concentration<Dim>(volume, liquid[e],
                            &scratch.next_at_vertices[(Dim + 1) * static_cast<std::size_t>(e)]);
    scratch.mean[e] = element_sum<Dim>(volume) / element_sum<Dim>(liquid[e]);
  };
  for_each_index(elements, threads_, [&](int e) {
    const ElementValues<Dim> change = moved(e);
    if (!gained.empty()) add_liquid<Dim>(liquid[e], gained[e]);
    for (int j = 0; j <= Dim; ++j) {
      if (!eroded.empty()) {
        liquid[e][j] += eroded[e][j];
        fines[e][j] += eroded[e][j];
      }
      stage[e][j] = fines[e][j] + change[j];
    }
    update_at(e, stage[e]);
  });
  limit_stage(liquid, stage, scratch);
  for_each_index(elements, threads_, [&](int e) {
    const ElementValues<Dim> change = moved(e);
    for (int j = 0; j <= Dim; ++j) fines[e][j] = 0.5 * (fines[e][j] + (stage[e][j] + change[j]));
    update_at(e, fines[e]);
  });
  limit_stage(liquid, fines, scratch);
}

template <int Dim>
void EulerianTransport<Dim>::receive(FinesState<Dim>& state, const ElementField<Dim>& exchange,
                                     TransportScratch<Dim>& scratch) const {
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    for (int j = 0; j <= Dim; ++j) {
      state.liquid_volume[e][j] += exchange[e][j];
      state.fines_volume[e][j] += exchange[e][j];
    }
    find_concentration<Dim>(state.fines_volume[e], state.liquid_volume[e],
                            &scratch.next_at_vertices[(Dim + 1) * static_cast<std::size_t>(e)]);
    scratch.mean[e] =
        element_sum<Dim>(state.fines_volume[e]) / element_sum<Dim>(state.liquid_volume[e]);
  });
  const auto least = [&](int e) { return *std::ranges::min_element(state.liquid_volume[e]); };
  const double here = smallest_of(grid_.mesh.element_count(), threads_, infinity, least);
  if (!(smallest_of_all(grid_.ranks(), here) > 0.0)) {
    throw NumericalError(
        "deposits have filled a part of an element: give the soil a "
        "deposition.porosity_min, or place solid points nearer to Gauss points");
  }
  limit_stage(state.liquid_volume, state.fines_volume, scratch);
}

template class EulerianTransport<2>;
template class EulerianTransport<3>;

}  // namespace suffuse
