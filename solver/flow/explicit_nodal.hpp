#pragma once

/// The paper's flow scheme: explicit liquid momentum at the nodes, one pressure per element.

#include <array>
#include <vector>

#include "flow/nodal_operator.hpp"
#include "grid/simd.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

struct ExplicitSettings {
  double bulk_modulus = unset;
  double mass_scaling = 1.0;
  DragIntegration drag = DragIntegration::explicit_drag;
  /// false drops the third term of Eq. 2, for comparison: see FlowSettings.
  bool porosity_gradient_term = true;
  /// Pressure changes with strain alone: its convection, of order p / K, is done by whoever moves
  /// the liquid, or left out where no mass hangs on it. Nobody then asks what the density of the
  /// water was that crossed a face.
  bool pressure_moves_with_liquid = false;
  bool sum_displacements = false;
  int threads = 1;
};

/// Symplectic Euler started with half a step of velocity, so that velocity lives between the times
/// of pressure: second order without drag, first order with it (drag is evaluated at one end).
///
/// A step is two loops, four nodes or elements at a time. `accelerate` goes over nodes and gathers
/// their force from the elements around them; it reads and writes 84 bytes per element of the mesh
/// and is bound by its arithmetic, or nearly. `compress` goes over elements and forms the fluxes
/// through their faces again for either side, the same to the last bit; it is bound by memory on
/// meshes that no cache holds: 144 bytes per element, of which 96 belong to convection. For that
/// reason normals come from the places of nodes, no face has an array, and the state at nodes is
/// the flux q_i = n_i v_i alone.
///
/// Inner nodes and elements, almost all of a large mesh, need not ask for boundary conditions;
/// those at the edge have loops of their own. The volume of liquid that crossed a face is not added
/// up: as long as coefficients stay, it follows from the ways of its nodes.
///
/// What comes next should be near in memory, as it is where nodes and elements are numbered in rows
/// across the model; in the order that Gmsh numbers large meshes a step takes three times as long.
template <int Dim>
class ExplicitNodal {
  static_assert(Dim == 2, "faces are edges here: their normal is the edge, turned");

 public:
  ExplicitNodal(const NodalOperator<Dim>& op, ExplicitSettings settings);

  /// New coefficients (the operator's update comes first). Resets volumes, which are those of one
  /// set of coefficients.
  void update(const FlowCoefficients<Dim>& coefficients);

  /// One step of `dt` seconds.
  void step(double dt);

  void set_pressure(std::vector<double> pressure) { pressure_ = std::move(pressure); }
  void set_velocity(VectorField<Dim> velocity) {
    rewrite([&](VectorField<Dim>& own, std::vector<double>&) { own = std::move(velocity); });
  }
  /// The same in place, for whoever carries the flow from step to step: `write(velocity,
  /// pressure)`.
  template <class Write>
  void rewrite(const Write& write) {
    remember_velocity();
    write(velocity_, pressure_);
    operator_.constrain(velocity_);
    take_velocity();
  }

  [[nodiscard]] const std::vector<double>& pressure() const { return pressure_; }
  /// At half a step before the time of the pressure. Formed when first asked for after a step,
  /// which is not for several threads at once.
  [[nodiscard]] const VectorField<Dim>& velocity() const;
  /// To be called before a step of which `previous_velocity` or `velocity_at` will be asked; the
  /// functions that set a velocity do so.
  void remember_velocity() { static_cast<void>(velocity()); }
  /// What the last step began with. Throws std::logic_error if nobody had it remembered.
  [[nodiscard]] const VectorField<Dim>& previous_velocity() const;
  /// Velocity `ahead` seconds after the middle of the last step, on the line through the last two.
  [[nodiscard]] VectorField<Dim> velocity_at(double ahead) const;

  /// Between steps, with the coefficients of the moment: pressures and velocities, not volumes.
  void archive(StateArchive& archive);

  /// Volumes since the last `reset_volumes`. Without `density_excess` where the pressure moves with
  /// the liquid.
  [[nodiscard]] FaceVolumes volumes() const;
  /// Integral of each node's velocity since then, m; empty unless asked for.
  [[nodiscard]] VectorField<Dim> displacements() const;
  void reset_volumes();

