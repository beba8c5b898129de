#include "points/point_blocks.hpp"

#include <algorithm>

namespace suffuse {
namespace {

/// Growth of a full block. Points come one by one, so doubled blocks would be half empty.
constexpr int room_to_grow = 4;

}  // namespace

template <int Dim>
void PointBlocks<Dim>::fill(const LiquidPoints<Dim>& points, int element_count) {
  std::vector<int> count(element_count, 0);
  for (const int e : points.element) ++count[e];
  blocks_.assign(element_count, {});
  for (int e = 0; e < element_count; ++e) blocks_[e].reserve(count[e] + room_to_grow);
  for (int p = 0; p < points.size(); ++p) {
    CarriedPoint<Dim> point;
    std::copy_n(points.barycentric[p].begin(), Dim, point.at.begin());
    point.velocity = points.velocity[p];
    point.pressure = points.pressure[p];
    point.water_mass = points.water_mass[p];
    point.fines_mass = points.fines_mass[p];
    point.id = points.id[p];
    blocks_[points.element[p]].push_back(point);
  }
}

template <int Dim>
LiquidPoints<Dim> PointBlocks<Dim>::points() const {
  LiquidPoints<Dim> result;
  result.reserve(size());
  for (int e = 0; e < element_count(); ++e) {
    for (const CarriedPoint<Dim>& point : blocks_[e]) {
      result.element.push_back(e);
      result.barycentric.push_back(all_coordinates<Dim>(point.at));
      result.water_mass.push_back(point.water_mass);
      result.fines_mass.push_back(point.fines_mass);
      result.id.push_back(point.id);
      result.pressure.push_back(point.pressure);
      result.velocity.push_back(point.velocity);
    }
  }
  return result;
}

template <int Dim>
int PointBlocks<Dim>::size() const {
  std::size_t sum = 0;
  for (const auto& block : blocks_) sum += block.size();
  return static_cast<int>(sum);
}

template <int Dim>
CarriedPoint<Dim> PointBlocks<Dim>::remove(int element, int slot) {
  auto& block = blocks_[element];
  CarriedPoint<Dim> removed = block[slot];
  block[slot] = block.back();
  block.pop_back();
  return removed;
}

template <int Dim>
void PointBlocks<Dim>::add(int element, const CarriedPoint<Dim>& point) {
  auto& block = blocks_[element];
  if (block.size() == block.capacity()) block.reserve(block.size() + room_to_grow);
  block.push_back(point);
}

template class PointBlocks<2>;
template class PointBlocks<3>;

}  // namespace suffuse
