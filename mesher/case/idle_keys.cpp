#include "case/plausibility_base.hpp"

namespace suffuse {
namespace {

template <int Dim>
class IdleKeys : private PlausibilityBase<Dim> {
 public:
  using PlausibilityBase<Dim>::PlausibilityBase;

  std::vector<std::string> find() {
    check("time.failure", !scene_.moves(), "no soil moves");
    check("initial.water_level", scene_.initial_flow == InitialFlow::steady,
          "with initial.flow = \"steady\" the boundaries decide the start");
    const bool by_chance =
        scene_.points.jitter > 0.0 || (scene_.formulation == Formulation::double_point &&
                                       scene_.points.seeding == Seeding::random);
    const bool other_seed = scene_.points.seed != PointSettings().seed;
    check("points.seed", other_seed && !by_chance,
          "no points are placed by chance: points.jitter is 0");
    for (const Soil& soil : scene_.soils) {
      const bool is_uniform =
          std::ranges::all_of(soil.porosity_gradient, [](double x) { return x == 0.0; });
      check(table_of(soil) + ".porosity_origin", is_uniform, "porosity_gradient is 0");
    }
    const bool sized_by_error = given("mesh.error") || !given("mesh.size");
    check("mesh.max_elements", !sized_by_error, "without mesh.error the mesh is made once");
    for (std::size_t i = 0; i < scene_.output.probes.size(); ++i) {
      check("output.probe[" + std::to_string(i) + "].disc", !given("mesh.error"),
            "means over it are found with mesh.error only");
    }
    return std::move(warnings_);
  }

 private:
  using Base = PlausibilityBase<Dim>;
  using Base::given;
  using Base::scene_;
  using Base::table_of;
  using Base::warn;
  using Base::warnings_;

  void check(const std::string& key, bool is_idle, const std::string& why) {
    if (is_idle && given(key)) warn(key, "it has no effect here, as " + why);
  }
};

}  // namespace

template <int Dim>
std::vector<std::string> idle_key_warnings(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return IdleKeys<Dim>(document, mesh).find();
}

template std::vector<std::string> idle_key_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> idle_key_warnings(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse
