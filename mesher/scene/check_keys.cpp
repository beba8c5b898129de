#include "scene/check_keys.hpp"

#include "scene/scene_declaration.hpp"

namespace suffuse {
namespace {

using namespace declaration;
using Backward = BackwardErosionSettings;
using Blanket = BlanketSettings;

template <class Member>
auto in_backward_erosion(Member Backward::*member) {
  return at(&Scene::check, &CheckSettings::backward_erosion, member);
}

template <class Member>
auto in_blanket(Member Blanket::*member) {
  return at(&Scene::check, &CheckSettings::blanket, member);
}

auto of_heave(double PartialFactors::*member) {
  return at(&Scene::check, &CheckSettings::heave, member);
}

auto of_uplift(double PartialFactors::*member) {
  return [=](Scene& scene, std::size_t) -> double& { return scene.check.uplift.factors.*member; };
}

Declaration partial_factor(const char* pattern,
                           const std::function<double&(Scene&, std::size_t)>& at,
                           const char* sentence, const char* symbol, double standard) {
  return key(pattern, at, sentence).named(symbol).above(0.0).at_most(10.0).otherwise(standard);
}

Declaration aquifer_end(const char* pattern, AquiferEnd Blanket::*member, const char* sentence) {
  return choice(pattern, in_blanket(member),
                {{"infinite", AquiferEnd::infinite},
                 {"open", AquiferEnd::open},
                 {"closed", AquiferEnd::closed}},
                sentence)
      .otherwise("infinite");
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): one list, which is read from top to bottom
std::vector<SceneKey> check_keys() {
  const PartialFactors heave = CheckSettings{}.heave;
  const PartialFactors uplift = UpliftSettings{}.factors;
  return {
      partial_factor("check.heave.destabilising", of_heave(&PartialFactors::destabilising),
                     "Partial factor on pore pressure and seepage force in the check against "
                     "hydraulic heave (EN 1997-1, 2.9a and 2.9b).",
                     "gamma_G;dst", heave.destabilising),
      partial_factor("check.heave.stabilising", of_heave(&PartialFactors::stabilising),
                     "Partial factor on the weight of the soil in this check.", "gamma_G;stb",
                     heave.stabilising),

      key(
          "check.uplift.cover",
          [](Scene& scene, std::size_t) -> std::string& { return scene.check.uplift.cover; },
          "Region at the ground that water lifts if it presses on its base with more than its "
          "weight (EN 1997-1, 2.8).")
          .otherwise_as("uplift is not checked"),
      partial_factor("check.uplift.destabilising", of_uplift(&PartialFactors::destabilising),
                     "Partial factor on the pressure at the base of the cover.", "gamma_G;dst",
                     uplift.destabilising),
      partial_factor("check.uplift.stabilising", of_uplift(&PartialFactors::stabilising),
                     "Partial factor on the weight of the cover.", "gamma_G;stb",
                     uplift.stabilising),

      key("check.backward_erosion.layer", in_backward_erosion(&Backward::layer),
          "Region of sand in which a pipe can grow below a roof. In two dimensions.")
          .otherwise_as("backward erosion is not checked"),
      key("check.backward_erosion.entry", in_backward_erosion(&Backward::entry),
          "Boundary through which water enters the layer.")
          .otherwise_as("required with `layer`"),
      key("check.backward_erosion.exit", in_backward_erosion(&Backward::exit),
          "Boundary at which the pipe begins.")
          .otherwise_as("required with `layer`"),
      key("check.backward_erosion.length", in_backward_erosion(&Backward::length),
          "Length of the seepage path.")
          .named("L")
          .in("m")
          .above(0.0)
          .otherwise_as("the level distance of the faces of the layer at `entry` from those at "
                        "`exit`"),
      key("check.backward_erosion.thickness", in_backward_erosion(&Backward::thickness),
          "Thickness of the layer.")
          .named("D")
          .in("m")
          .above(0.0)
          .otherwise_as("the mean height of the layer between `entry` and `exit`"),
      key("check.backward_erosion.d70", in_backward_erosion(&Backward::d70),
          "Size, in mm as in `gradation`, of which 70 % of the grains of the layer are finer.")
          .named("d70")
          .above(0.0)
          .at_most(100.0)
          .otherwise_as("that of the layer's `gradation`, without which it is required"),
      key("check.backward_erosion.uniformity", in_backward_erosion(&Backward::uniformity),
          "Coefficient of uniformity, d60/d10.")
          .named("U")
          .at_least(1.0)
          .otherwise_as("that of the layer's `gradation`, or 1.81, the mean of the tests"),
      key("check.backward_erosion.roundness", in_backward_erosion(&Backward::roundness),
          "Roundness of the grains, per cent; by default the mean of the tests.")
          .named("KAS")
          .above(0.0)
          .at_most(100.0)
          .otherwise(Backward{}.roundness),
      key("check.backward_erosion.relative_density",
          in_backward_erosion(&Backward::relative_density),
          "Relative density of the layer, per cent; by default the mean of the tests.")
          .named("RD")
          .above(0.0)
          .at_most(100.0)
          .otherwise(Backward{}.relative_density),
      key("check.backward_erosion.grain_size_correction",
          in_backward_erosion(&Backward::grain_size_correction),
          "Keep the last factor of F_S, (0.208 mm / d70)^0.6.")
          .otherwise(true),

      key("check.blanket.aquifer", in_blanket(&Blanket::aquifer),
          "Region that conducts water below the cover. In two dimensions.")
          .otherwise_as("blanket theory is left out"),
      key("check.blanket.cover", in_blanket(&Blanket::cover),
          "Region on top of the aquifer, on one side of the levee or on both. A side on which it "
          "is missing counts as open, 0.43 of the aquifer's thickness away.")
          .otherwise_as("required with `aquifer`"),
      key("check.blanket.entry", in_blanket(&Blanket::entry),
          "Boundary with the head of the river.")
          .otherwise_as("required with `aquifer`"),
      key("check.blanket.riverside_toe", in_blanket(&Blanket::riverside_toe),
          "x of the toe of the levee on the riverside.")
          .in("m")
          .otherwise_as("required with `aquifer`"),
      key("check.blanket.landside_toe", in_blanket(&Blanket::landside_toe),
          "x of the toe of the levee on the landside.")
          .in("m")
          .otherwise_as("required with `aquifer`"),
      aquifer_end("check.blanket.riverside", &Blanket::riverside,
                  "How the aquifer ends on the riverside, at the edge of the model: it goes on, "
                  "water enters freely there, or none enters."),
      aquifer_end("check.blanket.landside", &Blanket::landside,
                  "How the aquifer ends on the landside."),
  };
}

}  // namespace suffuse
