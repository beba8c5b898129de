#pragma once

/// The last bounds that were found. A steady flow has the same in each row of the tables.

#include <optional>
#include <vector>

#include "bounds/discharge_bounds.hpp"

namespace suffuse {

template <int Dim>
class KeptBounds {
 public:
  /// As `discharge_bounds`; found anew only if something has changed. Throws NumericalError.
  const DischargeBounds& find(const SeepageState<Dim>& state) {
    std::vector<std::vector<double>> now = {state.face_pressure,         state.face_flux,
                                            state.coefficients.porosity, state.coefficients.drag,
                                            state.step.face_flux,        state.step.face_pressure,
                                            state.step.conductivity};
    if (!bounds_ || now != depends_on_) {
      bounds_ = discharge_bounds(state);
      depends_on_ = std::move(now);
    }
    return *bounds_;
  }

 private:
  std::vector<std::vector<double>> depends_on_;  ///< what may have changed
  std::optional<DischargeBounds> bounds_;
};

}  // namespace suffuse