  /// The two halves of a step, for those who measure them: velocities over `spacing` seconds, then
  /// `dt` seconds of motion with them; and the pressures after that motion.
  void accelerate(double spacing, double dt);
  void compress(double dt);

  /// Bytes that the halves of a step read and write per step, each array once, what is
  /// written over twice; without boundary conditions, and what fast flow and gravity add.
  [[nodiscard]] double bytes_accelerating() const;
  [[nodiscard]] double bytes_compressing() const;

 private:
  /// A few inner nodes. What steps write lies apart: memory takes back whole lines.
  struct NodeBlock {
    SimdDouble4 mobility;  ///< n_i / (S m_i), 1/kg
    SimdDouble4 damping;   ///< d_i / (S m_i), 1/s
    std::array<int, simd_width> node;
    int first_step;  ///< where the ways around them are in `ring_steps_`
    int last_step;
  };
  /// One step further around each node of a block, counterclockwise: its neighbour, and the element
  /// that follows. Those with fewer neighbours stay where they are in the end.
  struct RingStep {
    std::array<int, simd_width> node;
    std::array<int, simd_width> element;
  };
  /// A node with a face at the boundary, or that fills no block.
  struct BoundaryNode {
    int node;
    int constraint;  ///< of the operator's, -1: none
    double mobility;
    double damping;
    double quadratic_damping;
    Vector<Dim> way;
  };
  template <class Quantity>
  using OfFaces = std::array<Quantity, Dim + 1>;
  /// A few elements.
  struct ElementBlock {
    SimdDouble4 weight;  ///< 1 / water volume (times n_e without the third term), 1/m3
    OfFaces<std::array<int, simd_width>> node;
  };
  /// What convection asks of the same.
  struct ConvectionBlock {
    OfFaces<SimdDouble4> carried;  ///< (1 - c) / K of each face, 1/Pa
    OfFaces<std::array<int, simd_width>> neighbour;
  };
  /// An element with a face at the boundary, or that fills no block.
  struct BoundaryElement {
    int element;
    double weight;
    OfFaces<double> carried;
    OfFaces<double> excess_out;
  };

  void make_node_blocks();
  void make_element_blocks();
  void set_node_coefficients();
  void set_element_coefficients(const FlowCoefficients<Dim>& coefficients);
  void accelerate_block(double spacing, double dt, int b);
  void accelerate_edge(double spacing, double dt, BoundaryNode& edge);
  /// Integral of each node's flux since `reset_volumes`, m.
  [[nodiscard]] VectorField<Dim> ways() const;
  /// Fluxes from velocities.
  void take_velocity();
  template <bool convects>
  void compress_blocks(double dt);
  template <bool convects>
  void compress_block(double dt, int b);
  void compress_edge(double dt, BoundaryElement& edge);
  [[nodiscard]] double face_flux(int element, int k) const;

  const NodalOperator<Dim>& operator_;
  ExplicitSettings settings_;
  std::vector<double> pressure_;       ///< per element, Pa
  std::vector<double> next_pressure_;  ///< of the step that is being made
  VectorField<Dim> flux_;              ///< per node, q_i = n_i v_i, m/s
  std::vector<double> porosity_;       ///< per node, n_i (1 without the third term)
  mutable VectorField<Dim> velocity_;  ///< m/s
  mutable bool velocity_is_current_ = true;
  VectorField<Dim> previous_velocity_;  ///< empty unless remembered
  double last_dt_ = 0.0;
  double velocity_spacing_ = 0.0;  ///< time between the last two velocities, s

  bool has_gravity_;
  std::vector<NodeBlock> node_blocks_;
  std::vector<std::array<SimdDouble4, Dim>> way_;  ///< integral of the flux, as `node_blocks_`, m
  std::vector<SimdDouble4>
      quadratic_damping_;  ///< what fast flow adds per |q_i|, 1/m; may be empty
  std::vector<RingStep> ring_steps_;
  std::vector<BoundaryNode> edge_nodes_;
  std::vector<ElementBlock> element_blocks_;
  std::vector<ConvectionBlock> convection_blocks_;  ///< as `element_blocks_`; may be empty
  std::vector<OfFaces<SimdDouble4>> excess_out_;
  std::vector<BoundaryElement> edge_elements_;
  std::vector<int> driven_faces_;  ///< with a prescribed flux
  std::vector<double> driven_volume_;
};

}  // namespace suffuse
