#include "field/sweep_order.hpp"

#include <algorithm>

namespace suffuse {
namespace {

/// Depth-first search against the flow, with an explicit stack: a path may pass every element.
template <int Dim>
class Search {
 public:
  Search(const ElementSides<Dim>& sides, const ElementField<Dim>& outflow)
      : sides_(sides), outflow_(outflow), number_(outflow.size(), 0), lowest_(outflow.size(), 0) {
    order_.elements.reserve(outflow.size());
  }

  SweepOrder run() {
    for (int e = 0; e < static_cast<int>(outflow_.size()); ++e) {
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
      const int k = frame.side++;
      const int upwind = sides_.of(e).neighbour[k];
      if (upwind < 0 || !(outflow_[e][k] < 0.0) || number_[upwind] == done) continue;
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
    const auto begin = static_cast<int>(order_.elements.size());
    auto first = open_.end();
    do {
      --first;
      number_[*first] = done;
    } while (*first != e);
    // The search goes against the flow, so the last element is the most upwind one.
    order_.elements.insert(order_.elements.end(), std::make_reverse_iterator(open_.end()),
                           std::make_reverse_iterator(first));
    open_.erase(first, open_.end());
    const auto end = static_cast<int>(order_.elements.size());
    if (end - begin > 1) order_.circles.push_back({begin, end});
  }

  const ElementSides<Dim>& sides_;
  const ElementField<Dim>& outflow_;
  std::vector<int> number_;  ///< order in which elements were found; 0: not yet
  std::vector<int> lowest_;  ///< lowest number that an open element reaches
  std::vector<int> open_;    ///< elements found whose component is not known yet
  std::vector<Frame> path_;
  int count_ = 0;
  SweepOrder order_;
};

}  // namespace

int SweepOrder::largest_circle() const {
  int largest = 0;
  for (const Circle& circle : circles) largest = std::max(largest, circle.end - circle.begin);
  return largest;
}

template <int Dim>
SweepOrder sweep_order(const ElementSides<Dim>& sides, const ElementField<Dim>& outflow) {
  return Search<Dim>(sides, outflow).run();
}

template SweepOrder sweep_order(const ElementSides<2>&, const ElementField<2>&);
template SweepOrder sweep_order(const ElementSides<3>&, const ElementField<3>&);

}  // namespace suffuse
