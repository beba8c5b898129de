#include "flow/explicit_flow.hpp"
#include "flow/flow_solver.hpp"
#include "flow/implicit_flow.hpp"

namespace suffuse {

template <int Dim>
std::unique_ptr<FlowSolver<Dim>> make_flow(const Case<Dim>& c, const Grid<Dim>& grid,
                                           const Skeleton<Dim>& solid, const FlowOptions& options) {
  if (c.document.scene.time.scheme == FlowScheme::implicit_mixed) {
    return std::make_unique<ImplicitFlow<Dim>>(c, grid, solid, options);
  }
  return std::make_unique<ExplicitFlow<Dim>>(c, grid, solid, options);
}

template std::unique_ptr<FlowSolver<2>> make_flow(const Case<2>&, const Grid<2>&,
                                                  const Skeleton<2>&, const FlowOptions&);

}  // namespace suffuse
