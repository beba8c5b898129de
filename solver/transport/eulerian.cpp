#include "transport/eulerian.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "case/errors.hpp"

namespace suffuse {
namespace {

/// Where each node of a face stands among the vertices of an element.
template <int Dim>
std::array<int, Dim> local_nodes(const std::array<int, Dim>& face,
                                 const std::array<int, Dim + 1>& element) {
  std::array<int, Dim> result;
  for (int a = 0; a < Dim; ++a) {
    result[a] =
        static_cast<int>(std::find(element.begin(), element.end(), face[a]) - element.begin());
  }
  return result;
}

template <int Dim>
double mean_concentration(const FinesState<Dim>& state, int e) {
  return element_sum<Dim>(state.fines_volume[e]) / element_sum<Dim>(state.pore_volume[e]);
}

/// Range of concentrations.
struct Bounds {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

}  // namespace

template <int Dim>
EulerianTransport<Dim>::EulerianTransport(const Grid<Dim>& grid,
                                          const std::vector<FaceCondition>& conditions)
    : grid_(grid), conditions_(conditions) {
  for (int f = 0; f < grid.face_count(); ++f) {
    const auto& nodes = grid.face_nodes[f];
    left_local_.push_back(local_nodes<Dim>(nodes, grid.mesh.elements[grid.face_left[f]]));
    if (grid.is_outer(f)) {
      right_local_.push_back({});
    } else {
      right_local_.push_back(local_nodes<Dim>(nodes, grid.mesh.elements[grid.face_right[f]]));
    }
  }
}

template <int Dim>
double EulerianTransport<Dim>::steps_allowed(const FinesState<Dim>& state,
                                             const std::vector<double>& face_volume) const {
  // An element's mean is a sum of its face means with these weights; a face may take away no more
  // than its own share, or the mean could turn negative (Zhang & Shu 2010).
  double allowed = std::numeric_limits<double>::infinity();
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const auto& pores = state.pore_volume[e];
    const double total = element_sum<Dim>(pores);
    const double smallest = *std::min_element(pores.begin(), pores.end());
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid_.element_face[e][k];
      const double outflow = grid_.element_face_sign[e][k] * face_volume[f];
      if (outflow <= 0.0) continue;
      const double share =
          total - Dim * (FieldNodes<Dim>::far_vertex * total + FieldNodes<Dim>::spread * pores[k]);
      allowed = std::min(allowed, std::max(share, 0.25 * smallest) / outflow);
    }
  }
  return allowed;
}

template <int Dim>
ElementField<Dim> EulerianTransport<Dim>::vertex_concentration(const FinesState<Dim>& state) const {
  ElementField<Dim> result(state.pore_volume.size());
  for (std::size_t e = 0; e < result.size(); ++e) {
    ElementValues<Dim> c;
    for (int j = 0; j <= Dim; ++j) c[j] = state.fines_volume[e][j] / state.pore_volume[e][j];
    result[e] = FieldNodes<Dim>::at_vertices(c);
  }
  return result;
}

template <int Dim>
auto EulerianTransport<Dim>::upwind(int face, double volume,
                                    const ElementField<Dim>& at_vertices) const -> FaceValues {
  FaceValues result;
  if (volume < 0.0 && grid_.is_outer(face)) {
    result.fill(conditions_[face].concentration);
    return result;
  }
  const int e = volume < 0.0 ? grid_.face_right[face] : grid_.face_left[face];
  const auto& local = volume < 0.0 ? right_local_[face] : left_local_[face];
  for (int a = 0; a < Dim; ++a) result[a] = at_vertices[e][local[a]];
  return result;
}

template <int Dim>
std::vector<double> EulerianTransport<Dim>::face_concentration(
    const FinesState<Dim>& state, const std::vector<double>& face_volume) const {
  const ElementField<Dim> at_vertices = vertex_concentration(state);
  std::vector<double> result(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) {
    double sum = 0.0;
    for (const double c : upwind(f, face_volume[f], at_vertices)) sum += c;
    result[f] = sum / Dim;
  }
  return result;
}

template <int Dim>
void EulerianTransport<Dim>::add_transport(const FinesState<Dim>& state,
                                           const std::vector<double>& face_volume,
                                           ElementField<Dim>& change,
                                           std::vector<double>& crossed) const {
  using Nodes = FieldNodes<Dim>;
  const ElementField<Dim> at_vertices = vertex_concentration(state);

  // Faces: integrals of c times the face's own linear functions, the same number for both sides.
  for (int f = 0; f < grid_.face_count(); ++f) {
    const double volume = face_volume[f];
    if (volume == 0.0) continue;
    const FaceValues c = upwind(f, volume, at_vertices);
    double sum = 0.0;
    for (const double value : c) sum += value;
    crossed[f] += volume * sum / Dim;
    const auto give = [&](int e, const std::array<int, Dim>& local, double sign) {
      for (int a = 0; a < Dim; ++a) {
        const double load = sign * volume * (sum + c[a]) / (Dim * (Dim + 1));
        for (int j = 0; j <= Dim; ++j) {
          change[e][j] += load * Nodes::basis(j == local[a] ? 1.0 : 0.0);
        }
      }
    };
    give(grid_.face_left[f], left_local_[f], -1.0);
    if (!grid_.is_outer(f)) give(grid_.face_right[f], right_local_[f], 1.0);
  }

  // Elements: the flux inside is the Raviart-Thomas field of the face volumes. Its product with the
  // basis gradients depends on the volumes alone; the geometry cancels.
  const double scale = 1.0 / ((Dim + 1) * Dim * Nodes::spread);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    double outflow = 0.0;
    double concentration_sum = 0.0;
    ElementValues<Dim> c;
    ElementValues<Dim> face_outflow;
    for (int j = 0; j <= Dim; ++j) {
      c[j] = state.fines_volume[e][j] / state.pore_volume[e][j];
      face_outflow[j] = grid_.element_face_sign[e][j] * face_volume[grid_.element_face[e][j]];
      concentration_sum += c[j];
      outflow += face_outflow[j];
    }
    for (int j = 0; j <= Dim; ++j) {
      change[e][j] +=
          scale * (outflow * (Nodes::far_vertex * concentration_sum + Nodes::spread * c[j]) -
                   face_outflow[j] * concentration_sum);
    }
  }
}

