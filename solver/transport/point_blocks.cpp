#include "transport/point_blocks.hpp"

#include <algorithm>

namespace suffuse {

template <int Dim>
void PointBlocks<Dim>::fill(const LiquidPoints<Dim>& points, int element_count) {
  quads_.clear();
  ids_.clear();
  free_.clear();
  blocks_.assign(element_count, Block{0, 0, 0});
  for (const int e : points.element) ++blocks_[e].count;
  std::size_t quads = 0;
  for (Block& block : blocks_) {
    // Room for one more, or a block that is just full would grow with the first that comes.
    block.capacity = static_cast<int>(quads_of(block.count + 1));
    block.first = quads;
    quads += block.capacity;
    block.count = 0;
  }
  // What is reserved and never touched costs no memory; what grows shall not move the rest.
  quads_.reserve(quads + quads / 2);
  ids_.reserve(quads + quads / 2);
  quads_.resize(quads);
  ids_.resize(quads);
  for (int e = 0; e < element_count; ++e) {
    for (int slot = 0; slot < simd_width * blocks_[e].capacity; ++slot) clear(e, slot);
  }
  for (int p = 0; p < points.size(); ++p) {
    CarriedPoint<Dim> point;
    std::copy_n(points.barycentric[p].begin(), Dim, point.at.begin());
    point.velocity = points.velocity[p];
    point.pressure = points.pressure[p];
    point.water_mass = points.water_mass[p];
    point.fines_mass = points.fines_mass[p];
    point.id = points.id[p];
    add_growing(points.element[p], point);
  }
}

template <int Dim>
LiquidPoints<Dim> PointBlocks<Dim>::points() const {
  LiquidPoints<Dim> result;
  result.reserve(size());
  for (int e = 0; e < element_count(); ++e) {
    for (int slot = 0; slot < count(e); ++slot) {
      const CarriedPoint<Dim> carried = point(e, slot);
      result.element.push_back(e);
      result.barycentric.push_back(all_coordinates<Dim>(carried.at));
      result.water_mass.push_back(carried.water_mass);
      result.fines_mass.push_back(carried.fines_mass);
      result.id.push_back(carried.id);
      result.pressure.push_back(carried.pressure);
      result.velocity.push_back(carried.velocity);
    }
  }
  return result;
}

template <int Dim>
int PointBlocks<Dim>::size() const {
  int sum = 0;
  for (const Block& block : blocks_) sum += block.count;
  return sum;
}

template <int Dim>
CarriedPoint<Dim> PointBlocks<Dim>::point(int element, int slot) const {
  const std::size_t q = blocks_[element].first + slot / simd_width;
  const int lane = slot % simd_width;
  const PointQuad<Dim>& quad = quads_[q];
  CarriedPoint<Dim> point;
  for (int d = 0; d < Dim; ++d) {
    point.at[d] = quad.at[d][lane];
    point.velocity[d] = quad.velocity[d][lane];
  }
  point.pressure = quad.pressure[lane];
  point.water_mass = quad.water_mass[lane];
  point.fines_mass = quad.fines_mass[lane];
  point.id = ids_[q][lane];
  return point;
}

template <int Dim>
void PointBlocks<Dim>::put(int element, int slot, const CarriedPoint<Dim>& point) {
  const std::size_t q = blocks_[element].first + slot / simd_width;
  const int lane = slot % simd_width;
  PointQuad<Dim>& quad = quads_[q];
  for (int d = 0; d < Dim; ++d) {
    quad.at[d][lane] = point.at[d];
    quad.velocity[d][lane] = point.velocity[d];
  }
  quad.pressure[lane] = point.pressure;
  quad.water_mass[lane] = point.water_mass;
  quad.fines_mass[lane] = point.fines_mass;
  ids_[q][lane] = point.id;
}

template <int Dim>
void PointBlocks<Dim>::clear(int element, int slot) {
  CarriedPoint<Dim> nothing;
  nothing.at.fill(1.0 / (Dim + 1));
  nothing.velocity.setZero();
  nothing.pressure = nothing.water_mass = nothing.fines_mass = 0.0;
  nothing.id = -1;
  put(element, slot, nothing);
}

template <int Dim>
CarriedPoint<Dim> PointBlocks<Dim>::remove(int element, int slot) {
  CarriedPoint<Dim> removed = point(element, slot);
  const int last = --blocks_[element].count;
  if (slot != last) put(element, slot, point(element, last));
  clear(element, last);
  return removed;
}

template <int Dim>
bool PointBlocks<Dim>::add(int element, const CarriedPoint<Dim>& point) {
  Block& block = blocks_[element];
  if (block.count == simd_width * block.capacity) return false;
  put(element, block.count++, point);
  return true;
}

template <int Dim>
void PointBlocks<Dim>::add_growing(int element, const CarriedPoint<Dim>& point) {
  Block& block = blocks_[element];
  if (block.count == simd_width * block.capacity) grow(block);
  put(element, block.count++, point);
}

template <int Dim>
void PointBlocks<Dim>::grow(Block& block) {
  const std::size_t first = allocate(block.capacity + 1);
  std::copy_n(quads_.begin() + block.first, block.capacity, quads_.begin() + first);
  std::copy_n(ids_.begin() + block.first, block.capacity, ids_.begin() + first);
  if (free_.size() <= static_cast<std::size_t>(block.capacity)) free_.resize(block.capacity + 1);
  if (block.capacity > 0) free_[block.capacity].push_back(block.first);
  block.first = first;
  ++block.capacity;
  const auto element = static_cast<int>(&block - blocks_.data());
  for (int slot = block.count; slot < simd_width * block.capacity; ++slot) clear(element, slot);
}

template <int Dim>
std::size_t PointBlocks<Dim>::allocate(int capacity) {
  if (free_.size() > static_cast<std::size_t>(capacity) && !free_[capacity].empty()) {
    const std::size_t first = free_[capacity].back();
    free_[capacity].pop_back();
    return first;
  }
  const std::size_t first = quads_.size();
  quads_.resize(first + capacity);
  ids_.resize(first + capacity);
  return first;
}

template <int Dim>
void PointBlocks<Dim>::recentre_empty(int element) {
  const Block& block = blocks_[element];
  for (int slot = block.count; slot % simd_width != 0; ++slot) {
    for (SimdDouble4& at : quads_[block.first + slot / simd_width].at) {
      at[slot % simd_width] = 1.0 / (Dim + 1);
    }
  }
}

template class PointBlocks<2>;

}  // namespace suffuse
