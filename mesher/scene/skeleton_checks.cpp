#include "scene/skeleton_checks.hpp"

#include <algorithm>

#include "physics/head.hpp"
#include "scene/law_texts.hpp"
#include "scene/scene_check_base.hpp"

namespace suffuse {
namespace {

class SkeletonChecks : private SceneCheckBase {
 public:
  using SceneCheckBase::SceneCheckBase;

  void run() const {
    for (const Soil& soil : scene_.soils) check_soil(soil, table_of(soil) + ".skeleton");
    for (const BoundaryCondition& boundary : scene_.boundaries) check_boundary(boundary);
    check_start();
    check_failure();
    if (!scene_.moves()) return;
    check_scheme();
    check_inertia();
  }

 private:
  void check_soil(const Soil& soil, const std::string& table) const {
    const std::string law_key = table + ".law";
    for (const std::string& name : scene_children("soil.*.skeleton")) {
      if (!given(joined(table, name))) continue;
      require(law_key, "soil.*.skeleton.law", "as " + name + " is given", joined(table, name));
      break;
    }
    if (!given(law_key) || refused(law_key)) return;
    const SkeletonLaw* law = soil.skeleton.law;
    for (const SkeletonParameter& parameter : skeleton_parameters()) {
      const std::string key = joined(table, std::string(parameter.key));
      std::vector<std::string> laws = laws_with_skeleton_parameter(parameter.key);
      const bool asks = law && std::ranges::find(laws, law->word) != laws.end();
      if (asks && parameter.required) {
        require(key, "soil.*.skeleton." + std::string(parameter.key),
                "for law = " + shown_value(std::string(law->word)), law_key);
      } else if (!asks && own(key)) {
        for (std::string& word : laws) word = shown_value(word);
        report(key, "a key of another law", "law = " + listed(laws) + ", or no such key",
               {law_key});
      }
    }
    check_dilation(soil.skeleton, table);
  }

  /// Refuses an angle of dilation above that of friction, which would produce energy.
  void check_dilation(const SkeletonModel& skeleton, const std::string& table) const {
    const std::string key = table + ".dilation";
    const std::string other = table + ".friction";
    if (!given(key) || refused(key) || !given(other) || refused(other)) return;
    if (skeleton.dilation.smallest() <= skeleton.friction.smallest()) return;
    report(key, "psi = " + shown_number(skeleton.dilation.smallest()),
           "psi <= phi = " + shown_number(skeleton.friction.smallest()) + " degrees", {other});
  }

  void check_boundary(const BoundaryCondition& boundary) const {
    const std::string fix = joined(boundary.key, "fix");
    const std::string traction = joined(boundary.key, "traction");
    if (given(traction) && !refused(traction) && boundary.fix == Fixing::both) {
      report(traction, "a traction where the soil cannot move, fix = \"both\"",
             "no traction, or fix = \"normal\" or \"none\"", {fix});
    }
    refuse_of_rigid({fix, traction});
  }

  /// Refuses keys that have no effect if all skeletons are rigid.
  void refuse_of_rigid(const std::vector<std::string>& keys) const {
    const bool unknown = std::ranges::any_of(scene_.soils, [&](const Soil& soil) {
      const std::string table = table_of(soil) + ".skeleton";
      return given(table) && (!given(table + ".law") || refused(table + ".law"));
    });
    if (scene_.moves() || unknown) return;
    for (const std::string& key : keys) {
      if (!given(key)) continue;
      report(key, "a key of skeletons that move where all are rigid",
             "a soil with a law under [soil.NAME.skeleton], or no such key");
    }
  }

  void check_start() const {
    const std::string key = "initial.stress";
    refuse_of_rigid({key});
    if (scene_.earth_pressure && !has_gravity(scene_.gravity) && !refused("gravity")) {
      report(key, "K_0 = " + shown_number(*scene_.earth_pressure) + " without gravity",
             "gravity, as in gravity = [0.0, -9.81], or no such key", {"gravity"});
    }
  }

  void check_failure() const {
    const std::string key = "output.failure_every";
    refuse_of_rigid({key});
    if (!given(key) || !scene_.moves() || scene_.time.failure != AtFailure::stop) return;
    report(key, "a key of failures that are followed, where the run stops at one",
           "time.failure = \"follow\", or no such key", {"time.failure"});
  }

  /// Refuses the explicit scheme: waves of 1500 m/s in the soil would make its steps too short.
  void check_scheme() const {
    if (scene_.time.scheme != FlowScheme::explicit_nodal || refused("time.scheme")) return;
    for (const Soil& soil : scene_.soils) {
      if (!soil.skeleton.moves()) continue;
      report(table_of(soil) + ".skeleton.law",
             shown_value(std::string(soil.skeleton.law->word)) + " with scheme = \"explicit\"",
             "\"rigid\", or scheme = \"implicit\"", {"time.scheme"});
    }
  }

  /// Refuses inertia of the flow: it is relative to the soil and would start and stop with it.
  void check_inertia() const {
    if (!scene_.time.inertia.value_or(false)) return;
    report("time.inertia", "true with a skeleton that moves",
           "false, or no such key: soil that fails has inertia, and the liquid with it");
  }
};

}  // namespace

void check_skeletons(const Scene& scene, const SceneInquiry& inquiry) {
  SkeletonChecks(scene, inquiry).run();
}

}  // namespace suffuse
