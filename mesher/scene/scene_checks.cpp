#include "scene/scene_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/short_number.hpp"
#include "scene/assessment_checks.hpp"
#include "scene/geometry_checks.hpp"
#include "scene/law_texts.hpp"
#include "scene/scene_check_base.hpp"
#include "scene/seepage_checks.hpp"
#include "scene/skeleton_checks.hpp"
#include "scene/soil_grading.hpp"

namespace suffuse {
namespace {

/// Largest number of rows of a table: more are probably a mistake and would fill the disk.
constexpr double max_rows = 1e6;
/// Largest number of time steps: a run with more would not end.
constexpr double max_steps = 1e9;

class Checks : private SceneCheckBase {
 public:
  using SceneCheckBase::SceneCheckBase;

  void run() const {
    for (const Soil& soil : scene_.soils) check_soil(soil);
    check_viscosity();
    check_grains();
    check_boundaries();
    check_seeding();
    check_formulation();
    check_free_regions();
    check_third_term();
    check_scheme();
    check_transport();
    check_times();
  }

 private:
  void check_soil(const Soil& soil) const {
    const std::string table = table_of(soil);
    if (soil.porosity + soil.skeleton_fraction > 1.0) {
      report(table + ".skeleton_fraction",
             "n_0 + n_C = " + shown_number(soil.porosity) + " + " +
                 shown_number(soil.skeleton_fraction) + " > 1",
             "n_0 + n_C <= 1", {table + ".porosity"});
    }
    check_grading_of(soil, table, inquiry_);
    check_erosion(soil, table + ".erosion");
    check_deposition(soil, table + ".deposition");
    check_conductivity_parameters(soil, table);
  }

  void check_erosion(const Soil& soil, const std::string& table) const {
    for (const std::string& name : scene_children("soil.*.erosion")) {
      if (given(joined(table, name))) {
        require(table + ".law", "soil.*.erosion.law", "as " + name + " is given",
                joined(table, name));
        break;
      }
    }
    if (soil.erosion.law->erodes()) {
      require(table + ".rate", "soil.*.erosion.rate",
              "as law is not " + shown_value(std::string(no_erosion()->word)), table + ".law");
    }
    check_drive(soil, table);
    check_length(soil, table);
    check_residual(soil, joined(table, "residual"));
    check_momentum(soil, table);
  }

  void check_residual(const Soil& soil, const std::string& key) const {
    const auto& pairs = soil.erosion.residual.pairs;
    if (!given(key) || refused(key) || pairs.empty()) return;
    if (pairs.front().first < 0.0) {
      report(key, "|q| = " + shown_number(pairs.front().first), "|q| >= 0, in m/s");
    }
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      if (pairs[i].second <= pairs[i - 1].second) continue;
      report(
          key,
          "n_e = " + shown_number(pairs[i].second) + " after " + shown_number(pairs[i - 1].second),
          "fractions that do not rise with |q|: flow that is faster takes more");
    }
    const double erodible = soil.porosity_max() - soil.porosity;
    if (pairs.back().second >= erodible && !soil.deposition.deposits()) {
      report(key, "n_e = " + shown_number(pairs.back().second) + " that stays",
             "less than n_e = 1 - n_C - n_0 = " + short_number(erodible) +
                 ", a fraction of the volume of soil, or nothing erodes");
    }
  }

  /// Refuses bedding and suction, which the momentum of eroded grains neglects.
  void check_momentum(const Soil& soil, const std::string& table) const {
    const bool needs = soil.erosion_model().drive->depends_on_conductivity;
    if (!soil.erosion.momentum_transfer || !needs) return;
    if (soil.anisotropy() == 1.0 && !soil.drains()) return;
    report(joined(table, "momentum_transfer"),
           "true with drive = " + shown_value(std::string(soil.erosion.drive->word)) +
               " in soil with bedding or retention",
           "false, or another drive", {joined(table, "drive")});
  }

