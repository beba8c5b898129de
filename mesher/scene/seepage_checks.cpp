#include "scene/seepage_checks.hpp"

#include <algorithm>
#include <cmath>

#include "physics/head.hpp"
#include "scene/law_texts.hpp"
#include "scene/scene_check_base.hpp"

namespace suffuse {
namespace {

class SeepageChecks : private SceneCheckBase {
 public:
  using SceneCheckBase::SceneCheckBase;

  void run() const {
    for (const Soil& soil : scene_.soils) check_soil(soil, table_of(soil));
    for (const BoundaryCondition& boundary : scene_.boundaries) {
      check_dry(boundary.key);
      check_reservoir(boundary);
    }
    check_start();
    check_steady_start();
    check_sections();
    check_unsaturated();
    check_anisotropy();
    if (scene_.formulation == Formulation::double_point) check_double_point_seepage();
    if (scene_.time.scheme == FlowScheme::explicit_nodal && !refused("time.scheme")) {
      check_explicit_seepage();
    }
  }

 private:
  void check_soil(const Soil& soil, const std::string& table) const {
    check_retention(soil, table + ".retention");
    check_field(soil, table);
    if (own(table + ".bedding") && given(table + ".conductivity") &&
        !refused(table + ".conductivity") && std::isnan(soil.conductivity_across)) {
      report(table + ".bedding", "an angle of bedding and one conductivity",
             "conductivity = [along, across], or no such key", {table + ".conductivity"});
    }
  }

  void check_field(const Soil& soil, const std::string& table) const {
    const std::string field = table + ".field";
    for (const std::string& name : scene_children("soil.*.field")) {
      if (!given(joined(field, name))) continue;
      for (const std::string needed : {"variation", "correlation"}) {
        require(joined(field, needed), "soil.*.field." + needed, "as " + name + " is given",
                joined(field, name));
      }
      break;
    }
    if (!soil.field.varies()) return;
    const std::string found = "a conductivity that varies";
    if (scene_.formulation == Formulation::double_point) {
      report(field, found + " in a double-point scene",
             "formulation = \"single-point\", or no field", {"formulation"});
    }
    if (soil.skeleton.moves()) {
      report(field, found + " in soil that moves", "a rigid skeleton, or no field",
             {table + ".skeleton.law"});
    }
    if (soil.drag == SoilDrag::ergun) {
      report(field, found + " with drag = \"ergun\"", "drag = \"darcy\", or no field",
             {table + ".drag"});
    }
  }

  void check_retention(const Soil& soil, const std::string& table) const {
    for (const std::string& name : scene_children("soil.*.retention")) {
      if (!given(joined(table, name))) continue;
      require(table + ".model", "soil.*.retention.model", "as " + name + " is given",
              joined(table, name));
      break;
    }
    if (!given(table + ".model") || refused(table + ".model")) return;
    const RetentionLaw* law = soil.retention.law;
    for (const RetentionParameter& parameter : retention_parameters()) {
      const std::string pattern = "soil.*.retention." + std::string(parameter.key);
      const std::string key = joined(table, std::string(parameter.key));
      std::vector<std::string> laws = laws_with_retention_parameter(parameter.key);
      if (law && std::ranges::find(laws, law->word) != laws.end()) {
        require(key, pattern, "for model = " + shown_value(std::string(law->word)),
                table + ".model");
      } else if (own(key)) {
        for (std::string& word : laws) word = shown_value(word);
        report(key, "a key of another model", "model = " + listed(laws) + ", or no such key",
               {table + ".model"});
      }
    }
  }

  /// Refuses faces that change their kind and anisotropic drag in the explicit scheme.
  void check_explicit_seepage() const {
    const auto refuse = [&](const std::string& key, const std::string& found,
                            const std::string& instead = "no such key") {
      report(key, found + " with scheme = \"explicit\"", instead + ", or scheme = \"implicit\"",
             {"time.scheme"});
    };
    for (const BoundaryCondition& boundary : scene_.boundaries) {
      if (boundary.seepage_face) refuse(joined(boundary.key, "seepage_face"), "a seepage face");
      if (boundary.rain) refuse(joined(boundary.key, "rain"), "rain");
      // The tip of a well has one velocity for both sides, which cannot be inward on both.
      if (boundary.rate) refuse(joined(boundary.key, "rate"), "a rate", "a head");
      if (boundary.is_reservoir()) refuse(joined(boundary.key, "reservoir_area"), "a reservoir");
    }
    for (const Soil& soil : scene_.soils) {
      const std::string table = table_of(soil);
      if (soil.retention.law) refuse(table + ".retention", "a retention law");
      if (!std::isnan(soil.conductivity_across)) {
        refuse(table + ".conductivity", "a pair of conductivities", "one number");
      }
    }
    for (std::size_t i = 0; i < scene_.walls.size(); ++i) {
      if (scene_.walls[i].conductance == 0.0) continue;
      refuse("wall[" + std::to_string(i) + "].conductance", "a wall that lets liquid through", "0");
    }
  }

  /// Refuses retention and leaky walls: liquid points fill the pores and do not cross walls.
  void check_double_point_seepage() const {
    const std::string found = " with formulation = \"double-point\"";
    for (const Soil& soil : scene_.soils) {
      if (!soil.retention.law) continue;
      report(table_of(soil) + ".retention", "a retention law" + found,
             "no such table, or formulation = \"single-point\": liquid points fill the pores",
             {"formulation"});
    }
    for (std::size_t i = 0; i < scene_.walls.size(); ++i) {
      if (scene_.walls[i].conductance == 0.0) continue;
      report("wall[" + std::to_string(i) + "].conductance",
             "a wall that lets liquid through" + found, "0, or formulation = \"single-point\"",
             {"formulation"});
    }
  }

