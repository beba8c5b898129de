#include "solid/rank_state.hpp"

#include <algorithm>

namespace suffuse {
namespace {

SharedState::Rows rows_of(const Ranks& ranks, const std::vector<long>& numbers,
                          const NumberRange& own) {
  std::vector<SharedState::Rows::Held> held;
  held.reserve(numbers.size());
  for (const long number : numbers) held.push_back({number, static_cast<int>(held.size())});
  // Faces at the fringe are in another order than in the whole mesh.
  std::ranges::sort(held, {}, &SharedState::Rows::Held::number);
  return {std::move(held), static_cast<long>(sum_of_all(ranks, *own.end() - *own.begin())),
          static_cast<std::size_t>(*own.begin()), static_cast<std::size_t>(*own.end())};
}

}  // namespace

template <int Dim>
std::vector<long> point_numbers(const Grid<Dim>& grid, const SoilMap<Dim>& soils) {
  const NumberRange own = soils.points_of(grid.own_elements());
  const long first = grid.ranks().before(*own.end() - *own.begin());
  std::vector<long> of_element(grid.mesh.elements.size(), 0);
  for (const int e : grid.own_elements()) {
    of_element[e] = first + soils.points_begin(e) - *own.begin();
  }
  grid.element_rows().exchange(of_element);
  std::vector<long> numbers;
  numbers.reserve(soils.points().element.size());
  for (int p = 0; p < soils.points().size(); ++p) {
    const int e = soils.points().element[p];
    numbers.push_back(of_element[e] + p - soils.points_begin(e));
  }
  return numbers;
}

template <int Dim>
OwnRows point_rows(const Grid<Dim>& grid, const SoilMap<Dim>& soils) {
  const NumberRange own = soils.points_of(grid.own_elements());
  return grid.ranks().rows(point_numbers(grid, soils), *own.begin(), *own.end());
}

template <int Dim>
RankState::RankState(const Grid<Dim>& grid, const SoilMap<Dim>& soils)
    : ranks_(grid.ranks()),
      rows_{rows_of(ranks_, grid.element_numbers(), grid.own_elements()),
            rows_of(ranks_, grid.face_numbers(), grid.own_faces()),
            rows_of(ranks_, grid.node_numbers(), grid.node_rows().own()),
            rows_of(ranks_, point_numbers(grid, soils), soils.points_of(grid.own_elements()))} {}

bool RankState::all_equal(std::uint64_t number) const {
  // Halves, which a double holds exactly.
  const auto high = static_cast<double>(number >> 32U);
  const auto low = static_cast<double>(number & 0xffffffffU);
  std::array<double, 4> extremes{high, -high, low, -low};
  ranks_.largest(extremes);
  return extremes[0] == -extremes[1] && extremes[2] == -extremes[3];
}

template std::vector<long> point_numbers(const Grid<2>&, const SoilMap<2>&);
template std::vector<long> point_numbers(const Grid<3>&, const SoilMap<3>&);
template OwnRows point_rows(const Grid<2>&, const SoilMap<2>&);
template OwnRows point_rows(const Grid<3>&, const SoilMap<3>&);
template RankState::RankState(const Grid<2>&, const SoilMap<2>&);
template RankState::RankState(const Grid<3>&, const SoilMap<3>&);

}  // namespace suffuse
