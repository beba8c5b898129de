#include "field/channel_width.hpp"

namespace suffuse {
namespace {

enum class Part : char { other, eroded, intact };

template <int Dim>
Part channel_part(const Skeleton<Dim>& solid, int element) {
  const SoilMap<Dim>& soils = solid.soils();
  const ErosionModel& erosion = soils.erosion_of_element(element);
  if (!erosion.drive->depends_on_flow() || !(erosion.threshold > 0.0) || erosion.length > 0.0) {
    return Part::other;
  }
  double left = 0.0;
  double at_start = 0.0;
  for (int p = soils.points_begin(element); p < soils.points_begin(element + 1); ++p) {
    left += solid.state().erodible_volume[p];
    at_start += solid.erodible_at_start(p);
  }
  if (!(at_start > 0.0)) return Part::other;
  return left < 0.5 * at_start ? Part::eroded : Part::intact;
}

}  // namespace

template <int Dim>
std::optional<double> relative_channel_width(const Grid<Dim>& grid, const Skeleton<Dim>& solid) {
  constexpr double enough = 10.0;
  double volume = 0.0;
  double count = 0.0;
  double border = 0.0;
  for (const int e : grid.own_elements()) {
    if (channel_part(solid, e) != Part::eroded) continue;
    volume += grid.volume[e];
    count += 1.0;
    for (const int f : grid.element_face[e]) {
      const int other = grid.beyond(f, e);
      if (other >= 0 && channel_part(solid, other) == Part::intact)
        border += grid.face_normal[f].norm();
    }
  }
  volume = sum_of_all(grid.ranks(), volume);
  count = sum_of_all(grid.ranks(), count);
  border = sum_of_all(grid.ranks(), border);
  if (count < enough || border == 0.0) return std::nullopt;
  return 2.0 * volume / border / regular_edge<Dim>(volume / count);
}

template std::optional<double> relative_channel_width(const Grid<2>&, const Skeleton<2>&);
template std::optional<double> relative_channel_width(const Grid<3>&, const Skeleton<3>&);

}  // namespace suffuse
