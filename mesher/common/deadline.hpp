#pragma once

/// A wall time at which a thread must stop, even within a step. Loops over a mesh
/// (grid/parallel.hpp) check it before they start. Runs have no deadline.

#include <chrono>
#include <optional>

namespace suffuse {

/// Thrown when the deadline has passed. Results of the computation are incomplete and must not be
/// used. It is not derived from other exceptions, so that handlers of errors do not catch it.
struct DeadlinePassed {};

/// Sets the deadline of this thread during its lifetime.
class Deadline {
 public:
  explicit Deadline(double seconds) : outer_(moment) {
    const std::chrono::duration<double> left(seconds);
    moment = Clock::now() + std::chrono::duration_cast<Clock::duration>(left);
  }
  ~Deadline() { moment = outer_; }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  /// Throws DeadlinePassed once the deadline has passed.
  static void check() {
    if (moment && Clock::now() >= *moment) throw DeadlinePassed();
  }

 private:
  using Clock = std::chrono::steady_clock;

  static inline thread_local std::optional<Clock::time_point> moment;
  std::optional<Clock::time_point> outer_;
};

}  // namespace suffuse
