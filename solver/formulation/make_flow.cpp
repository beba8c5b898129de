#include "common/errors.hpp"
#include "explicit/explicit_flow.hpp"
#include "flow/flow_solver.hpp"
#include "flow/implicit_flow.hpp"

namespace suffuse {

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
