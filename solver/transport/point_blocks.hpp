#pragma once

/// Liquid points side by side, element by element, as the passes of an explicit flow step want
/// them: four at a time, each element's in one piece of memory.

#include <array>
#include <span>
#include <vector>

#include "grid/simd.hpp"
#include "transport/liquid_points.hpp"

namespace suffuse {

/// Four points. Their last barycentric coordinate is one less the others. A slot without a point
/// has no mass and lies in the middle of the element: it counts for nothing.
template <int Dim>
struct PointQuad {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  std::array<SimdDouble4, Dim> at;           ///< barycentric coordinates but for the last
  std::array<SimdDouble4, Dim> velocity;     ///< m/s
  SimdDouble4 pressure;                      ///< Pa
  SimdDouble4 water_mass;                    ///< kg
  SimdDouble4 fines_mass;                    ///< kg
};

/// One point by itself.
template <int Dim>
struct CarriedPoint {
  std::array<double, Dim> at;
  Vector<Dim> velocity;
  double pressure;
  double water_mass;
  double fines_mass;
  long id;
};

/// All four barycentric coordinates from those that are kept.
template <int Dim>
std::array<double, Dim + 1> all_coordinates(const std::array<double, Dim>& at) {
  std::array<double, Dim + 1> result;
  result[Dim] = 1.0;
  for (int a = 0; a < Dim; ++a) {
    result[a] = at[a];
    result[Dim] -= at[a];
  }
  return result;
}

template <int Dim>
class PointBlocks {
 public:
  /// Takes the points, sorted by element, in their order. Those must carry the flow.
  void fill(const LiquidPoints<Dim>& points, int element_count);
  /// Sorted by element.
  [[nodiscard]] LiquidPoints<Dim> points() const;

  [[nodiscard]] int size() const;
  [[nodiscard]] int element_count() const { return static_cast<int>(blocks_.size()); }
  [[nodiscard]] int count(int element) const { return blocks_[element].count; }
  /// The points of an element; empty slots, at the end of the last four, included.
  [[nodiscard]] std::span<PointQuad<Dim>> quads(int element) {
    return {&quads_[blocks_[element].first], quads_of(blocks_[element].count)};
  }
  [[nodiscard]] std::span<const PointQuad<Dim>> quads(int element) const {
    return {&quads_[blocks_[element].first], quads_of(blocks_[element].count)};
  }
  /// Brings the points of an element into the cache, if there is such an element.
  void prefetch(int element) const {
    if (element >= element_count()) return;
    const auto points = quads(element);
    const auto* line = reinterpret_cast<const char*>(points.data());
    const auto* const end = reinterpret_cast<const char*>(points.data() + points.size());
    for (; line < end; line += 64) __builtin_prefetch(line, 1);
  }
  [[nodiscard]] CarriedPoint<Dim> point(int element, int slot) const;

  [[nodiscard]] double water_mass(int element, int slot) const {
    return quad(element, slot).water_mass[slot % simd_width];
  }
  [[nodiscard]] double fines_mass(int element, int slot) const {
    return quad(element, slot).fines_mass[slot % simd_width];
  }
  [[nodiscard]] std::array<double, Dim + 1> barycentric(int element, int slot) const {
    std::array<double, Dim> at;
    for (int a = 0; a < Dim; ++a) at[a] = quad(element, slot).at[a][slot % simd_width];
    return all_coordinates<Dim>(at);
  }
  void add_fines(int element, int slot, double mass) {
    quads_[blocks_[element].first + slot / simd_width].fines_mass[slot % simd_width] += mass;
  }

  /// Takes a point out; the element's last one takes its slot.
  CarriedPoint<Dim> remove(int element, int slot);
  /// Puts a point behind the others. False, and nothing happens, when the block is full.
  [[nodiscard]] bool add(int element, const CarriedPoint<Dim>& point);
  /// The same into a larger block where it is full.
  void add_growing(int element, const CarriedPoint<Dim>& point);
  /// Empty slots back to the middle of the element, from wherever the flow took them.
  void recentre_empty(int element);

  void archive(auto& archive) { archive(quads_, ids_, blocks_, free_); }

 private:
  struct Block {
    static constexpr bool has_no_gaps = true;
    std::size_t first;  ///< quad
    int count;          ///< points
    int capacity;       ///< quads
  };
  [[nodiscard]] const PointQuad<Dim>& quad(int element, int slot) const {
    return quads_[blocks_[element].first + slot / simd_width];
  }
  static std::size_t quads_of(int count) {
    return static_cast<std::size_t>((count + simd_width - 1) / simd_width);
  }
  void put(int element, int slot, const CarriedPoint<Dim>& point);
  void clear(int element, int slot);
  void grow(Block& block);
  std::size_t allocate(int capacity);

  std::vector<PointQuad<Dim>> quads_;
  std::vector<std::array<long, simd_width>> ids_;  ///< as `quads_`
  std::vector<Block> blocks_;
  /// First quads of blocks that were given up, by capacity.
  std::vector<std::vector<std::size_t>> free_;
};

}  // namespace suffuse