template <int Dim>
void EulerianTransport<Dim>::limit(FinesState<Dim>& state,
                                   const std::vector<double>& face_volume) const {
  const int elements = grid_.mesh.element_count();
  std::vector<double> mean(elements);
  for (int e = 0; e < elements; ++e) {
    mean[e] = mean_concentration<Dim>(state, e);
    // Round-off of an empty element is not a wrong value; anything beyond it is.
    constexpr double round_off = 1e-13;
    if (!(mean[e] >= -round_off && mean[e] < 1.0)) {
      std::ostringstream message;
      const Vector<Dim> x = element_centroid(grid_.mesh, e);
      message << "concentration of fluidised grains left [0, 1): " << mean[e] << " in element " << e
              << " at (" << x.transpose() << ")";
      throw NumericalError(message.str());
    }
  }
  std::vector<Bounds> bounds(grid_.mesh.node_count());
  for (int e = 0; e < elements; ++e) {
    for (const int i : grid_.mesh.elements[e]) bounds[i].include(mean[e]);
  }
  std::vector<Bounds> widened = bounds;
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    for (const int i : grid_.face_nodes[f]) {
      if (face_volume[f] < 0.0) widened[i].include(conditions_[f].concentration);
      if (face_volume[f] > 0.0) {
        // Nothing downstream bounds the vertices of an outlet: let the field go on as it comes.
        const double range = bounds[i].high - bounds[i].low;
        widened[i].include(std::max(0.0, bounds[i].low - range));
        widened[i].include(std::min(1.0, bounds[i].high + range));
      }
    }
  }
  bounds = std::move(widened);
  // Where the field is flat, round-off alone would decide whether an element is an extremum and
  // must be flattened: a little room keeps the limiter continuous.
  constexpr double slack = 1e-12;
  for (Bounds& b : bounds) {
    b.low = std::max(std::min(b.low, 0.0), b.low - slack);
    b.high += slack;
  }

  for (int e = 0; e < elements; ++e) {
    ElementValues<Dim> c;
    for (int j = 0; j <= Dim; ++j) c[j] = state.fines_volume[e][j] / state.pore_volume[e][j];
    const ElementValues<Dim> at_vertices = FieldNodes<Dim>::at_vertices(c);
    double kept = 1.0;
    for (int k = 0; k <= Dim; ++k) {
      const Bounds& allowed = bounds[grid_.mesh.elements[e][k]];
      const double deviation = at_vertices[k] - mean[e];
      const double room = deviation > 0.0 ? allowed.high - mean[e] : mean[e] - allowed.low;
      if (std::abs(deviation) > room)
        kept = std::min(kept, std::max(room, 0.0) / std::abs(deviation));
    }
    if (kept == 1.0) continue;
    for (int j = 0; j <= Dim; ++j) {
      state.fines_volume[e][j] = state.pore_volume[e][j] * (mean[e] + kept * (c[j] - mean[e]));
    }
  }
}

template <int Dim>
std::vector<double> EulerianTransport<Dim>::advance(FinesState<Dim>& state,
                                                    const std::vector<double>& face_volume,
                                                    const ElementField<Dim>& eroded) const {
  const auto elements = state.pore_volume.size();
  std::vector<double> crossed(grid_.face_count(), 0.0);
  FinesState<Dim> stage = state;
  add_transport(state, face_volume, stage.fines_volume, crossed);
  for (std::size_t e = 0; e < elements; ++e) {
    for (int j = 0; j <= Dim; ++j) {
      stage.pore_volume[e][j] += eroded[e][j];
      stage.fines_volume[e][j] += eroded[e][j];
    }
  }
  limit(stage, face_volume);
  FinesState<Dim> end = stage;
  add_transport(stage, face_volume, end.fines_volume, crossed);
  for (std::size_t e = 0; e < elements; ++e) {
    for (int j = 0; j <= Dim; ++j) {
      end.fines_volume[e][j] =
          0.5 * (state.fines_volume[e][j] + eroded[e][j] + end.fines_volume[e][j]);
    }
  }
  limit(end, face_volume);
  state = std::move(end);
  for (double& volume : crossed) volume *= 0.5;
  return crossed;
}

template class EulerianTransport<2>;

}  // namespace suffuse
