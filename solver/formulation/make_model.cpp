#include "common/errors.hpp"
#include "explicit/explicit_flow.hpp"
#include "flow/implicit_flow.hpp"
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

template <int Dim>
std::unique_ptr<FlowSolver<Dim>> make_flow(const Case<Dim>& c, const Grid<Dim>& grid,
                                           const Skeleton<Dim>& solid, const FlowOptions& options) {
  if (c.document.scene.time.scheme == FlowScheme::implicit_mixed) {
    return std::make_unique<ImplicitFlow<Dim>>(c, grid, solid, options);
  }
  check_scheme(c);
  if constexpr (Dim == 2) {
    return std::make_unique<ExplicitFlow<Dim>>(c, grid, solid, options);
  } else {
    return nullptr;  // check_scheme has thrown
  }
}

template <int Dim>
void check_scheme(const Case<Dim>& c) {
  if (Dim == 2 || c.document.scene.time.scheme == FlowScheme::implicit_mixed) return;
  throw InputError(
      InputProblem{c.document.locate("time.scheme"), "time.scheme", "\"explicit\"",
                   "\"implicit\": the explicit scheme is for meshes of triangles alone"});
}

template void check_scheme(const Case<2>&);
template void check_scheme(const Case<3>&);

template std::unique_ptr<FlowSolver<2>> make_flow(const Case<2>&, const Grid<2>&,
                                                  const Skeleton<2>&, const FlowOptions&);
template std::unique_ptr<FlowSolver<3>> make_flow(const Case<3>&, const Grid<3>&,
                                                  const Skeleton<3>&, const FlowOptions&);

}  // namespace suffuse
