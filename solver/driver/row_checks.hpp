#pragma once

/// Checks whether the values of each row of the history are within the validity of the model.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "files/tables.hpp"
#include "results/state_archive.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Limits for the values of rows that depend on the case.
struct RowLimits {
  /// Only with inertia: speed above which liquid crosses the model before drag makes it steady,
  /// m/s. The equations lack the convected momentum of such liquid.
  double speed_that_drag_follows = std::numeric_limits<double>::infinity();
  /// Only for soil that can yield: motion in equilibrium above which there is a warning, m.
  double watched_motion = std::numeric_limits<double>::infinity();
  /// Implicit only, without inertia: number of elements with an obtuse angle, which can cause
  /// pressures outside the range of the boundaries.
  std::optional<int> obtuse_elements = {};
};

class RowChecks {
 public:
  /// Keeps a reference to the scene.
  explicit RowChecks(const Scene& scene, RowLimits limits = {}) : scene_(scene), limits_(limits) {}

  /// Returns new warnings; each is given once in a run, that of a failure once per failure. Throws
  /// NumericalError if an entry is not finite or a pressure exceeds the liquid's bulk modulus.
  std::vector<std::string> check(const HistoryRow& row);

  void archive(StateArchive& archive) { archive(is_said_, failure_warned_, falls_); }

 private:
  static constexpr std::size_t kinds = 8;

  std::string check_compression(const HistoryRow& row);
  std::string check_mass_scaling(double speed);
  std::string check_momentum(double speed);
  std::string check_fines_weight(const HistoryRow& row);
  std::string check_packing(const HistoryRow& row);
  std::string check_volume_defect(const HistoryRow& row);
  std::string check_overshoot(const HistoryRow& row);
  std::string check_creep(const HistoryRow& row);
  std::string check_failure(const HistoryRow& row);

  const Scene& scene_;
  RowLimits limits_;
  std::array<char, kinds> is_said_ = {};  ///< the warnings that are given once
  double failure_warned_ = 0.0;           ///< time of the last reported failure, s
  bool falls_ = false;  ///< soil that has failed was not at rest yet in the last row
};

}  // namespace suffuse
