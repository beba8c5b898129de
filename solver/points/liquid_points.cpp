#include "points/liquid_points.hpp"

#include <algorithm>
#include <numeric>

#include "physics/liquid.hpp"
#include "solid/solid_points.hpp"

namespace suffuse {
namespace {

std::vector<int> begins(const std::vector<int>& element, int element_count) {
  std::vector<int> begin(element_count + 1, 0);
  for (const int e : element) ++begin[e + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  return begin;
}

}  // namespace

template <int Dim>
void rearrange(LiquidPoints<Dim>& points, const std::vector<int>& order) {
  reorder(order, points.element);
  reorder(order, points.barycentric);
  reorder(order, points.water_mass);
  reorder(order, points.fines_mass);
  reorder(order, points.id);
  reorder(order, points.pressure);
  reorder(order, points.velocity);
}

template <int Dim>
void LiquidPoints<Dim>::reserve(int count) {
  element.reserve(count);
  barycentric.reserve(count);
  water_mass.reserve(count);
  fines_mass.reserve(count);
  id.reserve(count);
  pressure.reserve(count);
  velocity.reserve(count);
}

template <int Dim>
void sort_by_element(LiquidPoints<Dim>& points, int element_count) {
  if (std::is_sorted(points.element.begin(), points.element.end())) return;
  std::vector<int> next = begins(points.element, element_count);
  std::vector<int> order(points.element.size());
  for (int p = 0; p < points.size(); ++p) order[next[points.element[p]]++] = p;
  rearrange(points, order);
}

template <int Dim>
std::vector<int> element_begins(const LiquidPoints<Dim>& points, int element_count) {
  return begins(points.element, element_count);
}

template <int Dim>
void keep_points(LiquidPoints<Dim>& points, const std::vector<unsigned char>& keep) {
  std::vector<int> order;
  for (int p = 0; p < points.size(); ++p) {
    if (keep[p] != 0) order.push_back(p);
  }
  if (order.size() < keep.size()) rearrange(points, order);
}

template <int Dim>
LiquidPoints<Dim> clean_liquid(const MaterialPoints<Dim>& places,
                               const std::vector<double>& pressure,
                               const LiquidDensities& densities, double bulk_modulus) {
  LiquidPoints<Dim> result;
  result.element = places.element;
  result.barycentric = places.barycentric;
  result.fines_mass.assign(places.size(), 0.0);
  result.water_mass.reserve(places.size());
  result.id.resize(places.size());
  std::iota(result.id.begin(), result.id.end(), 0L);
  for (int p = 0; p < places.size(); ++p) {
    result.water_mass.push_back(densities.water *
                                density_ratio(pressure[places.element[p]], bulk_modulus) *
                                places.volume[p]);
  }
  return result;
}

template LiquidPoints<2> clean_liquid(const MaterialPoints<2>&, const std::vector<double>&,
                                      const LiquidDensities&, double);
template LiquidPoints<3> clean_liquid(const MaterialPoints<3>&, const std::vector<double>&,
                                      const LiquidDensities&, double);
template void LiquidPoints<2>::reserve(int);
template void LiquidPoints<3>::reserve(int);
template void rearrange(LiquidPoints<2>&, const std::vector<int>&);
template void rearrange(LiquidPoints<3>&, const std::vector<int>&);
template void sort_by_element(LiquidPoints<2>&, int);
template void sort_by_element(LiquidPoints<3>&, int);
template std::vector<int> element_begins(const LiquidPoints<2>&, int);
template std::vector<int> element_begins(const LiquidPoints<3>&, int);
template void keep_points(LiquidPoints<2>&, const std::vector<unsigned char>&);
template void keep_points(LiquidPoints<3>&, const std::vector<unsigned char>&);

}  // namespace suffuse