  void check_length(const Soil& soil, const std::string& table) const {
    const std::string key = joined(table, "length");
    if (!(soil.erosion.length > 0.0) || refused(key)) return;
    if (scene_.moves()) {
      report(key, shown_number(soil.erosion.length) + " m where soil moves",
             "rigid soil, or no such key", {});
    }
    if (depends_on_flux(soil.erosion_model()) || !own(key)) return;
    report(key,
           shown_number(soil.erosion.length) + " m for erosion that does not depend on the flow",
           "a drive other than \"time\", or no such key", {joined(table, "drive")});
  }

  void check_drive(const Soil& soil, const std::string& table) const {
    const std::string drive_key = joined(table, "drive");
    const std::string law_key = joined(table, "law");
    if (refused(drive_key) || refused(law_key)) return;
    const std::string_view implied = soil.erosion.law->drive;
    if (own(drive_key) && !implied.empty() && soil.erosion.drive->word != implied) {
      report(drive_key, shown_value(std::string(soil.erosion.drive->word)),
             shown_value(std::string(implied)) +
                 ", which law = " + shown_value(std::string(soil.erosion.law->word)) +
                 " stands for, or law = \"first-order\"",
             {law_key});
    }
    const std::string threshold_key = joined(table, "threshold");
    if (!own(threshold_key) || soil.erosion_model().drive->depends_on_flow()) return;
    std::vector<std::string> drives;
    for (const DriveLaw* drive : drive_laws()) {
      if (drive->depends_on_flow()) drives.push_back(shown_value(std::string(drive->word)));
    }
    report(threshold_key, "a threshold of the drive \"time\"",
           "drive = " + listed(drives) + ", or no such key", {drive_key});
  }

  void check_deposition(const Soil& soil, const std::string& table) const {
    const std::string coefficient = joined(table, "coefficient");
    for (const std::string& name : scene_children("soil.*.deposition")) {
      const std::string key = joined(table, name);
      if (!given(key) || given(coefficient)) continue;
      require(coefficient, "soil.*.deposition.coefficient", "as " + name + " is given", key);
      break;
    }
    if (soil.deposition.porosity_min >= soil.porosity) {
      report(joined(table, "porosity_min"),
             "n_min = " + shown_number(soil.deposition.porosity_min) +
                 " with n_0 = " + shown_number(soil.porosity),
             "n_min < n_0", {joined(table_of(soil), "porosity")});
    }
  }

  void check_conductivity_parameters(const Soil& soil, const std::string& table) const {
    const std::string law_key = joined(table, "conductivity_law");
    if (refused(law_key)) return;
    for (const ConductivityParameter& parameter : conductivity_parameters()) {
      const std::string name(parameter.key);
      const std::string key = joined(table, name);
      std::vector<std::string> laws = laws_with_conductivity_parameter(name);
      const bool asks = std::ranges::find(laws, soil.conductivity_law->word) != laws.end();
      if (asks && name == "size_ratio" && soil.conductivity_parameters.size_ratio < 1.0) {
        report(key, shown_value(soil.conductivity_parameters.size_ratio),
               "r >= 1: the coarse grains over the fine ones");
      }
      if (asks && std::isnan(ConductivityParameters{}.*parameter.value)) {
        require(key, "soil.*." + name,
                "as conductivity_law is " + shown_value(std::string(soil.conductivity_law->word)),
                law_key);
      }
      if (asks || !own(key)) continue;
      for (std::string& law : laws) law = shown_value(law);
      report(key, "a key of another law", "conductivity_law = " + listed(laws) + ", or no such key",
             {law_key});
    }
  }

