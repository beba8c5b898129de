#include "transport/eulerian.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "case/errors.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Vertex `a` of side k.
template <int Dim>
constexpr int side_vertex(int k, int a) {
  return (k + 1 + a) % (Dim + 1);
}

/// Where a node stands among the vertices of an element.
template <int Dim>
std::uint8_t position_in(const std::array<int, Dim + 1>& vertices, int node) {
  return static_cast<std::uint8_t>(std::find(vertices.begin(), vertices.end(), node) -
                                   vertices.begin());
}

/// The node at the place of `node` on the other side of a face: itself, but across a wall.
template <int Dim>
int node_beyond(const Grid<Dim>& grid, int face, int node) {
  const int partner = grid.face_partner[face];
  if (partner < 0) return node;
  const auto& nodes = grid.mesh.nodes;
  return *std::ranges::min_element(grid.face_nodes[partner], {}, [&](int other) {
    return (nodes[other] - nodes[node]).squaredNorm();
  });
}

/// Concentration at the vertices of an element, written to `c`.
template <int Dim>
void find_concentration(const ElementValues<Dim>& fines, const ElementValues<Dim>& pores,
                        double* c) {
  double sum = 0.0;
  ElementValues<Dim> at_nodes;
  for (int j = 0; j <= Dim; ++j) sum += at_nodes[j] = fines[j] / pores[j];
  for (int k = 0; k <= Dim; ++k) c[k] = FieldNodes<Dim>::at_vertex(at_nodes[k], sum);
}

/// Sum of the values at a side's nodes. The elements on both sides have these in different orders
/// and find the same number, to the last bit: three values are added in the order of their size.
template <int Dim>
[[gnu::always_inline]] inline double side_sum(const std::array<double, Dim>& values) {
  if constexpr (Dim == 2) {
    return values[0] + values[1];
  } else {
    static_assert(Dim == 3);
    const double low = std::min(values[0], values[1]);
    const double high = std::max(values[0], values[1]);
    const double lowest = std::min(low, values[2]);
    const double highest = std::max(high, values[2]);
    const double middle = std::max(low, std::min(high, values[2]));
    return (lowest + middle) + highest;
  }
}

/// What transport adds to the fines of an element, per field node, m3. `c` at its vertices,
/// `crossing` at the nodes of its sides; `out`: what leaves through these is added, halved.
template <int Dim>
[[gnu::always_inline]] inline ElementValues<Dim> gain(
    const double* c, const ElementValues<Dim>& outflow, const std::vector<double>& at_vertices,
    const std::array<std::array<int, Dim>, Dim + 1>& upwind, ElementValues<Dim>& out) {
  // Integrals with the element's linear functions, times Dim (Dim + 1). Through a side: of c q with
  // those of its vertices. Inside: of c q with their gradients, where q is the field of Raviart and
  // Thomas; the geometry cancels.
  ElementValues<Dim> load{};
  double net_outflow = 0.0;
  double sum = 0.0;
  for (int k = 0; k <= Dim; ++k) {
    sum += c[k];
    net_outflow += outflow[k];
  }
  for (int k = 0; k <= Dim; ++k) {
    std::array<double, Dim> crossing;
    for (int a = 0; a < Dim; ++a) crossing[a] = at_vertices[upwind[k][a]];
    const double all = side_sum<Dim>(crossing);
    out[k] += 0.5 * (outflow[k] * (all / Dim));
    for (int a = 0; a < Dim; ++a) {
      load[side_vertex<Dim>(k, a)] -= outflow[k] * (all + crossing[a]);
    }
    load[k] += net_outflow * ((sum + c[k]) / (Dim + 2)) - outflow[k] * sum;
  }
  // The field nodes' functions are the vertices' made orthogonal: the same map as for values.
  constexpr double scale = 1.0 / (Dim * (Dim + 1));
  const double whole = element_sum<Dim>(load);
  ElementValues<Dim> result;
  for (int j = 0; j <= Dim; ++j) result[j] = scale * FieldNodes<Dim>::at_vertex(load[j], whole);
  return result;
}

void include(ConcentrationRange& range, double value) {
  range.low = std::min(range.low, value);
  range.high = std::max(range.high, value);
}

