#pragma once

/// Fluidised fines of the single-point formulation: concentration as a discontinuous linear field,
/// carried by the face volumes of the flow. Conserves fines to round-off (Eq. 3 of the paper,
/// corrected, in conservative form).

#include <vector>

#include "field/element_sides.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

/// Volumes of liquid (the pore volume, without air) and of fluidised fines in it, per element and
/// field node, m3.
template <int Dim>
struct FinesState {
  ElementField<Dim> liquid_volume;
  ElementField<Dim> fines_volume;

  /// Concentration of fines in the liquid at a node of an element's field; 0 without liquid.
  [[nodiscard]] double concentration(int element, int node) const {
    const double liquid = liquid_volume[element][node];
    return liquid > 0.0 ? fines_volume[element][node] / liquid : 0.0;
  }

  void archive(auto& archive) { archive(on_elements(liquid_volume), on_elements(fines_volume)); }
};

/// Adds a volume of liquid to an element, distributed like its liquid.
template <int Dim>
void add_liquid(ElementValues<Dim>& liquid, double volume) {
  const double growth = 1.0 + volume / element_sum<Dim>(liquid);
  for (double& at_node : liquid) at_node *= growth;
}

/// n_L at the nodes of the field of an element: linear as its liquid.
/// \param porosity  per element, whose means the nodes get; empty: liquid fills all pores
template <int Dim>
ElementValues<Dim> node_porosity(const Grid<Dim>& grid, const ElementField<Dim>& liquid_volume,
                                 const std::vector<double>& porosity, int element) {
  ElementValues<Dim> result = liquid_volume[element];
  for (double& at_node : result) at_node /= grid.volume[element] / (Dim + 1);
  if (porosity.empty()) return result;
  const double mean = element_sum<Dim>(result) / (Dim + 1);
  for (double& at_node : result) {
    at_node = mean > 0.0 ? at_node * (porosity[element] / mean) : porosity[element];
  }
  return result;
}

/// Range of concentrations.
struct ConcentrationRange {
  double low;
  double high;
};

/// Working memory of a step, kept by the caller to avoid allocations.
template <int Dim>
struct TransportScratch {
  /// Outflow through the element's sides in one step, m3; side k lies opposite vertex k.
  ElementField<Dim> outflow;
  /// Places in `at_vertices` of the concentrations that cross side k, at its nodes.
  std::vector<UpwindPlaces<Dim>> upwind;
  /// Concentration at the vertices of each element, then the entering one of each outer face.
  std::vector<double> at_vertices;
  std::vector<double> next_at_vertices;
  ElementField<Dim> stage_fines;            ///< after the first stage, as in FinesState, m3
  std::vector<double> mean;                 ///< concentration, per element
  std::vector<ConcentrationRange> allowed;  ///< per mesh node
  ElementField<Dim> fines_out;              ///< through the element's sides since `start`, m3
};

/// Two-stage strong-stability-preserving Runge-Kutta over upwind face fluxes, concentration limited
/// after each stage (Kuzmin 2010, vertex-based: means of the elements around a vertex bound the
/// value there; the limiter changes the distribution of an element's fines, not their sum).
///
/// Every loop gathers: both elements at a side compute its flux from the same upwind values and get
/// the same number.
template <int Dim>
class EulerianTransport {
 public:
  EulerianTransport(const Grid<Dim>& grid, const ElementSides<Dim>& sides,
                    const std::vector<FaceCondition>& conditions, int threads = 1);

  /// Largest multiple of `face_volume` (m3 through each face) that one step can carry with
  /// concentrations within bounds.
  [[nodiscard]] double steps_allowed(const FinesState<Dim>& state,
                                     const std::vector<double>& face_volume) const;

  /// Starts an interval of steps, each with `face_volume` m3 of liquid through each face.
  void start(const FinesState<Dim>& state, const std::vector<double>& face_volume,
             TransportScratch<Dim>& scratch) const;
  /// Advances the state by one step, in which `eroded` m3 of fines join the liquid and elements
  /// gain `gained` m3 of liquid by the flow (empty: none). Limits the values at a vertex to the
  /// range of the means of the elements around it and of the entering concentration; requires such
  /// values at the start. Throws NumericalError if an element's mean concentration leaves [0, 1).
  void advance(FinesState<Dim>& state, const ElementField<Dim>& eroded,
               const std::vector<double>& gained, TransportScratch<Dim>& scratch) const;
  /// Adds fines (negative: removes them) to the liquid between steps of an interval, m3.
  void receive(FinesState<Dim>& state, const ElementField<Dim>& exchange,
               TransportScratch<Dim>& scratch) const;
  /// Volume of fines that crossed each face since `start`, m3.
  void fines_crossed(const TransportScratch<Dim>& scratch, std::vector<double>& result) const;

  /// Volume-weighted mean concentration of the liquid that crosses each face with `face_volume`.
  [[nodiscard]] std::vector<double> face_concentration(
      const FinesState<Dim>& state, const std::vector<double>& face_volume) const;

 private:
  /// A mesh node on the outer boundary or on a leaky wall.
  struct OuterNode {
    int node;
    std::vector<int> faces;     ///< faces of the outer boundary at the node
    std::vector<int> partners;  ///< nodes at the same place across a wall
  };

  void find_nodes_of_sides();
  /// Limits the fines of a stage with known means; sets the values at the vertices.
  void limit_stage(const ElementField<Dim>& liquid, ElementField<Dim>& fines,
                   TransportScratch<Dim>& scratch) const;
  void find_allowed(TransportScratch<Dim>& scratch) const;
  /// Makes concentrations on both sides of a wall equal for any order of their nodes.
  void agree_at_walls(std::vector<double>& concentration) const;
  /// Range of the means of the elements around a node.
  [[nodiscard]] ConcentrationRange range_around(int node, const std::vector<double>& mean) const;
  /// Range at a node of the boundary: includes elements across a wall and the entering
  /// concentration, and is wider at outlets.
  [[nodiscard]] ConcentrationRange range_at_boundary(const OuterNode& outer,
                                                     const TransportScratch<Dim>& scratch) const;

  const Grid<Dim>& grid_;
  const ElementSides<Dim>& sides_;
  const std::vector<FaceCondition>& conditions_;
  int threads_;
  std::vector<OuterNode> outer_nodes_;
  std::vector<int> leaky_faces_;  ///< faces that have a partner
};

}  // namespace suffuse