  void check_viscosity() const {
    const ViscosityModel& viscosity = scene_.liquid.viscosity_model;
    const std::string law_key = "liquid.viscosity_law";
    const std::string key = "liquid.maximum_concentration";
    if (refused(law_key) || refused(key)) return;
    if (!viscosity.depends_on_concentration()) {
      if (given(key)) {
        report(key, "a key of another law", "viscosity_law = \"krieger-dougherty\", or no such key",
               {law_key});
      }
      return;
    }
    for (const BoundaryCondition& boundary : scene_.boundaries) {
      const double richest = boundary.concentration.value_or(0.0).largest();
      if (richest < viscosity.maximum_concentration) continue;
      report(joined(boundary.key, "concentration"), shown_value(richest),
             "c < c_m = " + shown_number(viscosity.maximum_concentration) +
                 ", at which the grains lock",
             {given(key) ? key : law_key});
    }
  }

  /// Refuses different grains, which could not be separated once they are in the liquid.
  void check_grains() const {
    for (const Soil& soil : scene_.soils) {
      const Soil& first = scene_.soils.front();
      // Both are set and differ; unset values are reported elsewhere.
      if (soil.grain_density < first.grain_density || soil.grain_density > first.grain_density) {
        const std::string other = table_of(first) + ".grain_density";
        report(table_of(soil) + ".grain_density", shown_value(soil.grain_density),
               "rho_s = " + shown_number(first.grain_density) + " kg/m3 as in " + table_of(first) +
                   ": the liquid carries one kind of grains",
               {other});
      }
    }
  }

  /// Checks that the number of Gauss points is that of a rule; their volumes are unequal.
  void check_seeding() const {
    if (scene_.points.seeding != Seeding::gauss) return;
    const int count = scene_.points.liquid_per_element;
    const std::string offered = "points.solid_per_element";
    if (!find_scene_key(offered)->accept(std::int64_t{count})) {
      report("points.liquid_per_element", std::to_string(count) + " with seeding = \"gauss\"",
             find_scene_key(offered)->expected(), {"points.seeding"});
    }
    const std::string key = "points.equal_volume";
    if (given(key) && !refused(key) && scene_.points.equal_volume) {
      report(key, "true with seeding = \"gauss\"",
             "false: the volumes of Gauss points differ as their weights do", {"points.seeding"});
    }
  }

  void check_formulation() const {
    const std::string formulation = "formulation";
    if (!given(formulation) || refused(formulation)) return;
    if (scene_.formulation == Formulation::double_point) {
      if (scene_.flow.porosity_gradient_term) return;
      report("flow.porosity_gradient_term", "false with formulation = \"double-point\"",
             "true: the balance of points that move with the liquid has no such term",
             {formulation});
      return;
    }
    for (const std::string& key : double_point_keys()) {
      if (!given(key)) continue;
      report(key, "a key of double-point scenes", "formulation = \"double-point\", or no such key",
             {formulation});
    }
  }

  [[nodiscard]] std::vector<std::string> double_point_keys() const {
    std::vector<std::string> keys = keys_of("geometry.layers");
    keys.insert(keys.end(), {"points.liquid_per_element", "points.seeding", "points.equal_volume",
                             "flow.integration"});
    for (const Soil& soil : scene_.soils) {
      for (const std::string name : {"mass_transfer", "empty_elements"}) {
        keys.push_back(table_of(soil) + ".erosion." + name);
      }
    }
    return keys;
  }

  void check_free_regions() const {
    if (scene_.formulation == Formulation::double_point || scene_.moves()) return;
    for (const std::string& region : scene_.free_regions) {
      report(joined(joined("soil", shown_name(region)), "free"), "true in a single-point scene",
             "formulation = \"double-point\", a skeleton that moves, or no such key");
    }
  }

  /// Without the third term of Eq. 2 no balance closes: refuses erosion and fines that enter.
  void check_third_term() const {
    const bool single_point = scene_.formulation == Formulation::single_point;
    if (scene_.flow.porosity_gradient_term || !single_point) return;
    const bool eroding = std::any_of(scene_.soils.begin(), scene_.soils.end(),
                                     [](const Soil& soil) { return soil.exchanges(); });
    const bool fines_enter =
        std::any_of(scene_.boundaries.begin(), scene_.boundaries.end(),
                    [](const auto& b) { return b.concentration.value_or(0.0).largest() > 0.0; });
    if (!eroding && !fines_enter) return;
    report("flow.porosity_gradient_term", "false where soil erodes or grains enter",
           "true: without this term of Eq. 2 no balance closes");
  }

