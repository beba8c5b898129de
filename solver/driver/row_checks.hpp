#pragma once

/// Checks whether the values of each row of the history are within the validity of the model.

#include <optional>
#include <string>
#include <vector>

#include "files/tables.hpp"
#include "results/state_archive.hpp"
#include "scene/scene.hpp"

namespace suffuse {

class RowChecks {
 public:
  /// Keeps a reference to the scene. `speed_that_drag_follows`, m/s, and `obtuse_elements` come
  /// from the plan.
  RowChecks(const Scene& scene, double speed_that_drag_follows,
            std::optional<int> obtuse_elements = {})
      : scene_(scene),
        speed_that_drag_follows_(speed_that_drag_follows),
        obtuse_elements_(obtuse_elements) {}

  /// Returns new warnings; each is given once in a run, that of a failure once per failure. Throws
  /// NumericalError if an entry is not finite or a pressure exceeds the liquid's bulk modulus.
  std::vector<std::string> check(const HistoryRow& row);

  void archive(StateArchive& archive) {
    archive(scaling_warned_, momentum_warned_, compression_warned_, weight_warned_, defect_warned_,
            overshoot_warned_, packing_warned_, failure_warned_, falls_);
  }

 private:
  std::string check_compression(const HistoryRow& row);
  std::string check_mass_scaling(double speed);
  std::string check_momentum(double speed);
  std::string check_fines_weight(const HistoryRow& row);
  std::string check_packing(const HistoryRow& row);
  std::string check_volume_defect(const HistoryRow& row);
  std::string check_overshoot(const HistoryRow& row);
  std::string check_failure(const HistoryRow& row);

  const Scene& scene_;
  double speed_that_drag_follows_;
  std::optional<int> obtuse_elements_;
  bool scaling_warned_ = false;
  bool momentum_warned_ = false;
  bool compression_warned_ = false;
  bool weight_warned_ = false;
  bool defect_warned_ = false;
  bool overshoot_warned_ = false;
  bool packing_warned_ = false;
  double failure_warned_ = 0.0;  ///< time of the last reported failure, s
  bool falls_ = false;           ///< soil that has failed was not at rest yet in the last row
};

}  // namespace suffuse
