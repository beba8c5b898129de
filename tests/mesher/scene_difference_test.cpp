#include "scene/scene_difference.hpp"

#include <gtest/gtest.h>

namespace suffuse {
namespace scene_difference_test {

using Lines = std::vector<std::string>;

SceneDocument document(const std::string& text, const std::vector<std::string>& overrides = {}) {
  SceneDocument result;
  result.path = "scene.toml";
  result.text = text;
  result.overrides = overrides;
  return result;
}

const std::string text = R"(
name = "weir"
[time]
end = 200.0
[soil.rock]
porosity = 0.3
[[boundary]]
on = "top"
pressure = [[0.0, 0.0], [20.0, 6.0e3], [30.0, 5.0e3], [40.0, 4.0e3]]
)";

std::string replaced(std::string in, const std::string& what, const std::string& by) {
  return in.replace(in.find(what), what.size(), by);
}

TEST(SceneDifference, NoneInCommentsOrderAndSpelling) {
  const std::string other = R"(name = "weir"   # of the same name
soil = {rock = {porosity = 3e-1}}
time.end = 200
boundary = [{pressure = [[0, 0], [20, 6000], [30, 5000], [40, 4000]], on = "top"}]
)";
  EXPECT_EQ(scene_differences(document(text), document(other)), Lines{});
}

TEST(SceneDifference, NamesEachKeyWithBothValues) {
  const std::string other = replaced(replaced(text, "200.0", "100.0"), "porosity = 0.3", "");
  EXPECT_EQ(
      scene_differences(document(text), document(other)),
      (Lines{"soil.rock.porosity: 0.3 there, nothing here", "time.end: 200 there, 100 here"}));
}

TEST(SceneDifference, LongValuesAreNotQuoted) {
  const std::string other = replaced(text, "6.0e3", "7.0e3");
  EXPECT_EQ(scene_differences(document(text), document(other)),
            (Lines{"boundary[0].pressure: other values"}));
}

TEST(SceneDifference, ChangesOnTheCommandLineCount) {
  const SceneDocument changed = document(text, {"time.end=100", "boundary[0].pressure=3e3"});
  EXPECT_EQ(scene_differences(changed, document(replaced(text, "200.0", "100.0"))),
            (Lines{"boundary[0].pressure: other values"}));
  EXPECT_EQ(scene_differences(document(text), document(text, {"time.end=200"})), Lines{});
  // A table replaces the whole table.
  EXPECT_EQ(scene_differences(document(text), document(text, {"soil={clay={porosity=0.3}}"})),
            (Lines{"soil.clay.porosity: nothing there, 0.3 here",
                   "soil.rock.porosity: 0.3 there, nothing here"}));
}

TEST(SceneDifference, FilesOfValuesCount) {
  SceneDocument there = document(text);
  there.files = {{"flood.csv", "0,1\n"}, {"rain.csv", "0,0\n"}};
  SceneDocument here = there;
  EXPECT_EQ(scene_differences(there, here), Lines{});
  here.files["flood.csv"] = "0,2\n";
  EXPECT_EQ(scene_differences(there, here), Lines{"flood.csv: other values"});
}

TEST(SceneDifference, OfWhatCannotBeReadIsTheText) {
  EXPECT_EQ(scene_differences(document("name ="), document(text)), Lines{"the text of the scene"});
  EXPECT_EQ(scene_differences(document("name ="), document("name =")), Lines{});
}

}  // namespace scene_difference_test
}  // namespace suffuse
