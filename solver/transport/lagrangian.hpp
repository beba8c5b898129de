#pragma once

/// Moves the liquid points of the double-point formulation: along the flux, in through boundaries
/// and out through them.

#include "flow/face_conditions.hpp"
#include "grid/face_walk.hpp"
#include "transport/fines_uptake.hpp"
#include "transport/liquid_points.hpp"

namespace suffuse {

/// Liquid at the outer boundary, between volumes that flow and points that are whole.
struct InflowAccount {
  /// Per face: what flowed in, less the points born of it, plus the points that left, m3. Once it
  /// is a point's volume and the flow is inward, a point is born.
  std::vector<double> volume;
  std::vector<long> born;  ///< points so far, per face
  long next_id = 0;

  void archive(auto& archive) { archive(volume, born, next_id); }
};

/// A point that changed its region; -1 is outside.
struct PointCrossing {
  int from;
  int to;
  double water_mass;  ///< kg
  double fines_mass;  ///< kg
};

/// Flux over one interval.
template <int Dim>
struct LiquidMotion {
  /// Mean over the interval, m/s. Empty where points follow the volumes through faces.
  std::vector<Vector<Dim>> node_flux;
  std::vector<double> entered;  ///< per face, liquid volume along its normal, m3
  double duration = 0.0;        ///< s

  void archive(auto& archive) { archive(node_flux, entered, duration); }
  [[nodiscard]] bool along_faces() const { return node_flux.empty(); }
};

/// Points that have gone their way, the new ones at the end; those that left are still among them,
/// in their last element.
template <int Dim>
struct WalkedPoints {
  std::vector<int> from;       ///< region at the beginning, -1: outside
  std::vector<int> left_by;    ///< outer face, -1: none
  std::vector<double> grains;  ///< of each point before it took any, kg
  std::vector<FinesUptake<Dim>> takes;
};

/// A point that comes in.
template <int Dim>
struct InjectedPoint {
  PointPlace<Dim> place;
  int face;
  long number;   ///< among the points of its face
  double share;  ///< of the interval that had passed
};

/// How new points are spread over the liquid that enters.
struct InjectionSettings {
  std::vector<double> point_volume;  ///< per face: liquid volume of one point, m3
  /// Per face: points that fill the element behind it.
  std::vector<int> points_per_element;
  /// Each element's worth of points at random in the liquid that fills it; else evenly.
  bool random = false;
  int seed = 1;
};

template <int Dim>
class LagrangianTransport {
 public:
  LagrangianTransport(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                      InjectionSettings births, LiquidDensities densities, double bulk_modulus,
                      int threads);

  /// The state of `entering` before anything came in. Faces take turns.
  [[nodiscard]] InflowAccount nothing_entered(long next_id) const;

  /// Outer faces that are not impervious, ascending: where points come in and leave.
  [[nodiscard]] const std::vector<int>& open_faces() const { return open_faces_; }
  [[nodiscard]] const std::vector<unsigned char>& is_open() const { return open_face_; }

  /// Puts into `born` the points whose volume has come in, in the order in which it was complete: a
  /// look at part of the interval numbers them the same.
  void births(InflowAccount& entering, const LiquidMotion<Dim>& motion,
              std::vector<InjectedPoint<Dim>>& born) const;
  /// What a point brings along: the concentration of its boundary, and the water that its element's
  /// pressure packs into its volume.
  struct Content {
    double water_mass;  ///< kg
    double fines_mass;  ///< kg
  };
  [[nodiscard]] Content content(const InjectedPoint<Dim>& newborn, double element_pressure) const;

  /// Share of the motion after which erosion and transport must take turns: when some point may
  /// have crossed a quarter of an element by node fluxes, a whole one by face volumes.
  [[nodiscard]] double share_allowed(const LiquidMotion<Dim>& motion,
                                     const std::vector<double>& porosity) const;

  /// Moves every point, lets new ones in and takes out those that leave; points stay sorted. New
  /// points carry the concentration of their boundary, the water that
  /// their element's pressure packs into their volume, and, where points carry the flow, the
  /// pressure of their element and the velocity of its nodes. Returns who changed region.
  std::vector<PointCrossing> move(LiquidPoints<Dim>& points, InflowAccount& entering,
                                  const LiquidMotion<Dim>& motion,
                                  const std::vector<double>& porosity,
                                  const std::vector<double>& element_pressure,
                                  const std::vector<Vector<Dim>>& node_velocity) const;

  /// Moves every point along the face volumes, new ones from the moment at which they come in, and
  /// those that leave until then, while porosity goes from `porosity_begin` to `porosity_end`
  /// (per element). Tells what each takes up on its way; nothing is handed out yet.
  WalkedPoints<Dim> follow(LiquidPoints<Dim>& points, InflowAccount& entering,
                           const LiquidMotion<Dim>& motion,
                           const std::vector<double>& porosity_begin,
                           const std::vector<double>& porosity_end,
                           const std::vector<double>& element_pressure) const;

  /// After `follow`, once points have their grains: takes out those that left; points are sorted.
  /// Returns who changed region. What a point took in the region that it came from it carries
  /// across, the rest it receives where it goes; one that leaves the model first crosses into its
  /// last region.
  std::vector<PointCrossing> settle(LiquidPoints<Dim>& points, InflowAccount& entering,
                                    const WalkedPoints<Dim>& walked) const;

 private:
  [[nodiscard]] WalkField<Dim> field(const LiquidMotion<Dim>& motion,
                                     const std::vector<double>& porosity) const {
    return {motion.node_flux, porosity, open_face_};
  }
  /// How many points' volumes must have come in through a face for its point `number` to be born.
  [[nodiscard]] double volumes_at_birth(int face, long number) const;
  [[nodiscard]] PointPlace<Dim> place_on_face(int face, long number,
                                              const LiquidMotion<Dim>& motion) const;
  void admit(LiquidPoints<Dim>& points, InflowAccount& entering, const InjectedPoint<Dim>& newborn,
             const std::vector<double>& element_pressure) const;

  const Grid<Dim>& grid_;
  const std::vector<FaceCondition>& conditions_;
  InjectionSettings births_;
  std::vector<unsigned char> open_face_;
  std::vector<int> open_faces_;
  LiquidDensities densities_;
  double bulk_modulus_;
  int threads_;
};

}  // namespace suffuse