  void check_unsaturated() const {
    const auto unsaturated = std::ranges::find_if(scene_.soils, &Soil::drains);
    if (unsaturated == scene_.soils.end()) return;
    const std::string retention = table_of(*unsaturated) + ".retention";
    for (const Soil& soil : scene_.soils) {
      if (soil.drag != SoilDrag::ergun) continue;
      report(table_of(soil) + ".drag", "\"ergun\" with " + retention,
             "\"darcy\": Ergun's law is for full pores", {retention});
    }
    if (scene_.time.inertia.value_or(false)) {
      report("time.inertia", "true with " + retention,
             "false, or no such key: flow in soil that is not full is slow", {retention});
    }
  }

  void check_anisotropy() const {
    for (const Soil& soil : scene_.soils) {
      if (soil.drag != SoilDrag::ergun || std::isnan(soil.conductivity_across)) continue;
      const std::string table = table_of(soil);
      report(table + ".drag", "\"ergun\" with a pair of conductivities",
             "\"darcy\", or one conductivity", {table + ".conductivity"});
    }
  }

  /// Liquid at rest under gravity needs a known level: with p = 0 everywhere it would not be at
  /// rest.
  void check_start() const {
    if (given("initial.construction") && !given("initial.from")) {
      report("initial.construction", "a time without an earlier run",
             "initial.from, or no such key");
    } else if (given("initial.construction") && !refused("time.end") &&
               scene_.construction_time() > scene_.time.end) {
      report("initial.construction", shown_number(scene_.construction_time()) + " s",
             "at most time.end = " + shown_number(scene_.time.end) +
                 " s: the run would end before what is dug out or filled in weighs in full",
             {"time.end"});
    }
    if (given("initial.from")) {
      for (const std::string other : {"initial.flow", "initial.water_level", "initial.stress"}) {
        if (!given(other)) continue;
        report(other, "a start in addition to that from an earlier run", "initial.from alone",
               {"initial.from"});
      }
      return;
    }
    const std::string key = "initial.water_level";
    if (scene_.initial_flow != InitialFlow::rest || refused("initial.flow") ||
        !has_gravity(scene_.gravity) || scene_.water_level || refused(key)) {
      return;
    }
    std::vector<std::string> heads;
    for (const BoundaryCondition& boundary : scene_.boundaries) {
      if (boundary.is_well()) continue;
      const bool wrong = given(joined(boundary.key, "head")) || given(joined(boundary.key, "file"));
      if (!boundary.head && wrong) return;  // reported already
      if (!boundary.head) continue;
      heads.push_back(shown_number(boundary.head->value(0.0)) + " m on " +
                      shown_value(boundary.on));
    }
    report(key,
           heads.empty() ? "nothing, with gravity, a start at rest and no boundary with a head"
                         : "nothing, with a start at rest and heads that differ at t = 0: " +
                               listed(heads, "and"),
           "the level of the liquid at rest, in m, or initial.flow = \"steady\"",
           {"initial.flow", "gravity"});
  }

  /// Steady flow under gravity whose fluxes are all prescribed stands at no certain level.
  void check_steady_start() const {
    const auto sets_level = [this](const BoundaryCondition& b) {
      const auto is_given = [&](const char* name) { return given(joined(b.key, name)); };
      return b.seepage_face || is_given("head") || is_given("file") || is_given("pressure") ||
             is_given("rain");
    };
    if (scene_.initial_flow != InitialFlow::steady || !has_gravity(scene_.gravity) ||
        given("initial.from") || std::ranges::any_of(scene_.boundaries, sets_level)) {
      return;
    }
    report("initial.flow", "\"steady\" under gravity where nothing sets the level of the water",
           "a boundary with a head, pressure, seepage_face or rain, a well with a head or "
           "seepage_face, or flow = \"rest\" with initial.water_level",
           {"gravity"});
  }

  void check_sections() const {
    for (std::size_t i = 0; i < scene_.output.sections.size(); ++i) {
      const std::string entry = "output.section[" + std::to_string(i) + "]";
      const OutputSection& section = scene_.output.sections[i];
      const bool both = given(entry + ".from") && given(entry + ".to") &&
                        !refused(entry + ".from") && !refused(entry + ".to");
      if (both && section.from == section.to) {
        report(entry, "a line that ends where it begins", "two points", {entry + ".to"});
      }
    }
  }

  void check_dry(const std::string& entry) const {
    const std::string key = joined(entry, "dry");
    if (!given(key)) return;
    if (!given(joined(entry, "head")) && !given(joined(entry, "file"))) {
      report(key, "a key of a head without one", "head or file too, or no such key");
    } else if (!has_gravity(scene_.gravity) && !refused("gravity")) {
      report(key, "a part above the water level without gravity",
             "gravity, as in gravity = [0.0, -9.81], or no such key", {"gravity"});
    }
  }
  void check_reservoir(const BoundaryCondition& boundary) const {
    const std::string key = joined(boundary.key, "reservoir_area");
    if (!given(key)) return;
    const std::string head = joined(boundary.key, "head");
    if (!given(head)) {
      report(key, "the area of a reservoir without a head",
             "head = its level at the start, in m, or no such key");
    } else if (boundary.head && !boundary.head->is_constant()) {
      report(key, "a level that follows from what seeps, and a head given in time",
             "one number as head, or no such key", {head});
    }
    if (scene_.moves()) {
      report(key, "a reservoir in a scene with soil that moves",
             "no such key, or the level as a table in time");
    }
  }
};

}  // namespace

void check_seepage(const Scene& scene, const SceneInquiry& inquiry) {
  SeepageChecks(scene, inquiry).run();
}

}  // namespace suffuse
