#pragma once

/// Fluidised fines of the single-point formulation: concentration as a discontinuous linear field,
/// carried by the face volumes of the flow. Conserves fines to round-off (Eq. 3 of the paper,
/// corrected, in conservative form).

#include <vector>

#include "field/element_sides.hpp"

namespace suffuse {

/// Volume of liquid (that of the pores, where no air is in them) and of fluidised fines in it, per
/// element and field node, m3.
template <int Dim>
struct FinesState {
  ElementField<Dim> liquid_volume;
  ElementField<Dim> fines_volume;

  void archive(auto& archive) { archive(liquid_volume, fines_volume); }
};

/// Adds a volume of liquid to an element, spread as the liquid there lies.
template <int Dim>
void add_liquid(ElementValues<Dim>& liquid, double volume) {
  const double growth = 1.0 + volume / element_sum<Dim>(liquid);
  for (double& at_node : liquid) at_node *= growth;
}

/// Range of concentrations.
struct ConcentrationRange {
  double low;
  double high;
};

/// Working memory of a step. The caller keeps it, so that steps allocate nothing.
template <int Dim>
struct TransportScratch {
  /// Outflow through the element's sides in one step, m3; side k lies opposite vertex k.
  ElementField<Dim> outflow;
  /// Where the concentration that crosses side k is, at its nodes, among `at_vertices`.
  std::vector<UpwindPlaces<Dim>> upwind;
  /// Concentration at the vertices of each element, then what enters through each outer face.
  std::vector<double> at_vertices;
  std::vector<double> next_at_vertices;
  ElementField<Dim> stage_fines;            ///< after the first stage, as in FinesState, m3
  std::vector<double> mean;                 ///< concentration, per element
  std::vector<ConcentrationRange> allowed;  ///< per mesh node
  ElementField<Dim> fines_out;              ///< through the element's sides since `start`, m3
};

/// Two-stage strong-stability-preserving Runge-Kutta over upwind face fluxes, concentration limited
/// after each stage (Kuzmin 2010, vertex-based: means of the elements around a vertex bound the
/// value there; an element's fines are never changed, only how they lie in it).
///
/// Every loop gathers: an element finds what crosses its sides from the values on the side that it
/// comes from, and the neighbour finds the same number from the same values.
template <int Dim>
class EulerianTransport {
 public:
  EulerianTransport(const Grid<Dim>& grid, const ElementSides<Dim>& sides,
                    const std::vector<FaceCondition>& conditions, int threads = 1);

  /// Largest number of times that `face_volume` may cross in one step: a step that moves
  /// `face_volume` m3 through each face keeps concentrations within bounds while this is >= 1.
  [[nodiscard]] double steps_allowed(const FinesState<Dim>& state,
                                     const std::vector<double>& face_volume) const;

  /// Starts an interval of steps with `face_volume` m3 of liquid through each face in each.
  void start(const FinesState<Dim>& state, const std::vector<double>& face_volume,
             TransportScratch<Dim>& scratch) const;
  /// Moves the state by one step in which `eroded` m3 of fines join the liquid (empty: none), and
  /// elements gain `gained` m3 of liquid by the flow (empty: none).
  /// Leaves concentrations at the vertices within the means of the elements around them and, at an
  /// inlet, the concentration that enters; expects the state so. Throws NumericalError where an
  /// element's mean concentration leaves [0, 1).
  void advance(FinesState<Dim>& state, const ElementField<Dim>& eroded,
               const std::vector<double>& gained, TransportScratch<Dim>& scratch) const;
  /// Fines that join the liquid (negative: leave it) between steps of an interval, m3.
  void receive(FinesState<Dim>& state, const ElementField<Dim>& exchange,
               TransportScratch<Dim>& scratch) const;
  /// Volume of fines that crossed each face since `start`, m3.
  void fines_crossed(const TransportScratch<Dim>& scratch, std::vector<double>& result) const;

  /// Mean concentration, weighted with the volume of liquid, of the liquid that crosses each face
  /// when it runs along `face_volume`.
  [[nodiscard]] std::vector<double> face_concentration(
      const FinesState<Dim>& state, const std::vector<double>& face_volume) const;

 private:
  /// A mesh node on the outer boundary or on a wall that lets liquid through.
  struct OuterNode {
    int node;
    std::vector<int> faces;     ///< of the outer boundary there
    std::vector<int> partners;  ///< nodes at the same place across a wall
  };

  void find_nodes_of_sides();
  /// Limits the fines of a stage whose means are known; leaves its values at the vertices.
  void limit_stage(const ElementField<Dim>& liquid, ElementField<Dim>& fines,
                   TransportScratch<Dim>& scratch) const;
  void find_allowed(TransportScratch<Dim>& scratch) const;
  /// Concentrations on both sides of a wall are one, whatever order their nodes have.
  void agree_at_walls(std::vector<double>& concentration) const;
  /// Range of the means of the elements around a node.
  [[nodiscard]] ConcentrationRange range_around(int node, const std::vector<double>& mean) const;
  /// Range at a node of the boundary: with the elements across a wall, with what enters there, and
  /// wider where liquid leaves.
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
