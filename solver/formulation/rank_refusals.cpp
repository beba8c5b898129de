#include "formulation/rank_refusals.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "common/errors.hpp"
#include "formulation/two_phase_model.hpp"

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
  refuse(scene.formulation == Formulation::double_point, "formulation", "\"double-point\"",
         "\"single-point\"");
  const bool is_explicit = scene.time.scheme == FlowScheme::explicit_nodal;
  refuse(is_explicit && scene.initial_flow == InitialFlow::steady, "initial.flow",
         "\"steady\" with the explicit scheme", "\"rest\"");
  refuse(scene.mesh.error.has_value(), "mesh.error", "bounds of discharges", "no such key");
  refuse(!scene.initial_from.empty(), "initial.from", "a run", "no run");
  refuse(!scene.output.sections.empty(), "output.section", "sections", "no sections");
  const bool leaks =
      std::ranges::any_of(scene.walls, [](const Wall& w) { return w.conductance > 0.0; });
  refuse(leaks, "wall", "walls that let liquid through", "walls without a conductance");
  refuse(scene.moves(), "soil", "soil that moves", "soil at rest");
  if (!problems.empty()) throw InputError(std::move(problems));
}

template void refuse_on_ranks(const Case<2>&);
template void refuse_on_ranks(const Case<3>&);

}  // namespace suffuse
