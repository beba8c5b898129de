#include "scene/assessment_checks.hpp"

#include <algorithm>
#include <cmath>

#include "scene/law_texts.hpp"
#include "scene/scene_check_base.hpp"

namespace suffuse {
namespace {

class AssessmentChecks : private SceneCheckBase {
 public:
  using SceneCheckBase::SceneCheckBase;

  void run() const {
    const CheckSettings& check = scene_.check;
    need_first("check.uplift", "cover");
    expect_region("check.uplift.cover", check.uplift.cover);
    check_backward_erosion(check.backward_erosion);
    check_blanket(check.blanket);
  }

 private:
  /// Reports the keys of a table that lacks the key which switches its check on.
  void need_first(const std::string& table, const std::string& first) const {
    const std::string key = joined(table, first);
    for (const std::string& other : keys_of(table)) {
      if (other == key || !given(other)) continue;
      require(key, key, "as " + other.substr(table.size() + 1) + " is given", other);
      return;
    }
  }

  void need_rest(const std::string& table, const std::string& first,
                 const std::vector<std::string>& rest) const {
    const std::string key = joined(table, first);
    if (!given(key)) return;
    for (const std::string& name : rest) {
      require(joined(table, name), joined(table, name), "with " + first, key);
    }
  }

  void expect_region(const std::string& key, const std::string& region) const {
    if (!given(key) || refused(key) || scene_.find_soil(region) != nullptr) return;
    std::vector<std::string> names;
    for (const Soil& soil : scene_.soils) names.push_back(shown_value(soil.region));
    expect_one_of(key, region, "a soil", names);
  }

  void expect_boundary(const std::string& key, const std::string& boundary) const {
    if (!given(key) || refused(key)) return;
    std::vector<std::string> names;
    for (const BoundaryCondition& b : scene_.boundaries) {
      if (b.is_well()) continue;
      if (b.on == boundary) return;
      names.push_back(shown_value(b.on));
    }
    expect_one_of(key, boundary, "a boundary", names);
  }

  void expect_one_of(const std::string& key, const std::string& found, const std::string& what,
                     const std::vector<std::string>& names) const {
    const std::string known = names.empty() ? "" : ": " + listed(names, "or");
    report(key, shown_value(found), what + " of the scene" + known);
  }

  void refuse_in_space(const std::string& key) const {
    if (!given(key) || !scene_.geometry.is_box()) return;
    report(key, "a check of plane sections in three dimensions", "no such table",
           {"geometry.shape"});
  }

  void check_backward_erosion(const BackwardErosionSettings& settings) const {
    const std::string table = "check.backward_erosion";
    need_first(table, "layer");
    need_rest(table, "layer", {"entry", "exit"});
    refuse_in_space(table + ".layer");
    expect_region(table + ".layer", settings.layer);
    expect_boundary(table + ".entry", settings.entry);
    expect_boundary(table + ".exit", settings.exit);
    if (given(table + ".exit") && settings.entry == settings.exit) {
      report(table + ".exit", shown_value(settings.exit), "another boundary than entry",
             {table + ".entry"});
    }
    const Soil* layer = scene_.find_soil(settings.layer);
    if (layer == nullptr || !layer->gradation.empty()) return;
    require(table + ".d70", table + ".d70",
            "as the soil " + shown_value(layer->region) + " has no gradation", table + ".layer");
  }

  void check_blanket(const BlanketSettings& settings) const {
    const std::string table = "check.blanket";
    need_first(table, "aquifer");
    need_rest(table, "aquifer", {"cover", "entry", "riverside_toe", "landside_toe"});
    refuse_in_space(table + ".aquifer");
    expect_region(table + ".aquifer", settings.aquifer);
    expect_region(table + ".cover", settings.cover);
    expect_boundary(table + ".entry", settings.entry);
    if (given(table + ".cover") && settings.cover == settings.aquifer) {
      report(table + ".cover", shown_value(settings.cover), "another region than aquifer",
             {table + ".aquifer"});
    }
    if (settings.riverside_toe == settings.landside_toe) {
      report(table + ".landside_toe", shown_number(settings.landside_toe),
             "another x than that of the riverside toe", {table + ".riverside_toe"});
    }
  }
};

}  // namespace

void check_assessment(const Scene& scene, const SceneInquiry& inquiry) {
  AssessmentChecks(scene, inquiry).run();
}

}  // namespace suffuse