  void check_transport() const {
    if (!given("time.transport") || refused("time.transport")) return;
    if (scene_.formulation != Formulation::single_point) {
      report("time.transport", "a key of the single-point formulation in a double-point scene",
             "formulation = \"single-point\", or no such key: liquid points carry the fines",
             {"formulation"});
    } else if (scene_.time.transport == TransportScheme::implicit_sweeps &&
               scene_.time.scheme == FlowScheme::explicit_nodal) {
      report("time.transport", "\"implicit\" with scheme = \"explicit\"",
             "scheme = \"implicit\", or transport = \"explicit\": steps of the explicit flow are "
             "shorter than those of explicit transport",
             {"time.scheme"});
    }
  }

  void check_scheme() const {
    const std::string key = "time.scheme";
    if (refused(key)) return;
    if (scene_.time.scheme == FlowScheme::explicit_nodal) {
      check_explicit();
      return;
    }
    const std::string scheme =
        std::string("with scheme = \"implicit\"") + (given(key) ? "" : ", the default");
    for (const std::string other : {"time.mass_scaling", "time.drag"}) {
      if (!given(other)) continue;
      report(other, "a key of the explicit scheme " + scheme,
             "scheme = \"explicit\", or no such key", {key});
    }
    // In the double-point formulation these keys are always wrong and are reported elsewhere.
    const bool single_point = scene_.formulation == Formulation::single_point;
    if (single_point && !scene_.flow.porosity_gradient_term) {
      report("flow.porosity_gradient_term", "false " + scheme,
             "true, or scheme = \"explicit\": the implicit scheme has no such variant", {key});
    }
    if (!single_point && scene_.flow.integration == PressureIntegration::material_point) {
      report(
          "flow.integration", "\"material-point\" " + scheme,
          "\"mixed\", or scheme = \"explicit\": the implicit scheme has one pressure per element",
          {key});
    }
    if (given("time.tolerance") && given("time.step")) {
      report("time.tolerance", "a tolerance with time.step",
             "one of the two: a step that is given is not chosen", {"time.step"});
    }
  }

  void check_explicit() const {
    for (const std::string other : {"time.stepping", "time.inertia", "time.tolerance"}) {
      if (!given(other)) continue;
      report(other, "a key of the implicit scheme with scheme = \"explicit\"",
             "scheme = \"implicit\", or no such key", {"time.scheme"});
    }
    if (std::isinf(scene_.liquid.bulk_modulus)) {
      report("liquid.bulk_modulus", "inf with scheme = \"explicit\"",
             "a finite number with K > 0, in Pa, or scheme = \"implicit\": the explicit scheme "
             "steps the waves of pressure, whose speed grows with K",
             {"time.scheme"});
    }
  }

  void check_boundaries() const {
    std::map<std::string, std::string> first_entry;  // by the name of the boundary
    const auto check_name = [&](const std::string& entry, const std::string& name) {
      if (name.empty()) return;
      const auto [earlier, is_new] = first_entry.emplace(name, entry);
      if (!is_new) {
        report(entry + ".on", shown_value(name) + ", as in " + earlier->second,
               entry.starts_with("boundary") && earlier->second.starts_with("boundary")
                   ? "one entry per boundary"
                   : "one boundary, wall or well of a name",
               {earlier->second + ".on"});
      }
    };
    for (const BoundaryCondition& boundary : scene_.boundaries) {
      check_boundary(boundary);
      check_name(boundary.key, boundary.on);
    }
    for (std::size_t i = 0; i < scene_.walls.size(); ++i) {
      check_name("wall[" + std::to_string(i) + "]", scene_.walls[i].on);
    }
  }

