#include "figures/categories.hpp"

#include "drawing/color_map.hpp"

namespace suffuse {

std::vector<Category> categories(const ResultsReader& results, const FieldPlace& place) {
  if (place.name == "saturation_state") {
    return {{0.0, "dry soil", {0.87, 0.62, 0.25}},
            {1.0, "saturated soil", {0.0, 0.27, 0.53}},
            {2.0, "free liquid", {0.66, 0.85, 0.95}},
            {3.0, "empty", {1.0, 1.0, 1.0}}};
  }
  std::vector<Category> regions;
  if (place.name != "region") return regions;
  const auto count = results.regions().size();
  for (std::size_t r = 0; r < count; ++r) {
    regions.push_back({static_cast<double>(r), results.regions()[r], region_color(r, count)});
  }
  return regions;
}

}  // namespace suffuse
