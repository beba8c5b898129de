#include "driver/rank_refusals.hpp"

#include <algorithm>

#include "common/errors.hpp"

namespace suffuse {

template <int Dim>
void refuse_on_ranks(const Case<Dim>& c) {
  const Scene& scene = c.document.scene;
  std::vector<InputProblem> problems;
  const auto refuse = [&](bool found, const std::string& key, const std::string& what,
                          const std::string& instead) {
    if (!found) return;
    problems.push_back({c.document.locate(key), key, what + " on several ranks",
                        instead + ", or one process: suffuse-solver", ""});
  };
  refuse(scene.flow.integration == PressureIntegration::material_point, "flow.integration",
         "\"material-point\"", "\"mixed\"");
  refuse(
      scene.time.scheme == FlowScheme::explicit_nodal && scene.initial_flow == InitialFlow::steady,
      "initial.flow", "\"steady\" with the explicit scheme", "\"rest\"");
  refuse(scene.mesh.error.has_value(), "mesh.error", "bounds of discharges", "no such key");
  refuse(std::ranges::any_of(scene.walls, &Wall::conductance), "wall",
         "walls that let liquid through", "walls without a conductance");
  refuse(scene.moves(), "soil", "soil that moves", "soil at rest");
  if (!problems.empty()) throw InputError(std::move(problems));
}

template void refuse_on_ranks(const Case<2>&);
template void refuse_on_ranks(const Case<3>&);

}  // namespace suffuse
