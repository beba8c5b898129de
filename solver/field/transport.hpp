#pragma once

/// Moves liquid and its fines with the flow, and exchanges fines with the solid. Three strategies
/// share this interface: a field on the mesh, points that follow the volumes through faces, and
/// points that carry the flow. Their functions `move` return what crossed borders: volumes through
/// faces (FieldTransport), or points (PointTransport).

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
  /// Limits of the interval of the flow between two calls of transport.
  struct Coupling {
    double steps;        ///< of transport, if the flow allows several in an interval
    double pore_growth;  ///< relative, if the flow does not forecast the pores
  };
  [[nodiscard]] virtual Coupling coupling() const = 0;

  virtual void archive(StateArchive& archive) = 0;
  /// Cost of transport, for run.json.
  [[nodiscard]] virtual std::vector<PassTiming> passes() const = 0;
};

/// Safety factor on the limit of a step of transport.
inline constexpr double transport_safety = 0.9;

/// Divides an interval into `count` equal steps.
std::vector<TransportStep> equal_steps(double start, double end, double count);

/// Most steps of transport in an interval, and what to do about more.
struct StepCountLimit {
  double most;
  const char* advice;
};

/// Number of steps from `start` to `end`, s, if a step may be the share `allowed` of this time
/// (safety included).
/// Rounds down within 1 %, which the safety covers: intervals are often whole steps. Throws
/// NumericalError if there are more than the limit, or if `allowed` is not a positive number.
double step_count(double allowed, double start, double end, const StepCountLimit& limit);

}  // namespace suffuse