  /// Keys that say how liquid moves through a boundary or a well.
  [[nodiscard]] static std::vector<std::string> flow_keys(const BoundaryCondition& boundary) {
    if (boundary.is_well()) return {"head", "rate", "seepage_face"};
    return {"pressure", "velocity", "darcy_flux", "head", "file", "seepage_face", "rain"};
  }

  void check_boundary(const BoundaryCondition& boundary) const {
    const std::string& entry = boundary.key;
    const std::vector<std::string> all = flow_keys(boundary);
    const std::string one_of = "one of " + listed(all, "and");
    std::vector<std::string> conditions;
    std::vector<std::string> keys;
    for (const std::string& name : all) {
      if (!given(joined(entry, name))) continue;
      if (name == "seepage_face" && !boundary.seepage_face && !refused(joined(entry, name))) {
        continue;  // `seepage_face = false` has no effect
      }
      conditions.push_back(name);
      keys.push_back(joined(entry, name));
    }
    if (conditions.size() > 1) report(entry, listed(conditions, "and"), one_of, keys);
    const bool of_soil = given(joined(entry, "fix")) || given(joined(entry, "traction"));
    if (conditions.empty() && (!of_soil || given(entry + ".concentration"))) {
      const bool concentration = given(entry + ".concentration");
      report(entry, concentration ? "a concentration and no flow" : "no condition",
             entry.starts_with("well")
                 ? one_of
                 : one_of + (concentration ? "" : ", or fix or traction") +
                       "; a boundary without is impervious and needs no entry");
    }
    if (boundary.seepage_face && boundary.concentration) {
      report(entry + ".concentration",
             "a concentration where no liquid enters, seepage_face = true", "no concentration",
             {joined(entry, "seepage_face")});
    }
    check_outflow(boundary.rate, "rate", boundary, entry);
    check_outflow(boundary.velocity, "velocity", boundary, entry);
    check_outflow(boundary.darcy_flux, "darcy_flux", boundary, entry);
  }

  [[nodiscard]] static std::string shown_range(const TimeFunction& f) {
    const std::string smallest = shown_number(f.smallest());
    return f.is_constant() ? smallest : smallest + " to " + shown_number(f.largest());
  }

  /// Refuses a concentration, which is that of entering liquid, if liquid leaves at all times.
  void check_outflow(const std::optional<TimeFunction>& flow, const std::string& name,
                     const BoundaryCondition& boundary, const std::string& entry) const {
    if (!boundary.concentration || !flow || flow->largest() >= 0.0) return;
    report(entry + ".concentration",
           "c = " + shown_range(*boundary.concentration) + " where the liquid leaves, " + name +
               " = " + shown_range(*flow),
           "no concentration, or an inflow", {joined(entry, name)});
  }

  void check_times() const {
    const TimeSettings& time = scene_.time;
    const OutputSettings& output = scene_.output;
    if (time.step && *time.step > time.end) {
      report("time.step", shown_value(*time.step), "dt <= T = " + shown_number(time.end) + " s",
             {"time.end"});
    }
    if (time.step && *time.step * max_steps < time.end) {
      report("time.step", shown_value(*time.step),
             "at least " + shown_number(time.end / max_steps) +
                 " s, which makes a thousand million steps until T = " + shown_number(time.end) +
                 " s",
             {"time.end"});
    }
    if (output.every * max_rows < time.end) {
      report("output.every", shown_value(output.every),
             "at least " + shown_number(time.end / max_rows) +
                 " s, which makes a million rows until T = " + shown_number(time.end) + " s",
             {"time.end"});
    }
    if (output.snapshot_every < output.every) {
      report("output.snapshot_every", shown_value(output.snapshot_every),
             "at least output.every, " + shown_number(output.every) + " s", {"output.every"});
    }
  }
};

}  // namespace

void check_scene(const Scene& scene, const SceneInquiry& inquiry) {
  check_geometry(scene, inquiry);
  Checks(scene, inquiry).run();
  check_seepage(scene, inquiry);
  check_skeletons(scene, inquiry);
  check_assessment(scene, inquiry);
}

}  // namespace suffuse
