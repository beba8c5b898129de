#include "tables/boundary_text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "common/errors.hpp"
#include "files/time_unit.hpp"

namespace suffuse {
namespace {

std::string right_aligned(const std::string& text) {
  constexpr std::size_t width = 14;
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string right_aligned(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return right_aligned(std::string(text));
}

}  // namespace

std::string boundaries_text(const ResultsReader& results) {
  constexpr std::array<const char*, 7> columns{"water_in",  "water_out",  "fines_in", "fines_out",
                                               "liquid_in", "liquid_out", "discharge"};
  const std::vector<NamedTable> boundaries = results.boundaries();
  if (boundaries.empty()) {
    throw FileError(results.folder() + ": boundaries.csv has no rows");
  }
  const std::vector<Wall>& walls = results.scene().scene.walls;
  const auto is_wall = [&](const NamedTable& b) {
    return std::ranges::count(walls, b.name, &Wall::on) > 0;
  };
  // What crosses a wall stays in the model.
  const std::string all = std::ranges::any_of(boundaries, is_wall) ? "all but walls" : "all";
  std::size_t width = all.size();
  for (const NamedTable& b : boundaries) width = std::max(width, b.name.size());
  const auto line = [&](const std::string& name, const auto& cells) {
    std::string text = name + std::string(width - name.size(), ' ');
    for (const auto& value : cells) text += right_aligned(value);
    return text + "\n";
  };
  const bool flat = results.dimension() == 2;
  const double end = boundaries.front().table.column("t").back();
  std::string text = results.folder() + ": " + results.status() +
                     ", since the start until t = " + time_words(end, end, 1e-3 * end) +
                     (flat ? ", per metre of thickness\n" : "\n") +
                     line("", std::array{"water in", "water out", "fines in", "fines out",
                                         "liquid in", "liquid out", "discharge"}) +
                     line("", std::array{"kg", "kg", "kg", "kg", "m3", "m3", "m3/s"});
  std::array<double, columns.size()> sum{};
  for (const NamedTable& b : boundaries) {
    std::array<double, columns.size()> last{};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      last.at(k) = b.table.column(columns.at(k)).back();
      if (!is_wall(b)) sum.at(k) += last.at(k);
    }
    text += line(b.name, last);
  }
  return text + line(all, sum);
}

}  // namespace suffuse
