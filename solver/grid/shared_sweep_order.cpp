#include "grid/shared_sweep_order.hpp"

#include <algorithm>

namespace suffuse {
namespace {

constexpr int none = -1;

/// Takes own elements, each after those that have to come before it. Elements of a unit come one
/// after the other.
template <int Dim>
class Taking {
 public:
  /// \param before  elements that have to come before each own element
  /// \param taken   those that are no part of this
  Taking(const Grid<Dim>& grid, const ElementsAcross<Dim>& before, std::vector<char> taken)
      : grid_(grid),
        before_(before),
        taken_(std::move(taken)),
        known_(taken_),
        unit_(taken_.size()),
        waits_(taken_.size(), 0),
        members_(taken_.size()) {
    for (int e = 0; e < static_cast<int>(unit_.size()); ++e) unit_[e] = e;
  }

  /// Makes these own elements a unit, in this order; call before `start`.
  void join(const std::vector<int>& members) {
    for (const int e : members) unit_[e] = members.front();
    members_[members.front()] = members;
  }
  void start() {
    for (const int e : grid_.own_elements()) {
      for (const int other : before_[e]) {
        if (other >= 0 && taken_[other] == 0 && unit_[other] != unit_[e]) ++waits_[unit_[e]];
      }
    }
    for (const int e : grid_.own_elements()) {
      if (unit_[e] == e && waits_[e] == 0 && taken_[e] == 0) ready_.push_back(e);
    }
  }
  /// The next unit that may be taken; empty: none until ranks have sent.
  std::vector<int> next() {
    while (!ready_.empty()) {
      const int e = ready_.back();
      ready_.pop_back();
      if (taken_[e] != 0) continue;
      std::vector<int> unit = members_[e].empty() ? std::vector<int>{e} : members_[e];
      take(unit);
      return unit;
    }
    return {};
  }
  /// Takes own elements that are ready for another reason.
  void take(const std::vector<int>& elements) {
    for (const int e : elements) taken_[e] = known_[e] = 1;
    for (const int e : elements) release_after(e);
  }
  /// Learns what the others have taken.
  void send() {
    grid_.element_rows().exchange(taken_);
    for (int e = 0; e < static_cast<int>(taken_.size()); ++e) {
      if (taken_[e] == known_[e]) continue;
      known_[e] = taken_[e];
      release_after(e);
    }
  }
  [[nodiscard]] bool is_taken(int element) const { return taken_[element] != 0; }

 private:
  void release_after(int e) {
    for (int k = 0; k <= Dim; ++k) {
      const int next = grid_.beyond(grid_.element_face[e][k], e);
      if (next < 0 || !grid_.element_rows().owns(next)) continue;
      const int unit = unit_[next];
      if (unit == unit_[e] || std::ranges::count(before_[next], e) == 0) continue;
      if (--waits_[unit] == 0) ready_.push_back(unit);
    }
  }

  const Grid<Dim>& grid_;
  const ElementsAcross<Dim>& before_;
  std::vector<char> taken_;  ///< per element
  std::vector<char> known_;  ///< per element: what follows it has been released
  std::vector<int> unit_;    ///< per element: the first one of its unit
  std::vector<int> waits_;   ///< per unit: for this number of elements, on all their sides
  std::vector<std::vector<int>> members_;  ///< per unit; empty: one element
  std::vector<int> ready_;
};

/// An element that is left, its owner, and the numbers of those upwind of it.
template <int Dim>
struct Left {
  long number;
  long rank;
  std::array<long, Dim + 1> upwind;
};

/// The circles that several ranks share among the elements that are left, in upwind order: numbers
/// of elements in the whole mesh.
template <int Dim>
std::vector<std::vector<long>> circles_left(const Grid<Dim>& grid, const Taking<Dim>& taking,
                                            const ElementsAcross<Dim>& upwind) {
  std::vector<Left<Dim>> own;
  for (const int e : grid.own_elements()) {
    if (taking.is_taken(e)) continue;
    own.push_back({grid.element_number(e), grid.ranks().rank(), {}});
    for (int k = 0; k <= Dim; ++k) {
      const int other = upwind[e][k];
      const bool is_left = other >= 0 && !taking.is_taken(other);
      own.back().upwind[k] = is_left ? grid.element_number(other) : none;
    }
  }
  const std::vector<Left<Dim>> left = values_on_all(grid.ranks(), own);
  ElementsAcross<Dim> graph(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (int k = 0; k <= Dim; ++k) {
      const auto place = std::ranges::lower_bound(left, left[i].upwind[k], {}, &Left<Dim>::number);
      graph[i][k] = left[i].upwind[k] < 0 ? none : static_cast<int>(place - left.begin());
    }
  }
  const SweepOrder order = sweep_order<Dim>(graph);
  std::vector<std::vector<long>> result;
  for (const SweepOrder::Part& part : order.parts) {
    const long rank = left[order.elements[part.begin]].rank;
    std::vector<long> numbers;
    bool is_shared = false;
    for (int i = part.begin; i < part.end && part.is_circle; ++i) {
      const Left<Dim>& element = left[order.elements[i]];
      numbers.push_back(element.number);
      is_shared = is_shared || element.rank != rank;
    }
    if (is_shared) result.push_back(std::move(numbers));
  }
  return result;
}

template <int Dim>
class SharedSearch {
 public:
  SharedSearch(const Grid<Dim>& grid, const ElementsAcross<Dim>& upwind)
      : grid_(grid), upwind_(upwind), taking_(grid, upwind, nothing_taken()) {}

