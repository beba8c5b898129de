#include "formulation/double_point.hpp"
#include "formulation/single_point.hpp"

namespace suffuse {

template <int Dim>
std::unique_ptr<TwoPhaseModel<Dim>> make_model(const Case<Dim>& c, const ModelOptions& options) {
  if (c.document.scene.formulation == Formulation::single_point) {
    return std::make_unique<SinglePoint<Dim>>(c, options);
  }
  return std::make_unique<DoublePoint<Dim>>(c, options);
}

template std::unique_ptr<TwoPhaseModel<2>> make_model(const Case<2>&, const ModelOptions&);
template std::unique_ptr<TwoPhaseModel<3>> make_model(const Case<3>&, const ModelOptions&);

}  // namespace suffuse
