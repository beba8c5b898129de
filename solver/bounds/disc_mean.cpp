#include "bounds/disc_mean.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace suffuse {
namespace {

/// Samples along an edge of an element that the rim of the disc cuts.
template <int Dim>
constexpr int samples_of_edge = Dim == 2 ? 24 : 12;

/// Calls `sample` with the barycentric coordinates of points that fill a triangle or tetrahedron
/// evenly.
template <int Dim>
void for_each_sample(const auto& sample, std::array<double, Dim + 1>& at, int vertex, int left) {
  constexpr double count = samples_of_edge<Dim> + 1.0;
  const auto coordinate = [](int step) { return (step + 1.0 / (Dim + 1)) / count; };
  if (vertex == Dim) {
    at[vertex] = coordinate(left);
    sample(at);
    return;
  }
  for (int step = 0; step <= left; ++step) {
    at[vertex] = coordinate(step);
    for_each_sample<Dim>(sample, at, vertex + 1, left - step);
  }
}

/// What lies of an element in the disc: its share of the element, and the offset of its centroid.
template <int Dim>
typename DiscMean<Dim>::Share part_inside(const Grid<Dim>& grid, int element,
                                          const Vector<Dim>& centre, double radius) {
  const auto inside = [&](const Vector<Dim>& x) {
    return (x - centre).squaredNorm() <= radius * radius;
  };
  const auto is_in = [&](int node) { return inside(grid.mesh.nodes[node]); };
  if (std::ranges::all_of(grid.mesh.elements[element], is_in)) {
    return {element, 1.0, Vector<Dim>::Zero()};
  }
  const Vector<Dim> centroid = element_centroid(grid.mesh, element);
  double all = 0.0;
  double in = 0.0;
  Vector<Dim> offset = Vector<Dim>::Zero();
  PointPlace<Dim> place{element, {}};
  const auto sample = [&](const std::array<double, Dim + 1>& at) {
    place.barycentric = at;
    all += 1.0;
    const Vector<Dim> x = place.position(grid.mesh);
    if (!inside(x)) return;
    in += 1.0;
    offset += x - centroid;
  };
  std::array<double, Dim + 1> at{};
  for_each_sample<Dim>(sample, at, 0, samples_of_edge<Dim>);
  return {element, in / all, offset / std::max(in, 1.0)};
}

}  // namespace

template <int Dim>
DiscMean<Dim> disc_mean(const Grid<Dim>& grid, const PointPlace<Dim>& place, double radius) {
  const Vector<Dim> centre = place.position(grid.mesh);
  const double of_element = 0.5 * std::pow(grid.volume[place.element], 1.0 / Dim);
  DiscMean<Dim> mean{std::max(radius, of_element), {}};
  std::vector<int> found{place.element};
  std::set<int> seen{place.element};
  double whole = 0.0;
  for (std::size_t next = 0; next < found.size(); ++next) {
    const int e = found[next];
    typename DiscMean<Dim>::Share part = part_inside(grid, e, centre, mean.radius);
    if (part.share == 0.0) continue;
    part.share *= grid.volume[e];
    whole += part.share;
    mean.shares.push_back(part);
    for (int k = 0; k <= Dim; ++k) {
      const int other = grid.across(e, k);
      if (other >= 0 && seen.insert(other).second) found.push_back(other);
    }
  }
  if (mean.shares.empty()) {  // a sliver, of which no sample lies in the disc
    mean.shares.push_back({place.element, 1.0, Vector<Dim>::Zero()});
    whole = 1.0;
  }
  for (typename DiscMean<Dim>::Share& part : mean.shares) part.share /= whole;
  return mean;
}

template DiscMean<2> disc_mean(const Grid<2>&, const PointPlace<2>&, double);
template DiscMean<3> disc_mean(const Grid<3>&, const PointPlace<3>&, double);

}  // namespace suffuse