  SweepOrder run() {
    join_own_circles();
    taking_.start();
    take_rounds();
    bool left = false;
    for (const int e : grid_.own_elements()) left = left || !taking_.is_taken(e);
    if (!any_of_all(grid_.ranks(), left)) return std::move(order_);
    for (const std::vector<long>& circle : circles_left(grid_, taking_, upwind_)) {
      take_shared(circle);
      take_rounds();
    }
    return std::move(order_);
  }

 private:
  [[nodiscard]] std::vector<char> nothing_taken() const {
    return std::vector<char>(upwind_.size(), 0);
  }
  /// Circles of own elements need no other rank, unless they are part of a larger one.
  void join_own_circles() {
    ElementsAcross<Dim> own = upwind_;
    for (int e = 0; e < static_cast<int>(own.size()); ++e) {
      for (int& other : own[e]) {
        const bool both = other >= 0 && owns(e) && owns(other);
        if (!both) other = none;
      }
    }
    const SweepOrder order = sweep_order<Dim>(own);
    for (const SweepOrder::Part& part : order.parts) {
      if (part.is_circle) {
        taking_.join({order.elements.begin() + part.begin, order.elements.begin() + part.end});
      }
    }
  }
  /// Takes what can be taken before all ranks wait for a circle.
  void take_rounds() {
    for (;;) {
      const std::size_t before = order_.elements.size();
      for (std::vector<int> unit = taking_.next(); !unit.empty(); unit = taking_.next()) {
        order_.add(unit, unit.size() > 1);
      }
      if (!any_of_all(grid_.ranks(), order_.elements.size() > before)) return;
      send();
    }
  }
  void send() {
    if (order_.parts.empty() || order_.parts.back().sends) order_.add({}, false);
    order_.parts.back().sends = true;
    taking_.send();
  }
  /// Takes a circle that several ranks share. In a pass, an element comes before its neighbours
  /// that are later in the circle.
  void take_shared(const std::vector<long>& circle) {
    std::vector<int> place(upwind_.size(), none);
    std::vector<char> outside(upwind_.size(), 1);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      const int e = grid_.element_here(circle[i]);
      if (e < 0) continue;
      place[e] = static_cast<int>(i);
      outside[e] = 0;
    }
    ElementsAcross<Dim> before(upwind_.size());
    for (int e = 0; e < static_cast<int>(before.size()); ++e) {
      for (int k = 0; k <= Dim; ++k) {
        const int other = grid_.beyond(grid_.element_face[e][k], e);
        const bool comes_before = other >= 0 && place[other] >= 0 && place[other] < place[e];
        before[e][k] = comes_before ? other : none;
      }
    }
    Taking<Dim> pass(grid_, before, std::move(outside));
    pass.start();
    SweepOrder::Part part{static_cast<int>(order_.elements.size()), 0, true};
    for (;;) {
      const std::size_t taken = order_.elements.size();
      for (std::vector<int> unit = pass.next(); !unit.empty(); unit = pass.next()) {
        order_.elements.push_back(unit.front());
      }
      if (!any_of_all(grid_.ranks(), order_.elements.size() > taken)) break;
      part.rounds.push_back(static_cast<int>(order_.elements.size()));
      pass.send();
    }
    part.end = static_cast<int>(order_.elements.size());
    taking_.take({order_.elements.begin() + part.begin, order_.elements.end()});
    order_.parts.push_back(std::move(part));
    taking_.send();
  }
  [[nodiscard]] bool owns(int element) const { return grid_.element_rows().owns(element); }

  const Grid<Dim>& grid_;
  const ElementsAcross<Dim>& upwind_;
  Taking<Dim> taking_;
  SweepOrder order_;
};

}  // namespace

template <int Dim>
SweepOrder shared_sweep_order(const Grid<Dim>& grid, const ElementsAcross<Dim>& upwind) {
  return SharedSearch<Dim>(grid, upwind).run();
}

template SweepOrder shared_sweep_order(const Grid<2>&, const ElementsAcross<2>&);
template SweepOrder shared_sweep_order(const Grid<3>&, const ElementsAcross<3>&);

}  // namespace suffuse
