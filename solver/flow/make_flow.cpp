#include "flow/mixed_flow.hpp"
#include "flow/nodal_flow.hpp"
#include "flow/scene_flow.hpp"

namespace suffuse {

template <int Dim>
std::unique_ptr<SceneFlow<Dim>> make_flow(const Case<Dim>& c, const Grid<Dim>& grid,
                                          const RigidSkeleton<Dim>& skeleton,
                                          const FlowOptions& options) {
  if (c.document.scene.time.scheme == FlowScheme::implicit_mixed) {
    return std::make_unique<MixedFlow<Dim>>(c, grid, skeleton, options);
  }
  return std::make_unique<NodalFlow<Dim>>(c, grid, skeleton, options);
}

template std::unique_ptr<SceneFlow<2>> make_flow(const Case<2>&, const Grid<2>&,
                                                 const RigidSkeleton<2>&, const FlowOptions&);

}  // namespace suffuse
