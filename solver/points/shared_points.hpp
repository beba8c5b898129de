#pragma once

/// Liquid points that several ranks share. A point belongs to the rank that owns its element. In a
/// step it may come into elements of others, which its rank holds too; then it is sent there. Sums
/// over points, and the points of an element, have the order that they have in one process.

#include <algorithm>
#include <array>
#include <compare>
#include <limits>
#include <vector>

#include "grid/grid.hpp"
#include "points/liquid_points.hpp"

namespace suffuse {

/// The place of a point in the order of the whole model before it moves: by elements, and injected
/// points behind all others.
struct PointOrder {
  long element;  ///< number in the whole mesh
  long place;    ///< among the points of the element, or among the injected ones
  auto operator<=>(const PointOrder&) const = default;  // NOLINT: of generated code
};

template <int Dim>
class SharedPoints {
 public:
  /// All ranks have to call all functions.
  explicit SharedPoints(const Grid<Dim>& grid);

  /// Starts a step of these points, sorted by element; `begins`: see `element_begins`.
  void start_step(const LiquidPoints<Dim>& points, const std::vector<int>& begins);
  /// Adds a point that is the one at `place` among the injected ones of all ranks.
  void add_injected(long place) { order_.push_back({behind_all, place}); }

  /// Sums what points bring to elements, in the order of points: `give(add)` calls
  /// `add(element, point, values)`, point by point. Returns the sums of all ranks in all elements
  /// that are here.
  template <std::size_t size, class Give>
  [[nodiscard]] std::vector<std::array<double, size>> sums(const Give& give) const {
    std::vector<std::array<double, size>> result(grid_.mesh.elements.size());
    const auto add = [&](int element, const std::array<double, size>& values) {
      for (std::size_t k = 0; k < size; ++k) result[element][k] += values[k];
    };
    if (grid_.ranks().count() == 1) {
      give([&](int element, int /*point*/, const std::array<double, size>& values) {
        add(element, values);
      });
      return result;
    }
    struct Term {
      PointOrder order;
      long element;
      std::array<double, size> values;
    };
    std::vector<Term> own;
    std::vector<std::vector<Term>> to(grid_.ranks().count());
    give([&](int element, int point, const std::array<double, size>& values) {
      const Term term{order_[point], grid_.element_number(element), values};
      (owns(element) ? own : to[owner_[element]]).push_back(term);
    });
    std::vector<Term> come = send_values(grid_.ranks(), to);
    // Those of one point come from one rank, in their order.
    std::ranges::stable_sort(come, {}, &Term::order);
    const auto add_term = [&](const Term& term) {
      add(grid_.element_here(term.element), term.values);
    };
    auto next = come.begin();
    for (const Term& term : own) {
      for (; next != come.end() && next->order < term.order; ++next) add_term(*next);
      add_term(term);
    }
    std::for_each(next, come.end(), add_term);
    grid_.element_rows().exchange(result);
    return result;
  }

  /// Removes the points for which `keep` is zero, and brings each point to the rank that owns its
  /// element. The points are then sorted by element.
  void settle(LiquidPoints<Dim>& points, std::vector<unsigned char> keep) const;
  /// The points that are here, and copies of those in elements of others that are here; sorted.
  [[nodiscard]] LiquidPoints<Dim> with_copies(const LiquidPoints<Dim>& points) const;

  /// Gives elements the numbers of the whole mesh.
  void number_elements(LiquidPoints<Dim>& points) const;
  /// Takes own points out of those of the whole model, with such numbers.
  void take_own(LiquidPoints<Dim>& points) const;

 private:
  static constexpr long behind_all = std::numeric_limits<long>::max();

  /// A point on its way to another rank.
  struct Traveller {
    PointOrder order;
    long element;
    std::array<double, Dim + 1> barycentric;
    double water_mass;
    double fines_mass;
    long id;
  };

  [[nodiscard]] bool owns(int element) const { return grid_.element_rows().owns(element); }
  [[nodiscard]] Traveller traveller(const LiquidPoints<Dim>& points, int p,
                                    const PointOrder& order) const;
  void add(LiquidPoints<Dim>& points, const Traveller& traveller) const;

  const Grid<Dim>& grid_;
  std::vector<int> owner_;                 ///< rank of each element that is here
  std::vector<std::vector<int>> held_by_;  ///< per rank: own elements of which it has a copy
  std::vector<PointOrder> order_;          ///< of each point; none if this program is alone
};

}  // namespace suffuse