/// Where the field is flat, round-off alone would decide whether an element is an extremum and must
/// be flattened: a little room keeps the limiter continuous.
ConcentrationRange with_slack(const ConcentrationRange& range) {
  constexpr double slack = 1e-12;
  return {std::max(std::min(range.low, 0.0), range.low - slack), range.high + slack};
}

/// Whether the values at the vertices of an element are what they may be.
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

/// Share of the deviations from the mean that stays within what the vertices allow.
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
EulerianTransport<Dim>::EulerianTransport(const Grid<Dim>& grid,
                                          const std::vector<FaceCondition>& conditions, int threads)
    : grid_(grid), conditions_(conditions), threads_(threads), sides_(grid.mesh.elements.size()) {
  std::vector<int> outer(grid.face_count(), -1);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_border(f)) continue;
    outer[f] = static_cast<int>(outer_faces_.size());
    outer_faces_.push_back(f);
  }
  find_nodes_of_sides();
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    Sides& sides = sides_[e];
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid.element_face[e][k];
      const bool is_left = grid.face_left[f] == e;
      const int next = is_left ? grid.beyond(f) : grid.face_left[f];
      sides.neighbour[k] = next >= 0 ? next : -1 - outer[f];
      sides.theirs[k] = {};
      if (next < 0) continue;
      for (int a = 0; a < Dim; ++a) {
        const int node = grid.mesh.elements[e][side_vertex<Dim>(k, a)];
        sides.theirs[k][a] =
            position_in<Dim>(grid.mesh.elements[next], node_beyond<Dim>(grid, f, node));
      }
    }
  }
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
  for (std::size_t o = 0; o < outer_faces_.size(); ++o) {
    for (const int i : grid_.face_nodes[outer_faces_[o]]) {
      outer_node(i).faces.push_back(static_cast<int>(o));
    }
  }
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (grid_.face_partner[f] < 0) continue;
    leaky_faces_.push_back(f);
    for (const int i : grid_.face_nodes[f]) {
      const int partner = node_beyond<Dim>(grid_, f, i);
      std::vector<int>& partners = outer_node(i).partners;
      // The tip of a wall is one node.
      if (partner != i && std::ranges::find(partners, partner) == partners.end()) {
        partners.push_back(partner);
      }
    }
  }
}

template <int Dim>
double EulerianTransport<Dim>::steps_allowed(const FinesState<Dim>& state,
                                             const std::vector<double>& face_volume) const {
  // An element's mean is a sum of its face means with these weights; a face may take away no more
  // than its own share, or the mean could turn negative (Zhang & Shu 2010).
  return smallest_of(grid_.mesh.element_count(), threads_, infinity, [&](int e) {
    const ElementValues<Dim>& pores = state.liquid_volume[e];
    const double total = element_sum<Dim>(pores);
    const double smallest = *std::min_element(pores.begin(), pores.end());
    ElementValues<Dim> share;
    for (int k = 0; k <= Dim; ++k) {
      share[k] =
          total - Dim * (FieldNodes<Dim>::far_vertex * total + FieldNodes<Dim>::spread * pores[k]);
    }
    // Pores that differ too much have no useful weights: every face then gets the share of the
    // smallest.
    if (*std::min_element(share.begin(), share.end()) < 0.25 * smallest) share.fill(smallest);
    double allowed = infinity;
    for (int k = 0; k <= Dim; ++k) {
      const double outflow = grid_.element_face_sign[e][k] * face_volume[grid_.element_face[e][k]];
      if (outflow > 0.0) allowed = std::min(allowed, share[k] / outflow);
    }
    return allowed;
  });
}

