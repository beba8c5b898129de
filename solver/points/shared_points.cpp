#include "points/shared_points.hpp"

#include <numeric>

namespace suffuse {

template <int Dim>
SharedPoints<Dim>::SharedPoints(const Grid<Dim>& grid)
    : grid_(grid), owner_(grid.mesh.elements.size(), grid.ranks().rank()) {
  if (grid.ranks().count() == 1) return;
  grid.element_rows().exchange(owner_);
  // A rank asks the owners for the elements that it holds.
  struct Request {
    long element;
    int rank;
  };
  std::vector<std::vector<Request>> requests(grid_.ranks().count());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!owns(e)) requests[owner_[e]].push_back({grid.element_number(e), grid.ranks().rank()});
  }
  held_by_.resize(grid_.ranks().count());
  for (const Request& request : send_values(grid.ranks(), requests)) {
    held_by_[request.rank].push_back(grid.element_here(request.element));
  }
}

template <int Dim>
void SharedPoints<Dim>::start_step(const LiquidPoints<Dim>& points,
                                   const std::vector<int>& begins) {
  order_.clear();
  if (grid_.ranks().count() == 1) return;
  order_.reserve(points.element.size());
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    order_.push_back({grid_.element_number(e), p - begins[e]});
  }
}

template <int Dim>
auto SharedPoints<Dim>::traveller(const LiquidPoints<Dim>& points, int p,
                                  const PointOrder& order) const -> Traveller {
  return {order,
          grid_.element_number(points.element[p]),
          points.barycentric[p],
          points.water_mass[p],
          points.fines_mass[p],
          points.id[p]};
}

template <int Dim>
void SharedPoints<Dim>::add(LiquidPoints<Dim>& points, const Traveller& traveller) const {
  points.element.push_back(grid_.element_here(traveller.element));
  points.barycentric.push_back(traveller.barycentric);
  points.water_mass.push_back(traveller.water_mass);
  points.fines_mass.push_back(traveller.fines_mass);
  points.id.push_back(traveller.id);
}

template <int Dim>
void SharedPoints<Dim>::settle(LiquidPoints<Dim>& points, std::vector<unsigned char> keep) const {
  const int elements = grid_.mesh.element_count();
  if (grid_.ranks().count() == 1) {
    keep_points(points, keep);
    sort_by_element(points, elements);
    return;
  }
  std::vector<std::vector<Traveller>> leaving(grid_.ranks().count());
  std::vector<PointOrder> orders;
  for (int p = 0; p < points.size(); ++p) {
    if (keep[p] == 0) continue;
    const int e = points.element[p];
    if (owns(e)) {
      orders.push_back(order_[p]);
    } else {
      leaving[owner_[e]].push_back(traveller(points, p, order_[p]));
      keep[p] = 0;
    }
  }
  keep_points(points, keep);
  std::vector<Traveller> arriving = send_values(grid_.ranks(), leaving);
  if (!arriving.empty()) {
    // Those that stay are in order.
    std::ranges::sort(arriving, {}, &Traveller::order);
    const auto stay = static_cast<std::ptrdiff_t>(orders.size());
    for (const Traveller& traveller : arriving) {
      add(points, traveller);
      orders.push_back(traveller.order);
    }
    std::vector<int> order(orders.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::inplace_merge(order, order.begin() + stay, {}, [&](int p) { return orders[p]; });
    rearrange(points, order);
  }
  sort_by_element(points, elements);
}

template <int Dim>
LiquidPoints<Dim> SharedPoints<Dim>::with_copies(const LiquidPoints<Dim>& points) const {
  LiquidPoints<Dim> result = points;
  if (grid_.ranks().count() == 1) return result;
  const std::vector<int> begins = element_begins(points, grid_.mesh.element_count());
  std::vector<std::vector<Traveller>> copies(grid_.ranks().count());
  for (std::size_t rank = 0; rank < copies.size(); ++rank) {
    for (const int e : held_by_[rank]) {
      for (int p = begins[e]; p < begins[e + 1]; ++p) {
        copies[rank].push_back(traveller(points, p, {}));
      }
    }
  }
  for (const Traveller& copy : send_values(grid_.ranks(), copies)) add(result, copy);
  sort_by_element(result, grid_.mesh.element_count());
  return result;
}

template <int Dim>
void SharedPoints<Dim>::number_elements(LiquidPoints<Dim>& points) const {
  for (int& e : points.element) e = static_cast<int>(grid_.element_number(e));
}

template <int Dim>
void SharedPoints<Dim>::take_own(LiquidPoints<Dim>& points) const {
  std::vector<unsigned char> keep;
  for (int& e : points.element) {
    e = grid_.element_here(e);
    keep.push_back(e >= 0 && owns(e) ? 1 : 0);
  }
  keep_points(points, keep);
}

template class SharedPoints<2>;
template class SharedPoints<3>;

}  // namespace suffuse
