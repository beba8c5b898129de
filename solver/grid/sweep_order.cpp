#include "grid/sweep_order.hpp"

#include <algorithm>

namespace suffuse {
namespace {

/// Depth-first search against the flow, with an explicit stack: a path may pass every element.
template <int Dim>
class Search {
 public:
  explicit Search(const ElementsAcross<Dim>& upwind)
      : upwind_(upwind), number_(upwind.size(), 0), lowest_(upwind.size(), 0) {
    order_.elements.reserve(upwind.size());
  }

  SweepOrder run() {
    for (int e = 0; e < static_cast<int>(upwind_.size()); ++e) {
      if (number_[e] == 0) visit_from(e);
    }
    return std::move(order_);
  }

 private:
  struct Frame {
    int element;
    int side;
  };
  static constexpr int done = -1;
  static constexpr int of_circle = -2;  ///< of that which is being ordered

  void enter(int e) {
    number_[e] = lowest_[e] = ++count_;
    open_.push_back(e);
    path_.push_back({e, 0});
  }

  void visit_from(int first) {
    enter(first);
    while (!path_.empty()) {
      Frame& frame = path_.back();
      const int e = frame.element;
      if (frame.side > Dim) {
        path_.pop_back();
        if (!path_.empty()) follow(path_.back().element, lowest_[e]);
        if (lowest_[e] == number_[e]) close(e);
        continue;
      }
      const int upwind = upwind_[e][frame.side++];
      if (upwind < 0 || number_[upwind] == done) continue;
      if (number_[upwind] == 0) {
        enter(upwind);
      } else {
        follow(e, number_[upwind]);
      }
    }
  }

  void follow(int e, int number) { lowest_[e] = std::min(lowest_[e], number); }

  /// Completes the component of `e` and the elements above it on the stack.
  void close(int e) {
    auto first = open_.end();
    do {
      --first;
      number_[*first] = done;
    } while (*first != e);
    const std::vector<int> component(first, open_.end());
    open_.erase(first, open_.end());
    if (component.size() == 1) return order_.add(component, false);
    for (const int member : component) number_[member] = of_circle;
    order_.add(around(*std::ranges::min_element(component)), true);
  }

  /// The elements of a circle: its search goes against the flow, so the last one that it finds is
  /// the most upwind one.
  std::vector<int> around(int first) {
    std::vector<int> found;
    std::vector<Frame> path;
    const auto take = [&](int e) {
      number_[e] = done;
      found.push_back(e);
      path.push_back({e, 0});
    };
    take(first);
    while (!path.empty()) {
      Frame& frame = path.back();
      if (frame.side > Dim) {
        path.pop_back();
        continue;
      }
      const int upwind = upwind_[frame.element][frame.side++];
      if (upwind >= 0 && number_[upwind] == of_circle) take(upwind);
    }
    std::ranges::reverse(found);
    return found;
  }

  const ElementsAcross<Dim>& upwind_;
  std::vector<int> number_;  ///< order in which elements were found; 0: not yet
  std::vector<int> lowest_;  ///< lowest number that an open element reaches
  std::vector<int> open_;    ///< elements found whose component is not known yet
  std::vector<Frame> path_;
  int count_ = 0;
  SweepOrder order_;
};

}  // namespace

void SweepOrder::add(const std::vector<int>& more, bool is_circle) {
  const auto begin = static_cast<int>(elements.size());
  elements.insert(elements.end(), more.begin(), more.end());
  const auto end = static_cast<int>(elements.size());
  const bool goes_on =
      !is_circle && !parts.empty() && !parts.back().is_circle && !parts.back().sends;
  if (goes_on) {
    parts.back().end = end;
  } else {
    parts.push_back({begin, end, is_circle});
  }
}

int SweepOrder::largest_circle() const {
  int largest = 0;
  for (const Part& part : parts) {
    if (part.is_circle) largest = std::max(largest, part.end - part.begin);
  }
  return largest;
}

template <int Dim>
SweepOrder sweep_order(const ElementsAcross<Dim>& upwind) {
  return Search<Dim>(upwind).run();
}

template SweepOrder sweep_order<2>(const ElementsAcross<2>&);
template SweepOrder sweep_order<3>(const ElementsAcross<3>&);

}  // namespace suffuse