template <int Dim>
void EulerianTransport<Dim>::start(const FinesState<Dim>& state,
                                   const std::vector<double>& face_volume,
                                   TransportScratch<Dim>& scratch) const {
  constexpr int vertices = Dim + 1;
  const int elements = grid_.mesh.element_count();
  const std::size_t values = vertices * static_cast<std::size_t>(elements) + outer_faces_.size();
  scratch.at_vertices.resize(values);
  scratch.next_at_vertices.resize(values);
  scratch.outflow.resize(elements);
  scratch.upwind.resize(elements);
  scratch.stage_fines.resize(elements);
  scratch.fines_out.resize(elements);
  scratch.mean.resize(elements);
  scratch.allowed.resize(grid_.mesh.node_count());
  for (std::size_t o = 0; o < outer_faces_.size(); ++o) {
    const std::size_t place = vertices * static_cast<std::size_t>(elements) + o;
    scratch.at_vertices[place] = scratch.next_at_vertices[place] =
        conditions_[outer_faces_[o]].concentration;
  }
  for_each_index(elements, threads_, [&](int e) {
    find_concentration<Dim>(state.fines_volume[e], state.liquid_volume[e],
                            &scratch.at_vertices[vertices * static_cast<std::size_t>(e)]);
    scratch.fines_out[e] = {};
    for (int k = 0; k <= Dim; ++k) {
      const double outflow = grid_.element_face_sign[e][k] * face_volume[grid_.element_face[e][k]];
      const int neighbour = sides_[e].neighbour[k];
      scratch.outflow[e][k] = outflow;
      for (int a = 0; a < Dim; ++a) {
        scratch.upwind[e][k][a] = outflow >= 0.0   ? vertices * e + side_vertex<Dim>(k, a)
                                  : neighbour >= 0 ? vertices * neighbour + sides_[e].theirs[k][a]
                                                   : vertices * elements - 1 - neighbour;
      }
    }
  });
}

template <int Dim>
void EulerianTransport<Dim>::face_concentration(const FinesState<Dim>& state,
                                                const std::vector<double>& face_volume,
                                                TransportScratch<Dim>& scratch,
                                                std::vector<double>& result) const {
  start(state, face_volume, scratch);
  result.resize(grid_.face_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      if (grid_.element_face_sign[e][k] < 0.0) continue;
      double sum = 0.0;
      for (const int place : scratch.upwind[e][k]) sum += scratch.at_vertices[place];
      result[grid_.element_face[e][k]] = sum / Dim;
    }
  });
  agree_at_walls(result);
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
  result.resize(grid_.face_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      if (grid_.element_face_sign[e][k] < 0.0) continue;
      result[grid_.element_face[e][k]] = scratch.fines_out[e][k];
    }
  });
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
  for (const int o : outer.faces) {
    const int f = outer_faces_[o];
    const int e = grid_.face_left[f];
    const auto& faces = grid_.element_face[e];
    const auto k = std::find(faces.begin(), faces.end(), f) - faces.begin();
    if (scratch.outflow[e][k] < 0.0) include(range, conditions_[f].concentration);
    if (scratch.outflow[e][k] > 0.0) {
      // Nothing downstream bounds the vertices of an outlet: let the field go on as it comes.
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
void EulerianTransport<Dim>::refuse_impossible(const std::vector<double>& mean) const {
  // Round-off of an empty element is not a wrong value; anything beyond it is.
  constexpr double round_off = 1e-13;
  const auto possible = [](double c) { return c >= -round_off && c < 1.0; };
  const double wrong = largest_of(static_cast<int>(mean.size()), threads_, 0.0,
                                  [&](int e) { return possible(mean[e]) ? 0.0 : 1.0; });
  if (wrong == 0.0) return;
  const auto first = std::find_if_not(mean.begin(), mean.end(), possible);
  const auto e = static_cast<int>(first - mean.begin());
  std::ostringstream message;
  message << "concentration of fluidised grains left [0, 1): " << *first << " in "
          << element_text(grid_, e);
  throw NumericalError(message.str());
}

template <int Dim>
void EulerianTransport<Dim>::limit_stage(const ElementField<Dim>& liquid, ElementField<Dim>& fines,
                                         TransportScratch<Dim>& scratch) const {
  refuse_impossible(scratch.mean);
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
    return gain<Dim>(c, scratch.outflow[e], scratch.at_vertices, scratch.upwind[e],
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
  if (!(smallest_of(grid_.mesh.element_count(), threads_, infinity, least) > 0.0)) {
    throw NumericalError(
        "deposits have filled a part of an element: give the soil a "
        "deposition.porosity_min, or place solid points nearer to Gauss points");
  }
  limit_stage(state.liquid_volume, state.fines_volume, scratch);
}

template class EulerianTransport<2>;
template class EulerianTransport<3>;

}  // namespace suffuse
