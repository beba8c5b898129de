#pragma once

/// Moves liquid and the fines in it with the flow, and lets them exchange fines with the solid.
/// Three strategies share this interface: a field on the mesh, points along the volumes that cross
/// faces, and points that carry the flow themselves. The move itself returns what crossed borders:
/// volumes through faces (FieldTransport), or points (PointTransport).

#include <vector>

#include "flow/flow_solver.hpp"

namespace suffuse {

/// A step of transport: a part of an interval of the flow.
struct TransportStep {
  double start = 0.0;  ///< s
  double end = 0.0;    ///< s
  double share = 1.0;  ///< of the volumes that cross faces in the interval
};

template <int Dim>
class Transport {
 public:
  Transport() = default;
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  /// Longest step of transport at these volumes through faces per second (m3/s, along each face's
  /// normal), s.
  [[nodiscard]] virtual double longest_step(const std::vector<double>& face_rate) const = 0;
  /// Longest step of explicit transport at these volumes, s.
  [[nodiscard]] virtual double longest_explicit_step(const std::vector<double>& face_rate) const {
    return longest_step(face_rate);
  }
  /// How far the flow may go ahead of this.
  struct Coupling {
    double steps;        ///< of transport, where the flow could go any length by itself
    double pore_growth;  ///< relative, where the flow does not forecast the pores
  };
  [[nodiscard]] virtual Coupling coupling() const = 0;

  virtual void archive(StateArchive& archive) = 0;
  /// What this cost, for run.json.
  [[nodiscard]] virtual std::vector<PassTiming> passes() const = 0;
};

/// Share of its limit that a step of transport takes.
inline constexpr double transport_safety = 0.9;

/// An interval in `count` equal steps.
std::vector<TransportStep> equal_steps(double start, double end, double count);

/// Number of steps over an interval when one may be the share `allowed` of it (safety included).
/// Rounds down within 1 %, which the safety covers: intervals are often cut to whole steps.
double step_count(double allowed);

}  // namespace suffuse
